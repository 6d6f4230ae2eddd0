"""Python in the page: what it consists of, that it answers as on a desk, outlives an answer without end, and needs no
network once it was there."""

import contextlib
import doctest
import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
import threading
import zipfile
from importlib import metadata
from pathlib import Path

import pytest
from docs.browser import judge, runtime, site, wheels

import browser
import browser_runtime
from loopbook.exercises.forms import answer

ROOT = Path(__file__).parents[2]
STATIC = ROOT / "docs" / "_static"
ASKED = {"do": "check", "exercise": "7.1", "student": None, "answers": {"I": "14.4 mA", "p": "0.85 MPa", "gain": "2"}}
#: Words in an answer with which the judge of these tests never comes to an end: in Python, and below it.
ENDLESS, DEAF = "endless", "deaf"


# What the site consists of.


@pytest.mark.parametrize("module", [runtime, wheels, judge, site])
def test_the_examples_run(module):
    assert doctest.testmod(module).failed == 0


def test_the_parts_are_those_that_their_authors_published():
    folder = browser_runtime.required()
    published = browser_runtime.published(folder)
    known = runtime.known()
    assert {name for name in known if name.endswith((".whl", ".zip"))} - {"python_stdlib.zip"} <= published.keys()
    assert {name: known[name].sha256 for name in known.keys() & published.keys()} == {
        name: published[name] for name in known.keys() & published.keys()
    }


def test_a_wheel_holds_what_is_installed_but_its_tests(tmp_path):
    wheel = wheels.make("mpmath", tmp_path)
    assert wheel.name == f"mpmath-{metadata.version('mpmath')}-py3-none-any.whl"
    names = zipfile.ZipFile(wheel).namelist()
    assert "mpmath/calculus/quadrature.py" in names
    assert [name for name in names if "tests" in name or name.endswith(".pyc")] == []
    again = wheels.make("mpmath", tmp_path / "again")
    assert again.read_bytes() == wheel.read_bytes()


def test_pip_installs_the_wheel_of_the_library(tmp_path):
    wheel = wheels.make("loopbook", tmp_path)
    command = [sys.executable, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-deps"]
    subprocess.run([*command, "--target", str(tmp_path / "there"), str(wheel)], check=True)
    assert (tmp_path / "there" / "loopbook" / "exercises" / "bank" / "ch07_feedback" / "7_1.md").is_file()


def test_compiled_code_is_no_pure_package(tmp_path):
    with pytest.raises(ValueError, match=r"numpy holds compiled code, as .*: expected pure Python"):
        wheels.make("numpy", tmp_path)


def test_a_site_without_a_network_holds_each_part_once_and_believes_nobody(tmp_path):
    names, folder = ["pyodide.mjs", "cycler-0.12.1-py3-none-any.whl"], tmp_path / "runtime"
    runtime.place(names, folder, browser_runtime.required())
    assert sorted(path.name for path in folder.iterdir()) == sorted(names)
    with pytest.raises(runtime.MissingError, match=r"six-1.16.0-py2.py3-none-any.whl is not in .*: expected the parts"):
        runtime.place(["six-1.16.0-py2.py3-none-any.whl"], tmp_path / "other", folder)
    (folder / "pyodide.mjs").write_bytes(b"something else")
    with pytest.raises(runtime.MissingError, match=r"pyodide.mjs from .* has another SHA-256"):
        runtime.place(["pyodide.mjs"], tmp_path / "other", folder)
    assert not (tmp_path / "other" / "pyodide.mjs").exists()


def test_a_part_that_cannot_be_fetched_says_what_helps(tmp_path, monkeypatch):
    monkeypatch.setattr(runtime, "CDN", "http://127.0.0.1:9/")
    with pytest.raises(runtime.MissingError, match=r"cannot be fetched from .* name their folder, as PARTS=FOLDER"):
        runtime.place(["pyodide.mjs"], tmp_path)


def test_a_site_that_cannot_hold_python_says_so_in_one_sentence_and_is_not_begun(tmp_path):
    ran = subprocess.run(
        [sys.executable, "docs", str(tmp_path / "site")],
        cwd=ROOT, env=os.environ | {"OFFLINE": "1", "PARTS": str(tmp_path)}, capture_output=True, encoding="utf-8",
    )  # fmt: skip
    assert ran.returncode == 1
    assert ran.stderr == (
        f"OFFLINE=1: pyodide.mjs is not in {tmp_path}: expected the parts of Pyodide {runtime.VERSION} there\n"
    )
    assert not (tmp_path / "site" / "index.html").exists()


def test_a_site_lists_its_parts_and_knows_itself_by_its_content(tmp_path):
    (tmp_path / "index.html").write_text("<h1>One</h1>", encoding="utf-8")
    site.write(tmp_path, offline=False)
    listed = json.loads((tmp_path / "wheels" / "parts.json").read_text(encoding="utf-8"))
    assert listed["later"] == {
        "scipy": "scipy", "matplotlib": "pictures", "PIL": "pictures", "schemdraw": "pictures"
    }  # fmt: skip
    files = [file for part in listed["parts"].values() for file in part["files"]]
    for file in files:
        if not file["url"].startswith(runtime.CDN):
            content = (tmp_path / "wheels" / file["url"].partition("?")[0]).read_bytes()
            assert (file["bytes"], file["sha256"]) == (len(content), hashlib.sha256(content).hexdigest())
    first = (tmp_path / "service-worker.js").read_text(encoding="utf-8")
    (tmp_path / "index.html").write_text("<h1>Two</h1>", encoding="utf-8")
    site.write(tmp_path, offline=False)
    assert (tmp_path / "service-worker.js").read_text(encoding="utf-8") != first


# Python's side of it.


@pytest.fixture
def finder(tmp_path, monkeypatch):
    """A finder of late packages, of which one, `late_package`, comes to a folder when a test puts it there."""
    monkeypatch.syspath_prepend(tmp_path)
    finder = judge.Later({"late_package": "late"})
    monkeypatch.setattr(sys, "meta_path", [finder, *sys.meta_path])
    yield finder
    sys.modules.pop("late_package", None)


def test_an_import_says_which_part_it_lacks_and_nobody_goes_on_without_it(finder, tmp_path):
    def optional():
        try:
            import late_package
        except ImportError:
            return None
        return late_package

    with pytest.raises(judge.Lacking):
        optional()
    assert finder.lacks == "late"
    (tmp_path / "late_package.py").write_text("here = True", encoding="utf-8")
    finder.arrived("late")
    assert optional().here


def test_a_request_that_lacks_a_part_is_answered_when_it_is_there(finder, tmp_path):
    def reply(text):
        import late_package

        return json.dumps({"here": late_package.here})

    asked = judge.Judge({})
    asked.later, asked._answer = finder, reply
    assert asked.prepare('{"do": "check", "exercise": "7.1"}') == "late"
    assert asked.reply("{}") == ["", "late"]
    (tmp_path / "late_package.py").write_text("here = 1", encoding="utf-8")
    finder.arrived("late")
    assert asked.reply("{}") == ['{"here": 1}', ""]


def test_a_slow_device_has_more_time(monkeypatch):
    asked = judge.Judge({})
    assert 1 <= asked.slowness() <= 10
    seconds = iter([0, 4 * judge._USUAL, 0, 0, 0, 100])
    monkeypatch.setattr(judge.time, "perf_counter", lambda: next(seconds))
    slow = judge.Judge({})
    assert [round(slow.slowness(), 6) for _ in range(3)] == [4, 4, 10]


def test_the_judge_answers_what_it_cannot_answer():
    def reply(text):
        raise RecursionError("too deep")

    asked = judge.Judge({})
    asked._answer = reply
    assert json.loads(asked.reply("{}")[0]) == {"problem": "this cannot be answered (RecursionError: too deep)"}


#: Imports a module from a folder and one from an archive, and prints what an archive of both holds when it is kept.
KEEPS = """
import sys
sys.path[:0] = [{docs!r}, {folder!r}, {archive!r}]
sys.dont_write_bytecode = False
import judge
judge.sys.path[:] = [path for path in sys.path if not path.endswith(".zip") or path == {archive!r}]
kept = judge.Judge({{}}, {folder!r})
import of_a_folder, of_the_archive
ready = []
while (name := kept.compile(0)) != "nothing":  # a step at a time
    if name:
        open({target!r} + "/" + name, "wb").write(kept.take(name))
        ready.append(name)
print(ready)
"""


def test_what_was_compiled_need_not_be_compiled_again(tmp_path):
    folder, archive = tmp_path / "folder", tmp_path / "library.zip"
    folder.mkdir()
    (folder / "of_a_folder.py").write_text("value = 'compiled'", encoding="utf-8")
    with zipfile.ZipFile(archive, "w") as members:
        members.writestr("of_the_archive.py", "value = 'compiled'")
    places = {"docs": str(ROOT / "docs" / "browser"), "folder": str(folder), "archive": str(archive)}
    program = KEEPS.format(**places, target=str(tmp_path))
    ran = subprocess.run([sys.executable, "-c", program], capture_output=True, encoding="utf-8")
    assert ran.stdout == "['packages', 'standard library']\n", ran.stderr

    assert zipfile.ZipFile(tmp_path / "packages").namelist() == [
        f"__pycache__/of_a_folder.{sys.implementation.cache_tag}.pyc"
    ]

    # the sources change, and what was compiled counts: it is not compared with them
    (folder / "of_a_folder.py").write_text("value = 'read again, and much longer'", encoding="utf-8")
    shutil.rmtree(folder / "__pycache__")
    asked = judge.Judge({}, str(folder))
    asked.restore((tmp_path / "packages").read_bytes())
    program = f"import sys; sys.path[:0] = [{str(folder)!r}, {str(tmp_path / 'standard library')!r}]\n"
    program += "import of_a_folder, of_the_archive; print(of_a_folder.value, of_the_archive.value)"
    ran = subprocess.run([sys.executable, "-c", program], capture_output=True, encoding="utf-8")
    assert ran.stdout == "compiled compiled\n", ran.stderr


# In the browser.


class Site:
    """A small site with the judge, on a server that can be stopped, and a list of what it was asked for."""

    def __init__(self, folder):
        self.folder, self.asked = folder, []
        handler = self.handler()
        self.server = browser.Patient(("127.0.0.1", 0), handler)
        self.address = f"http://127.0.0.1:{self.server.server_port}/book/"
        threading.Thread(target=self.server.serve_forever, daemon=True).start()

    def handler(self):
        site = self

        class Handler(browser.Silent):
            def __init__(self, *arguments):
                super().__init__(*arguments, directory=str(site.folder.parent))

            def do_GET(self):
                site.asked.append(self.path.removeprefix("/book/"))
                super().do_GET()

            def end_headers(self):
                self.send_header("Cache-Control", "no-store")  # so that what is kept is kept by us
                super().end_headers()

        return Handler

    def stop(self):
        self.server.shutdown()
        self.server.server_close()


@pytest.fixture
def small(tmp_path):
    """A site of two pages with the judge in it, one that never comes to an end for some answers."""
    folder = tmp_path / "book"
    (folder / "_static").mkdir(parents=True)
    for name in ("judge.js", "judge-worker.js", "offline.js", "favicon.svg"):
        shutil.copyfile(STATIC / name, folder / "_static" / name)
    for name in ("one", "two"):
        head = '<link rel="icon" href="_static/favicon.svg"><script defer src="_static/offline.js"></script>'
        page = f'<!doctype html><html lang="en"><meta charset="utf-8"><title>{name}</title>{head}<h1>{name}</h1>'
        (folder / f"{name}.html").write_text(page, encoding="utf-8")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(site, "HERE", with_an_endless_judge(tmp_path / "browser"))
        site.place(site.of_all(), folder, browser_runtime.required())
        site.write(folder, True)
    small = Site(folder)
    yield small
    with contextlib.suppress(OSError):
        small.stop()


def with_an_endless_judge(folder):
    shutil.copytree(site.HERE, folder)
    endless = f"""
_reply = Judge.reply
def _endless(self, text):
    while {ENDLESS!r} in text:
        pass
    if {DEAF!r} in text:
        sum(iter(int, 1))
    return _reply(self, text)
Judge.reply = _endless
"""
    with (folder / "judge.py").open("a", encoding="utf-8") as module:
        module.write(endless)
    return folder


def ask(page, **request):
    return browser_runtime.ask(page, ASKED | request)["reply"]


def end_python(page):
    """Let the next question start Python anew, as if none were left from another page."""
    page.evaluate("localStorage['loopbook python'] = 1 + Number(localStorage['loopbook python'] ?? 0)")


#: Cuts a file that the browser keeps to its half.
DAMAGE = """async (ending) => {
    for (const name of await caches.keys()) {
        const cache = await caches.open(name);
        for (const request of await cache.keys()) {
            if (!request.url.endsWith(ending)) continue;
            const whole = await (await cache.match(request)).arrayBuffer();
            await cache.put(request, new Response(whole.slice(0, whole.byteLength / 2)));
        }
    }
}"""


class TestInTheBrowser:
    def test_it_answers_as_on_a_desk_and_without_a_network_and_outlives_an_answer_without_end(self, chromium, small):
        context = chromium.new_context()
        page = context.new_page()
        complaints = browser.Complaints(page)
        page.goto(small.address + "one.html")
        assert ask(page) == json.loads(answer(json.dumps(ASKED)))
        assert ask(page, exercise="7.77") == json.loads(answer('{"do": "check", "exercise": "7.77"}'))

        # it says what it loads, and how far it is
        said = page.evaluate("said")
        shares = [share for share, _ in said]
        assert shares == sorted(shares)
        assert shares[-1] < 1
        assert any("of 23 MB" in says for _, says in said), said
        assert [one for one in small.asked if "scipy" in one or "matplotlib" in one] == []
        loaded = [one for one in small.asked if one.startswith(("wheels", "runtime"))]
        assert len(loaded) == len(set(loaded)), "something was loaded twice"

        # a picture is asked for: Matplotlib comes now
        shown = ask(page, do="show", exercise="7.1", student="Mira")
        assert "<img" in shown["html"] or "<svg" in shown["html"]
        assert [one for one in small.asked if "matplotlib" in one] != []

        browser_runtime.wait_until_kept(page, "one.html")
        browser_runtime.wait_until_compiled(page, small.folder)
        page.close()

        # what a disk has damaged is fetched again
        page = context.new_page()
        page.goto(small.address + "one.html")
        page.evaluate(DAMAGE, "pyodide.asm.wasm")
        end_python(page)
        small.asked.clear()
        assert ask(page) == json.loads(answer(json.dumps(ASKED)))
        assert [one.split("/")[-1].split("?")[0] for one in small.asked if "wasm" in one] == ["pyodide.asm.wasm"]
        page.close()
        small.stop()

        # nothing is there any more, and all works
        page = context.new_page()
        page.goto(small.address + "one.html")
        assert page.inner_text("h1") == "one"
        end_python(page)
        assert ask(page) == json.loads(answer(json.dumps(ASKED)))
        assert any("remembers" in says for _, says in page.evaluate("said"))

        # an answer without end is ended; where Python cannot, the next answer has a new Python
        for word in (ENDLESS, DEAF):
            assert re.match(r"ended after \d+ s: ", ask(page, answers={"p": word}))
            assert ask(page) == json.loads(answer(json.dumps(ASKED)))

        # and one that is nested as deeply as can be is refused
        refused, _ = ask(page, exercise="4.1", answers={"F": "-" * 3900 + "s"})["verdicts"]
        assert "very long" in refused["says"]
        assert ask(page) == json.loads(answer(json.dumps(ASKED)))

        # what was not visited says so, and leads to what was
        page.goto(small.address + "two.html")
        assert page.inner_text("h1") == "No network"
        assert page.eval_on_selector_all("li a", "links => links.map(link => link.innerText)") == ["one.html"]
        assert complaints == []
        context.close()

    def test_all_pages_share_one_python_and_none_keeps_it_from_the_others(self, chromium, small):
        context = chromium.new_context()
        page = context.new_page()
        page.goto(small.address + "one.html")
        ask(page)
        small.asked.clear()
        page.goto(small.address + "two.html")
        assert ask(page) == json.loads(answer(json.dumps(ASKED)))
        other = context.new_page()
        other.goto(small.address + "one.html")
        assert ask(other) == json.loads(answer(json.dumps(ASKED)))
        assert [one for one in small.asked if one.startswith(("wheels", "runtime"))] == []
        assert page.evaluate("said") == other.evaluate("said") == [], "nobody waited for Python"

        assert re.match(r"ended after \d+ s: ", ask(page, answers={"p": ENDLESS}))
        assert page.evaluate("localStorage['loopbook python']") is None, "Python outlives that"

        # while one page waits for what never ends, another one asks
        late = json.dumps(ASKED | {"answers": {"p": DEAF}})
        page.evaluate(f"window.late = judge.ask({late}).catch((error) => error.message), undefined")
        assert ask(other) == json.loads(answer(json.dumps(ASKED)))
        assert re.match(r"ended after \d+ s: ", page.evaluate("late"))
        assert page.evaluate("localStorage['loopbook python']") == "1"
        assert ask(page) == json.loads(answer(json.dumps(ASKED)))
        context.close()

    def test_a_browser_without_shared_workers_has_a_python_for_each_page(self, chromium, small):
        context = chromium.new_context()
        context.add_init_script("delete window.SharedWorker")
        page = context.new_page()
        page.goto(small.address + "one.html")
        assert ask(page) == json.loads(answer(json.dumps(ASKED)))
        for word in (ENDLESS, DEAF):
            assert re.match(r"ended after \d+ s: ", ask(page, answers={"p": word}))
            assert ask(page) == json.loads(answer(json.dumps(ASKED)))
        context.close()

    def test_what_is_missing_or_changed_is_told_and_tried_again(self, chromium, small):
        page = chromium.new_page()
        page.goto(small.address + "one.html")
        wheel = next((small.folder / "wheels").glob("pint-*.whl"))
        content = wheel.read_bytes()
        wheel.unlink()
        assert ask(page) == (
            f"{wheel.name} could not be loaded from {small.address.split('/')[2]} (404): is there a network?"
        )
        wheel.write_bytes(content[:-1] + b"?")
        assert ask(page).startswith(f"{wheel.name} is not the file that was expected")
        page.close()

    def test_a_new_site_takes_the_place_of_the_old_one(self, chromium, small):
        context = chromium.new_context()
        page = context.new_page()
        page.goto(small.address + "one.html")
        browser_runtime.wait_until_kept(page, "one.html")
        (small.folder / "one.html").write_text(
            (small.folder / "one.html").read_text(encoding="utf-8").replace("<h1>one", "<h1>new"), encoding="utf-8"
        )
        site.write(small.folder, True)
        page.reload()
        assert page.inner_text("h1") == "new"
        # a browser looks for a new service worker once a visit, and may have been looking when the site was changed
        page.evaluate("async () => { await (await navigator.serviceWorker.getRegistration())?.update(); }")
        pages, version = 'all.filter((one) => one.startsWith("loopbook pages"))', site.content(small.folder)
        condition = f"{pages}.length === 1 && {pages}[0].endsWith({json.dumps(version)})"
        browser_runtime.wait_until(page, condition)
        context.close()
