"""Exercises as forms: what is typed in their fields is judged as the same text in a notebook."""

import json

import pytest

import contributing
from exercisebook.authoring import Exercise, answers, between
from exercisebook.forms import Desk, Sheet
from exercisebook.forms.controls import html as controls_of
from exercisebook.forms.fields import field_of
from exercisebook.forms.text import html as html_of
from exercisebook.forms.text import inline, sentence
from exercisebook.kinds import Expression, Number, Words
from exercisebook.kinds.by_hand import Figure, Text
from exercisebook.kinds.kind import ELSEWHERE, LINE, LINES, ORDER, SEVERAL
from judged import EVERY_KIND
from shelf import exercise
from springs import Coil, Spring
from typed import Read, assert_is_whole, assert_tells_nothing, typed

answer = Desk(exercise).answer


def asked(**request):
    return json.loads(answer(json.dumps(request)))


@pytest.mark.parametrize("number", ["1.1", "1.2", "2.1"])
@pytest.mark.parametrize("student", [None, "Mira"])
def test_every_form_is_whole_and_the_keys_typed_in_its_fields_are_right(number, student):
    sheet = Sheet(exercise(number, student))
    assert_is_whole(sheet)
    answers = {name: typed(kind) for name, kind in sheet.question.key.items()}
    assert asked(do="check", exercise=number, student=student, answers=answers)["right"]


@pytest.mark.parametrize(
    ("number", "answers", "given"),
    [
        ("1.1", {"t": "0,05 min", "a": "5"}, {"t": "0,05 min", "a": "5"}),
        ("1.1", {"t": "65", "a": "x", "b": " "}, {"t": "65", "a": "x"}),
        ("1.2", {"flying": ["drag"], "on": ["none"], "way": ""}, {"flying": ["drag"], "on": "none"}),
        ("1.2", {"order": "thrown, caught", "h": "10t - 5t²"}, {"order": "thrown, caught", "h": "10t - 5t²"}),
    ],
)
def test_what_is_typed_is_judged_as_in_a_notebook(number, answers, given):
    reply, response = asked(do="check", exercise=number, answers=answers), exercise(number).check(**given)
    found = [(one["name"], one["status"], one["says"]) for one in reply["verdicts"]]
    assert found == [(one.name, one.status, one.says) for one in response.verdicts]
    assert (reply["right"], reply["says"]) == (response.is_right, response.summary)


@pytest.mark.parametrize(
    ("typed_in", "status"),
    [
        ({"k": "2", "l": "0.5"}, "right"),
        ({"k": "Coil(2, 0.5)"}, "right"),  # the whole in the place of a part
        ({"k": "2", "l": " "}, "not judged"),
        ({"k": " ", "l": ""}, "open"),
        ({"k": "", "form": "serial"}, "open"),
    ],
)
@pytest.mark.usefixtures("mechanics")
def test_something_whole_is_typed_in_its_parts(typed_in, status):
    def one(x=between(1, 9)):
        """A spring for {x}."""
        return answers(spring=Spring(Coil(2, 0.5)))

    sheet = Sheet(Exercise("1", "A spring", 1, lambda: True, one).question())
    assert [field["status"] for field in sheet.check({"spring": typed_in})["verdicts"]] == [status]
    assert 'data-part="k"' in sheet.controls


def test_a_response_offers_what_a_page_has():
    """A hint is a button, the next exercise a link, and what a design does is drawn with its description."""
    replies = [asked(do="check", exercise="1.1", student="Noor", answers={"t": "9999"}) for _ in range(3)]
    assert "A hint is one press away." in replies[-1]["html"]
    key = exercise("1.1", "Noor").key
    reply = asked(do="check", exercise="1.1", student="Noor", answers={name: typed(one) for name, one in key.items()})
    assert '<a href="#exercise-1-2">Exercise 1.2 · ' in reply["html"]
    [drawn] = Read(asked(do="check", exercise="1.2", answers={"slow": "4"})["html"]).all("img")
    assert drawn["alt"] == "The path for 4 m/s."
    assert drawn["src"].startswith("data:image/png;base64,")


def test_numbers_of_ones_own_are_those_of_the_notebooks():
    reply = asked(do="show", exercise="1.1", student=" Mira ")
    assert Read(reply["html"]).text.startswith(Read(html_of(exercise("1.1", "Mira").statement.body)).text)
    assert reply["html"] != asked(do="show", exercise="1.1")["html"]
    shown = [one["data-name"] for one in Read(reply["controls"]).all("div", "fieldset") if "data-name" in one]
    assert shown == ["t", "a"]


def test_hints_go_one_step_further_each_and_the_solution_waits_for_nobody():
    texts = [asked(do="hint", exercise="1.1", rung=rung) for rung in (1, 2, 3, 4)]
    assert len({one["html"] for one in texts}) == 4
    assert "The rest is yours." in texts[-1]["html"]
    assert "<math" in asked(do="solution", exercise="1.1")["html"]
    assert asked(do="prepare", exercise="1.1") == {}


@pytest.mark.parametrize(
    ("request_", "says"),
    [
        ("{", "the request is no JSON"),
        ("[1]", "the request is no table"),
        ('{"do": "chek", "exercise": "1.1"}', "did you mean 'check'"),
        ('{"do": ["check"], "exercise": "1.1"}', "the request asks to do"),
        ('{"do": "show", "exercise": "1.99"}', "there is no exercise '1.99'"),
        ('{"do": "show", "exercise": 1}', "expected chapter and place in it as text"),
        ('{"do": "show", "exercise": "1.1", "student": ""}', "expected a name"),
        ('{"do": "show", "exercise": "1.1", "student": 5}', "expected a name"),
        ('{"do": "hint", "exercise": "1.1", "rung": 9}', "expected one from 1 to 4"),
        ('{"do": "check", "exercise": "1.1", "answers": [1]}', "expected texts by the names of the fields"),
        ('{"do": "check", "exercise": "1.1", "answers": {"t": 8.5}}', "the answer to t is 8.5: expected a text"),
        ('{"do": "check", "exercise": "1.1", "answers": {"t": {"k": 1}}}', "expected a text"),
        ('{"do": "check", "exercise": "1.1", "answers": {"t": "%s"}}' % ("1" * 20_001), "expected at most 20000"),
    ],
)
def test_what_cannot_be_answered_is_said_in_a_sentence(request_, says):
    reply = json.loads(answer(request_))
    assert list(reply) == ["problem"]
    assert says in reply["problem"]


def test_markup_in_an_answer_is_text():
    reply = asked(do="check", exercise="1.1", answers={"t": '<img src=x onerror="alert(1)">$x$'})
    for one in reply["verdicts"]:
        assert "<img" not in one["html"]
        assert Read(one["html"]).text.replace("\xa0", " ") == one["says"].replace("\xa0", " ")


def test_nothing_is_written_and_no_file_is_read(own_folder, monkeypatch):
    (own_folder / ".loopbook-student.json").write_text('{"student": "Mira"}')
    shown = asked(do="show", exercise="1.1")
    asked(do="check", exercise="1.1", answers={"t": "1.5"})
    assert [path.name for path in own_folder.iterdir()] == [".loopbook-student.json"]
    monkeypatch.setenv("LOOPBOOK_PROGRESS", "off")
    assert shown["html"] == asked(do="show", exercise="1.1")["html"]


def test_the_record_of_an_exercise_is_a_table_whose_order_of_curves_tells_nothing():
    tables = [Sheet(exercise("2.1", student)).csv.splitlines() for student in (None, *map(str, range(9)))]
    assert {lines[0] for lines in tables} == {"t,theta,A,B"}
    assert {tuple(exercise("2.1", str(k)).data)[2] for k in range(9)} == {"A", "B"}
    assert len(tables[0]) == 1 + len(exercise("2.1").data["t"])
    assert 'download="exercise-2-1.csv"' in asked(do="show", exercise="2.1")["html"]
    assert Sheet(exercise("1.1")).download() == Sheet(exercise("1.1")).csv == ""


def test_a_page_names_the_file_and_not_what_a_notebook_calls():
    assert "<code>t, theta</code> in the file below are its record" in Sheet(exercise("2.1")).text


def test_what_nobody_sees_is_not_read():
    assert asked(do="check", exercise="1.1", answers={"t": "4\u200b"})["verdicts"][0]["status"] == "right"


class TestFields:
    def test_a_kind_that_a_form_does_not_know_is_typed_in_lines(self):
        field = field_of("x", contributing.kind()((4, 20), "mA"))
        assert (field.control, field.help) == (LINES, "Expected: two numbers, the lower one first.")

    @pytest.mark.parametrize("kind", EVERY_KIND.values(), ids=EVERY_KIND)
    def test_a_field_says_nothing_of_the_key(self, kind):
        assert_tells_nothing("x", kind, field_of)

    @pytest.mark.parametrize(
        ("kind", "control", "says"),
        [
            (Words(["b", "a"], ["a", "b", "c"], ordered=True), ORDER, "in their order"),
            (Words(["b"], ["a", "b", "c"]), SEVERAL, "none of them"),
            (Expression("a/b"), LINE, "an expression in a, b"),
            (Text("why it bounces", words=20), LINES, ""),
            (Figure("the path"), ELSEWHERE, "this one is answered in JupyterLab"),
        ],
    )
    def test_how_it_is_filled_in_is_said(self, kind, control, says):
        field = field_of("x", kind)
        assert field.control == control
        assert says in field.help
        assert f'data-control="{control}"' in controls_of("1.1", field)

    def test_words_are_in_the_order_of_the_variant(self):
        kind = exercise("1.2", "Mira").key["order"]
        [field] = [one for one in Sheet(exercise("1.2", "Mira")).fields if one.name == "order"]
        assert field.words == kind.among

    def test_many_words_are_a_list_that_opens(self):
        kind = EVERY_KIND['word(["direct", "reverse"])']
        assert "<select" not in controls_of("1.1", field_of("x", kind))
        many = type(kind)("7", [str(k) for k in range(9)])
        assert "<select" in controls_of("1.1", field_of("x", many))

    def test_what_counts_more_is_said(self):
        assert "counts double" in controls_of("1.1", field_of("x", Number(2), weight=2))
        assert "counts 3 times" in controls_of("1.1", field_of("x", Number(2), weight=3))
        assert "counts" not in controls_of("1.1", field_of("x", Number(2)))


@pytest.mark.parametrize(
    ("shown", "html"),
    [
        # a formula holds no elements of a page, and one alone is no paragraph
        (html_of(r"$\text{<b>x</b>}$"), r"<p><code>\text{&lt;b&gt;x&lt;/b&gt;}</code></p>"),
        (html_of("$$x$$"), '<div class="math block" tabindex="0"><math display="block"><mi>x</mi></math></div>'),
        (html_of("so\n$$x$$\nit is").partition(" class")[0], "<p>so\n<span"),
        # code keeps its dollars, and an amount of money is no formula
        (inline("`a $b$ c`"), "<code>a $b$ c</code>"),
        (inline("5 $"), "5 $"),
        (sentence("that costs 5 $ & more"), "that costs 5 $ &amp; more"),
        (html_of("| a | b |\n|---|---|\n| 1 | $x$ |")[:39], '<div class="table" tabindex="0"><table>'),
    ],
)
def test_texts(shown, html):
    assert shown == html


def test_a_dollar_within_braces_ends_no_formula():
    assert "$" not in inline(r"so $\text{for $D$ here}$ it is")
