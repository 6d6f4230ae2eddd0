"""Exercises as forms: every one has its fields, and what is typed in them is judged as the same text in a notebook."""

import html.parser
import json

import pytest
import sympy

import contributing
from draws import of_the_day
from exercisebook.forms.fields import field_of
from exercisebook.forms.text import html as html_of
from exercisebook.forms.text import inline, sentence
from exercisebook.kinds.by_hand import Figure, Text
from exercisebook.kinds.kind import ELSEWHERE, LINE, LINES, ONE, ORDER, PARTS, SEVERAL
from loopbook.exercises import ExerciseError, bank, exercise
from loopbook.exercises.forms import Sheet, answer
from loopbook.exercises.kinds import Design, Number, Settings, Words
from loopbook.pid import PID

NUMBERS = [number for chapter in bank.chapters() for number in bank.exercises(chapter)]
EMPTY = {"img", "input", "br"}


def asked(**request):
    return json.loads(answer(json.dumps(request)))


class Read(html.parser.HTMLParser):
    """What HTML holds: its elements, its text, and whether each one is closed as it was opened."""

    def __init__(self, text):
        super().__init__()
        self.elements, self.text, self.open, self.torn = [], "", [], []
        self.feed(text)
        self.torn += self.open

    def handle_starttag(self, tag, attrs):
        self.elements.append((tag, dict(attrs)))
        if tag not in EMPTY:
            self.open.append(tag)

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            self.torn.append(tag)

    def handle_data(self, data):
        self.text += data

    def all(self, *tags):
        return [attributes for tag, attributes in self.elements if tag in tags]


def typed(kind):
    """The key of a quantity as somebody would type it in its field, or choose it."""
    kind = getattr(kind, "example", kind)
    maker, key = kind.maker, kind.key
    if maker == "settings":
        numbers = {name: f"{float(getattr(key, name)):.8g}" for name in ("Kp", "Ti", "Td", "Tf")}
        shown = {name: "" if text in ("0", "inf") else text for name, text in numbers.items()}
        return shown | ({"form": key.form} if kind.form == "any" else {})
    if maker == "words":
        return ", ".join(key) if kind.ordered else (list(key) or ["none"])
    if maker in ("expression", "transfer_function", "time_function"):
        return str(kind.expr.xreplace({number: sympy.Float(number, 9) for number in kind.expr.atoms(sympy.Rational)
                                       if number.q > 1000}))  # fmt: skip
    if maker == "number":
        return f"{key:.10g}"
    return key if isinstance(key, str) else kind.as_code()


def test_the_keys_typed_in_the_fields_are_right():
    """Of each kind there are many: a quarter a day. That a key is right in every form is proved of every exercise."""
    for number in of_the_day(NUMBERS, len(NUMBERS) // 4, "typed"):
        answers = {name: typed(kind) for name, kind in Sheet(exercise(number)).question.key.items()}
        reply = asked(do="check", exercise=number, answers=answers)
        assert reply.get("right"), (number, answers, reply)


def test_every_form_is_whole():
    """HTML that is closed as it is opened, MathML and no LaTeX, and for each quantity a field with a label."""
    for number in of_the_day(NUMBERS, len(NUMBERS) // 2, "forms"):
        sheet = Sheet(exercise(number, "Mira"))
        parts = {"text": sheet.text, "asked": sheet.asked, "accuracy": sheet.accuracy, "controls": sheet.controls}
        parts |= {f"hint {rung}": sheet.hint(rung) for rung in range(1, sheet.rungs + 1)}
        parts["solution"] = sheet.solution_text
        for name, text in parts.items():
            read = Read(text)
            assert not read.torn, (number, name)
            assert "$" not in read.text, (number, name)
            assert "\\" not in read.text.replace("\\n", ""), (number, name)
        controls = Read(parts["controls"])
        ids = [one["id"] for _, one in controls.elements if "id" in one]
        assert len(set(ids)) == len(ids)
        assert [one["data-name"] for one in controls.all("div", "fieldset") if "data-name" in one] == list(
            sheet.question.key
        )
        assert {one["for"] for one in controls.all("label") if "for" in one} <= set(ids)
        described = {name for one in controls.all("input", "select", "textarea")
                     for name in one.get("aria-describedby", "").split()}  # fmt: skip
        assert described <= set(ids)
        assert len(Read(sheet.asked).all("li")) == len(sheet.question.key)


PI_2_10 = {"Kp": "2", "Ti": "10 min"}
TWO_STEPS = "Wait -> Fill: start\nFill: inlet on"


@pytest.mark.parametrize(
    ("number", "answers", "given"),
    [
        ("7.1", {"p": "0.85 MPa", "I": "14,4"}, {"p": "0.85 MPa", "I": "14,4"}),
        ("7.1", {"p": "65", "I": "x", "K_p": " "}, {"p": "65", "I": "x"}),
        ("10.7", {"pid": PI_2_10 | {"Td": "", "form": "parallel"}}, {"pid": PI_2_10}),
        ("10.7", {"pid": {"Kp": "x", "Ti": "10"}}, {"pid": {"Kp": "x", "Ti": "10"}}),
        ("10.7", {"pid": "PI with K_c = 2 and tau_I = 10"}, {"pid": "PI with K_c = 2 and tau_I = 10"}),
        ("12.8", {"active": ["Hold"], "on": ["none"], "waits_for": ""}, {"active": ["Hold"], "on": "none"}),
        ("13.2", {"poles": "-1 ± 2j"}, {"poles": "-1 ± 2j"}),
        ("12.9", {"chart": TWO_STEPS}, {"chart": TWO_STEPS}),
    ],
)  # fmt: skip
def test_what_is_typed_is_judged_as_in_a_notebook(number, answers, given):
    reply, response = asked(do="check", exercise=number, answers=answers), exercise(number).check(**given)
    found = [(one["name"], one["status"], one["says"]) for one in reply["verdicts"]]
    assert found == [(one.name, one.status, one.says) for one in response.verdicts]
    assert (reply["right"], reply["says"]) == (response.is_right, response.summary)


def test_a_response_offers_what_a_page_has():
    """A hint is a button, the next exercise a link, and what a design does is drawn with its description."""
    replies = [asked(do="check", exercise="10.1", student="Noor", answers={"K": "77"}) for _ in range(3)]
    assert "A hint is one press away." in replies[-1]["html"]
    key = Sheet(exercise("10.1", "Noor")).question.key
    reply = asked(do="check", exercise="10.1", student="Noor", answers={name: typed(one) for name, one in key.items()})
    assert '<a href="#exercise-10-2">Exercise 10.2 · ' in reply["html"]
    drawn = Read(asked(do="check", exercise="10.7", answers={"pid": {"Kp": "2", "Ti": "10"}})["html"]).all("img")
    assert drawn[0]["alt"]
    assert drawn[0]["src"].startswith("data:image/png;base64,")


def test_numbers_of_ones_own_are_those_of_the_notebooks():
    reply = asked(do="show", exercise="10.1", student=" Mira ")
    assert Read(reply["html"]).text.startswith(Read(html_of(exercise("10.1", "Mira").statement.body)).text[:200])
    assert reply["html"] != asked(do="show", exercise="10.1")["html"]
    assert [field["name"] for field in reply["fields"]] == list(exercise("10.1", "Mira").key)


def test_hints_go_one_step_further_each_and_the_solution_waits_for_nobody():
    texts = [asked(do="hint", exercise="7.1", rung=rung) for rung in (1, 2, 3, 4)]
    assert [(one["rung"], one["of"]) for one in texts] == [(1, 4), (2, 4), (3, 4), (4, 4)]
    assert len({one["html"] for one in texts}) == 4
    assert "The rest is yours." in texts[-1]["html"]
    assert "<math" in asked(do="solution", exercise="7.1")["html"]


@pytest.mark.parametrize(
    ("request_", "says"),
    [
        ("{", "the request is no JSON"),
        ("[1]", "the request is no table"),
        ('{"do": "chek", "exercise": "7.1"}', "did you mean 'check'"),
        ('{"do": ["check"], "exercise": "7.1"}', "the request asks to do"),
        ('{"do": "show", "exercise": "7.99"}', "there is no exercise '7.99'"),
        ('{"do": "show", "exercise": 7}', "expected chapter and place in it as text"),
        ('{"do": "show", "exercise": "7.1", "student": ""}', "expected a name"),
        ('{"do": "show", "exercise": "7.1", "student": 5}', "expected a name"),
        ('{"do": "hint", "exercise": "7.1", "rung": 9}', "expected one from 1 to 4"),
        ('{"do": "check", "exercise": "7.1", "answers": [1]}', "expected texts by the names of the fields"),
        ('{"do": "check", "exercise": "7.1", "answers": {"p": 8.5}}', "the answer to p is 8.5: expected a text"),
        ('{"do": "check", "exercise": "7.1", "answers": {"p": {"Kp": 1}}}', "expected a text"),
        ('{"do": "check", "exercise": "7.1", "answers": {"p": "%s"}}' % ("1" * 20_001), "expected at most 20000"),
    ],
)
def test_what_cannot_be_answered_is_said_in_a_sentence(request_, says):
    reply = json.loads(answer(request_))
    assert list(reply) == ["problem"]
    assert says in reply["problem"]


def test_markup_in_an_answer_is_text():
    reply = asked(do="check", exercise="7.1", answers={"p": '<img src=x onerror="alert(1)">$x$'})
    for one in reply["verdicts"]:
        assert "<img" not in one["html"]
        assert Read(one["html"]).text.replace("\xa0", " ") == one["says"].replace("\xa0", " ")


def test_nothing_is_written_and_no_file_is_read(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("LOOPBOOK_PROGRESS", raising=False)
    (tmp_path / ".loopbook-student.json").write_text('{"student": "Mira"}')
    shown = asked(do="show", exercise="10.1")
    asked(do="check", exercise="10.1", answers={"K": "1.5"})
    assert [path.name for path in tmp_path.iterdir()] == [".loopbook-student.json"]
    monkeypatch.setenv("LOOPBOOK_PROGRESS", "off")
    assert shown["html"] == asked(do="show", exercise="10.1")["html"]


def test_the_record_of_an_exercise_is_a_table():
    lines = Sheet(exercise("10.8")).csv.splitlines()
    assert lines[0] == "t,u,y"
    assert len(lines) == 1 + len(exercise("10.8").data["t"])
    assert 'download="exercise-10-8.csv"' in asked(do="show", exercise="10.8")["html"]
    assert Sheet(exercise("7.1")).download() == Sheet(exercise("7.1")).csv == ""


def test_the_order_of_curves_tells_nothing():
    assert (
        Sheet(exercise("14.7")).csv.splitlines()[0]
        == Sheet(exercise("14.7", "Mira")).csv.splitlines()[0]
        == "t,y,A,B,C,D"
    )


def test_a_page_names_the_file_and_not_what_a_notebook_calls():
    assert "<code>t, h</code> in the file below are its times" in Sheet(exercise("1.5")).text
    assert not [number for number in NUMBERS if "given(" in Sheet(exercise(number)).text]


def test_a_whole_controller_is_read_in_the_place_of_a_setting():
    whole = asked(do="check", exercise="7.3", answers={"pid": {"Kp": "PID(1.25, 40)"}})
    assert (
        whole["verdicts"] == asked(do="check", exercise="7.3", answers={"pid": {"Kp": "1.25", "Ti": "40"}})["verdicts"]
    )


def test_what_nobody_sees_is_not_read():
    assert asked(do="check", exercise="10.1", answers={"K": "1.5\u200b"})["verdicts"][0]["status"] == "right"


class TestFields:
    def test_a_kind_has_a_field_of_its_own(self):
        kinds = [kind for number in NUMBERS for kind in exercise(number).key.values()]
        controls = {getattr(kind, "example", kind).maker: field_of("x", kind).control for kind in kinds}
        assert controls.pop("words") in (SEVERAL, ORDER)
        assert controls.items() >= {
            "number": LINE, "numbers": LINE, "poles": LINE, "expression": LINE, "transfer_function": LINE,
            "time_function": LINE, "word": ONE, "settings": PARTS, "sequential_chart": LINES,
            "instrument_diagram": LINES,
        }.items()  # fmt: skip

    def test_a_kind_that_a_form_does_not_know_is_typed_in_lines(self):
        field = field_of("x", contributing.kind()((4, 20), "mA"))
        assert (field.control, field.help) == (LINES, "Expected: two numbers, the lower one first.")

    def test_a_field_says_nothing_of_the_key(self):
        for number in NUMBERS:
            for name, kind in exercise(number).key.items():
                blank = object.__new__(type(kind))
                shape = kind.key if kind.maker == "numbers" else None  # whether a table is asked for is said
                blank.__dict__ |= kind.__dict__ | {"key": shape, "expr": None}
                if isinstance(kind, Design):
                    blank.example = kind.example.keyless
                    blank.example.what = kind.example.what
                assert field_of(name, blank) == field_of(name, kind), number

    @pytest.mark.parametrize(
        ("kind", "control", "says"),
        [
            (Words(["b", "a"], ["a", "b", "c"], ordered=True), ORDER, "in their order"),
            (Words(["b"], ["a", "b", "c"]), SEVERAL, "none of them"),
            (Settings(PID(2, Ti=3), form="serial"), PARTS, "Leave empty what the controller does not have."),
            (Text("why it oscillates", words=20), LINES, ""),
            (Figure("the step response"), ELSEWHERE, "this one is answered in JupyterLab"),
        ],
    )
    def test_how_it_is_filled_in_is_said(self, kind, control, says):
        field = field_of("x", kind)
        assert field.control == control
        assert says in field.help

    def test_where_both_forms_are_right_one_is_chosen(self):
        assert field_of("x", Settings(PID(2, Ti=3))).data["forms"] == ("parallel", "serial")
        assert "forms" not in field_of("x", Settings(PID(2, Ti=3), form="parallel")).data

    def test_words_are_in_the_order_of_the_variant(self):
        kind = exercise("1.1", "Mira").key["a"]
        [field] = [one for one in Sheet(exercise("1.1", "Mira")).fields if one.name == "a"]
        assert field.words == kind.among

    def test_what_counts_more_is_said(self):
        from exercisebook.forms.controls import html

        assert "counts double" in html("1.1", field_of("x", Number(2), weight=2))
        assert "counts 3 times" in html("1.1", field_of("x", Number(2), weight=3))
        assert "counts" not in html("1.1", field_of("x", Number(2)))


class TestTexts:
    def test_a_dollar_within_braces_ends_no_formula(self):
        assert "$" not in inline(r"so $\text{for $D$ here}$ it is")

    def test_a_formula_holds_no_elements_of_a_page(self):
        assert html_of(r"$\text{<b>x</b>}$") == r"<p><code>\text{&lt;b&gt;x&lt;/b&gt;}</code></p>"

    def test_a_formula_alone_is_no_paragraph_and_one_in_a_text_is(self):
        assert html_of("$$x$$").startswith('<div class="math block"')
        assert html_of("so\n$$x$$\nit is").startswith("<p>so\n<span")

    def test_code_keeps_its_dollars(self):
        assert inline("`a $b$ c`") == "<code>a $b$ c</code>"

    def test_an_amount_of_money_is_no_formula(self):
        assert sentence("that costs 5 $ & more") == "that costs 5 $ &amp; more"
        assert inline("5 $") == "5 $"

    def test_a_table_is_one(self):
        assert "<table>" in html_of("| a | b |\n|---|---|\n| 1 | $x$ |")


def test_an_unknown_exercise_is_refused_as_in_a_notebook():
    with pytest.raises(ExerciseError, match=r"there is no exercise '7\.99'"):
        Sheet(exercise("7.99"))
