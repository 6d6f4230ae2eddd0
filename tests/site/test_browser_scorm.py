"""A page of exercises as a SCORM package, in a browser, within a small stand-in of a system that runs such packages."""

import json
import re
import shutil
import zipfile
from xml.etree import ElementTree

import pytest
from docs.browser import site
from playwright.sync_api import expect

import browser_runtime
from browser import PATIENCE, Complaints, served
from exercisebook.errors import ExerciseError
from loopbook.scorm import package

#: What runs a package: a page with the interface in it, which keeps what it is told, and the package in a frame.
COURSE = """<!doctype html><title>Course</title><script>
const kept = JSON.parse(sessionStorage.kept ?? "{}"), said = [];
let state = "off";
window.API = {
  LMSInitialize: (text) => String(text === "" && state === "off" && Boolean(state = "on")),
  LMSGetValue: (name) => String(state === "on" ? kept[name] ?? "" : ""),
  LMSSetValue: (name, value) => {
    if (typeof value !== "string") throw new TypeError(name);
    if (state === "on") kept[name] = value;
    return String(state === "on");
  },
  LMSCommit: () => { sessionStorage.kept = JSON.stringify(kept); return "true"; },
  LMSFinish: () => { state = "off"; return "true"; },
};
</script><iframe src="package/index.html" width="1000" height="800"></iframe>"""
NUMBERS = ["7.1", "10.1"]
IMSCP = "{http://www.imsproject.org/xsd/imscp_rootv1p1p2}"


@pytest.fixture(scope="module")
def course(book, tmp_path_factory):
    """A folder with the stand-in and an unpacked package; the site is one that needs no network."""
    whole, folder = tmp_path_factory.mktemp("offline") / "book", tmp_path_factory.mktemp("course")
    shutil.copytree(book, whole, ignore=shutil.ignore_patterns("lite", "*.pdf"))
    site.place(site.of_all(), whole, browser_runtime.required())
    site.write(whole, offline=True)
    (folder / "practice.zip").write_bytes(package(NUMBERS, "Practice & more", whole))
    zipfile.ZipFile(folder / "practice.zip").extractall(folder / "package")
    (folder / "index.html").write_text(COURSE, encoding="utf-8")
    return folder


def test_the_manifest_names_every_file(course):
    manifest = ElementTree.parse(course / "package" / "imsmanifest.xml").getroot()
    assert manifest.findtext(f"{IMSCP}metadata/{IMSCP}schemaversion") == "1.2"
    assert manifest.findtext(f".//{IMSCP}item/{IMSCP}title") == "Practice & more"
    resource = manifest.find(f".//{IMSCP}resource")
    assert resource.get("{http://www.adlnet.org/xsd/adlcp_rootv1p2}scormtype") == "sco"
    names = {
        path.relative_to(course / "package").as_posix() for path in (course / "package").rglob("*") if path.is_file()
    }
    assert {one.get("href") for one in resource} == names - {"imsmanifest.xml"}
    page = (course / "package" / "index.html").read_text(encoding="utf-8")
    assert {*re.findall(r'(?:src|href)="([^"#]+)"', page)} <= names


def test_what_is_not_in_the_site_is_named(tmp_path, course, book):
    with pytest.raises(ExerciseError, match="is not the site"):
        package(NUMBERS, "Practice", tmp_path)
    with pytest.raises(ExerciseError, match=r"exercise 7\.77 is not in"):
        package(["7.77"], "Practice", book)


class TestInACourse:
    def test_python_in_the_page_judges_and_the_course_is_told(self, chromium, course):
        with served(course) as address:
            context = chromium.new_context(service_workers="block")
            page = context.new_page()
            page.set_default_timeout(PATIENCE)
            complaints = Complaints(page, noise=("favicon",))
            page.goto(address)
            frame = page.frame_locator("iframe")
            expect(frame.locator(".lms")).to_have_text("0 of 2 are right, which your course knows.")
            self.answer(frame, K="1.5", T="75", tau="20")
            expect(frame.locator('[data-exercise="10.1"] .answer')).to_contain_text("2 of 3 right")
            assert self.kept(page)["cmi.core.score.raw"] == "0"
            self.answer(frame, tau="15")
            expect(frame.locator(".lms")).to_have_text("1 of 2 are right, which your course knows.")
            told = self.kept(page)
            assert (told["cmi.core.score.raw"], told["cmi.core.lesson_status"]) == ("50", "incomplete")
            assert json.loads(told["cmi.suspend_data"]) == ["10.1"]
            page.evaluate("localStorage.clear()")  # as in another browser
            page.reload()
            expect(frame.locator('[data-exercise="10.1"] .known')).to_have_text("✓ right")
            assert complaints == []
            context.close()

    def test_without_a_course_the_page_says_so(self, chromium, course):
        with served(course) as address:
            page = chromium.new_page()
            page.goto(f"{address}package/index.html")
            expect(page.locator(".lms")).to_contain_text("No course listens here")
            page.close()

    def answer(self, frame, **texts):
        for name, text in texts.items():
            frame.locator(f"#answer-10-1-{name}").fill(text)
        frame.locator('[data-exercise="10.1"] button.check').click()

    def kept(self, page):
        return page.evaluate("JSON.parse(sessionStorage.kept)")
