"""Released notebooks: a notebook for each student, in which nothing tells of the key."""

import ast
import dataclasses
import re

import nbformat
import pytest
from hypothesis import given
from hypothesis import strategies as st

import exercisegrader.release
from assignments import HEAD, ONE, students, written
from exercisegrader import GradingError
from exercisegrader.assignment import Assignment
from exercisegrader.release import as_markdown, as_text, asked, installed, notebook, release, wrapped


def code(made):
    return [cell.source for cell in made.cells if cell.cell_type == "code"]


@pytest.mark.parametrize("address", ["https://github.com/OWNER/NAME", ""])
def test_a_released_notebook_leads_to_the_repository_where_it_has_an_address(tuning, monkeypatch, address):
    known = dataclasses.replace(installed(), repository=address)
    monkeypatch.setattr(exercisegrader.release, "installed", lambda: known)
    introduction = notebook(tuning, *students("Ada")).cells[0].source
    assert ("    %pip install git+https://github.com/OWNER/NAME\n" in introduction) == bool(address)
    assert ("git+" in introduction) == bool(address)


def test_a_released_notebook(tuning):
    made = notebook(tuning, *students("Zoë *Ng*"))
    nbformat.validate(made)
    texts = [cell.source for cell in made.cells if cell.cell_type == "markdown"]
    assert texts[0].startswith("# Tuning $K$\n\n**Zoë \\*Ng\\*** (`s1001`)\n\nAn introduction.\n\n")
    for text, number in zip(texts[1:], "12", strict=True):
        statement = str(tuning.question("s1001", number).statement)
        assert text.startswith(f"{statement}\n\n<details><summary>How your answers are read</summary>\n\n- `")
    assert "- `Kp`: a number, in %/K (to 1\N{NO-BREAK SPACE}%)\n" in texts[1]
    assert "- `H`: an expression (in any form, each number in it" in texts[1]
    assert f"released with {installed().module.partition('.')[0]} {installed().version}." in texts[0]
    assert code(made)[-3:] == [
        'sheet.answer("1", Kp=..., H=..., y=..., A=..., p=...)', 'sheet.answer("2", C=..., w=..., W=...)', "sheet"
    ]  # fmt: skip
    assert made.metadata.loopbook["student"] == "s1001"
    assert all(cell.execution_count is None and not cell.outputs for cell in made.cells if cell.cell_type == "code")
    names = {}
    for cell in code(made):
        exec(cell, names)
    assert "8 of 8 not answered yet" in repr(names["sheet"])


def _says_nothing(cell):
    """No number stands in the code of a notebook."""
    values = [node.value for node in ast.walk(ast.parse(cell)) if isinstance(node, ast.Constant)]
    assert {type(value) for value in values} <= {str, bool, type(...)}, values


def test_a_notebook_reveals_nothing_of_the_key(tuning):
    for student in students(*["Ada"] * 20):
        made = notebook(tuning, student)
        forms = {"1", "2", "K", "%", "%/K", "q s z", "direct", "reverse", "other", tuning.title, student.id}
        for cell in code(made):
            _says_nothing(cell)
            assert {n.value for n in ast.walk(ast.parse(cell)) if isinstance(n, ast.Constant)} - {..., True} <= forms
        stored = as_text(made)
        assert "within" not in stored
        assert "7.125" not in stored
        assert tuning.secret not in stored
        for place in tuning.exercises:
            for name, kind in tuning.question(student.id, place).key.items():
                if name not in ("w", "W"):  # their words are those that are offered
                    assert kind.solution not in stored


@pytest.mark.parametrize(
    "other", [{"gain": "-3"}, {"within": ", within=0.2"}, {"letter": "sympy.Symbol('q')"}, {"word": "reverse"}]
)
def test_another_key_gives_the_same_code(tuning, other):
    (student,) = students("Ada")
    assert code(notebook(Assignment.of(written(**other), "tuning"), student)) == code(notebook(tuning, student))


def test_releasing_twice_writes_the_same_bytes(tuning, tmp_path):
    class_list = students("Ada", "Norbert")
    paths = release(tuning, class_list, tmp_path).paths
    assert [path.relative_to(tmp_path).as_posix() for path in paths] == ["s1001/tuning.ipynb", "s1002/tuning.ipynb"]
    before = [(path.read_bytes(), path.stat().st_mtime_ns) for path in paths]
    done = release(tuning, class_list, tmp_path)
    assert (done.paths, done.kept, done.record) == (paths, ("s1001", "s1002"), None)
    assert [(path.read_bytes(), path.stat().st_mtime_ns) for path in paths] == before


@pytest.mark.parametrize("content", ["work", "of another", "no notebook", "{}"])
@pytest.mark.parametrize("replace", [False, True])
def test_what_is_in_the_way_is_not_overwritten(tuning, tmp_path, content, replace):
    path = release(tuning, students("Ada"), tmp_path).paths[0]
    if content == "of another":
        content = path.read_text(encoding="utf-8").replace("s1001", "s1009")
    elif content == "work":
        content = as_text(nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell("1")]))
    path.write_text(content, encoding="utf-8")
    with pytest.raises(GradingError, match=r"tuning\.ipynb is in the way and no notebook of this release"):
        release(tuning, students("Ada", "Norbert"), tmp_path, replace=replace)
    assert path.read_text(encoding="utf-8") == content
    assert not (tmp_path / "s1002").exists()


@pytest.mark.parametrize(
    ("key", "says"),
    [
        ("y=1/(x - x)", "exercise 1 of tuning for student s1001: "),
        ("**{'a b': x}", "asks for 'a b': expected a name"),
        ("**{'if': x}", "asks for 'if': expected a name"),
    ],
)
def test_nothing_is_written_where_a_variant_fails(tmp_path, key, says):
    assignment = Assignment.of(HEAD + ONE.format('"1"', 1, key), "tuning")
    with pytest.raises(GradingError, match=says):
        release(assignment, students("Ada"), tmp_path)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("{K} and", "{Kp} and", "exercise 1 has {Kp} in a text: expected one of K, T, or {{Kp}} for the braces"),
        ("is wrong.", "is wrong: {x}.", "exercise 1 has {x} in a text"),
        (
            '{"Kp": 7',
            '{"Kp": "much" or 7',
            'mistake "That is wrong." of Kp in exercise 1 is not a possible answer for K',
        ),
        ("above=-10)", "above=8)", "the key of C in exercise 2 would not be right for K = "),
    ],
)
def test_what_an_author_overlooks_is_said_before_anything_is_written(tmp_path, old, new, says):
    text = written()
    assert old in text
    with pytest.raises(GradingError, match=re.escape(says)):
        release(Assignment.of(text.replace(old, new), "tuning"), students("Ada"), tmp_path)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("text", [r"$\frac{a}{b} {c}$", r"$${c}$$", "`{c}`", r"\begin{align}", "{{c}}", "{1}", "x_{c}"])
def test_braces_of_formulas_and_code_stay(text):
    twice = ONE.format('"1"', 1, "y=number(x)").replace('"x is {x}"', f'r"""{text}"""')
    question = asked(Assignment.of(HEAD + twice, "twice"), "s1", "1")
    assert text.replace("{{c}}", "{c}") in question.statement.body


@pytest.mark.parametrize(
    "name",
    [
        "O'Brien, José-Luis (Pepe)",
        "*a* _b_ `c` [d](http://e.example) <b>f</b> &amp; \\g $h$ #i\n# j ![k](l) {m} ~~n~~ @o",
    ],
)
def test_a_name_is_data(name):
    found = as_markdown(name)
    assert "\n" not in found
    assert not re.search(r"(?<!\\)[*_`\[\]{}~!:.@]|<(?!/?span>)|\$|&amp; ", found)
    assert as_markdown("O'Brien, José-Luis (Pepe)") == "O'Brien, José-Luis (Pepe)"


@given(st.lists(st.text("abc, ()\"'[]", min_size=0, max_size=60), max_size=12))
def test_wrapped_code_is_the_same_code(words):
    call = f"sheet.asks({', '.join(['1', *(f'{chr(97 + k)}=word([{w!r}, {w!r}])' for k, w in enumerate(words))])})"
    assert ast.dump(ast.parse(wrapped(call))) == ast.dump(ast.parse(call))
