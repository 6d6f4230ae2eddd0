"""The outputs of grading: grades, pages of students, Gradescope's format, the summary."""

import csv
import html.parser
import io
import json
import random
import re
import time
from dataclasses import replace

import pytest
from typer.testing import CliRunner

import contributing
from loopbook.__main__ import app
from loopbook.exercises.authoring import answers, between, choice, exercise, expression, number, word
from loopbook.exercises.bank import exercises
from loopbook.exercises.judging import MISTAKE, OPEN, RIGHT, UNJUDGED, WRONG
from loopbook.exercises.response import MARKS
from loopbook.expressions import s
from loopbook.grading import GradingError, reports
from loopbook.grading.marking import Marked, MarkedExercise
from loopbook.grading.reports import page
from loopbook.grading.reports.equal_answers import equal_answers, significant_digits
from loopbook.grading.reports.findings import Findings
from loopbook.grading.reports.outputs import output, registered
from loopbook.grading.reports.outputs.feedback import feedback_html, feedback_markdown
from loopbook.grading.reports.outputs.grades import grades_csv
from loopbook.grading.reports.outputs.gradescope import results_json
from loopbook.grading.reports.outputs.summary import summary_html, summary_markdown
from loopbook.grading.reports.wording import NO_JAIL, answer_in_words, in_markdown, sentence_in_markdown
from loopbook.grading.results import CellError, JudgedAnswer, JudgedExercise, Result
from loopbook.grading.roster import Student

TITLE = "Tuning the air heater"
ADA, BOB, EVE, ZOE = CLASS = (
    Student("s1001", "Ada Lovelace", canvas_id="17", sis_id="900", login="ada", section="A"),
    Student("s1002", "Bob Bode"),
    Student("s1003", "=HYPERLINK(1)", canvas_id="19"),
    Student("s1004", "Zoë Ångström", login="zoe"),
)
HOSTILE = "</code><script>alert(1)</script> `*|* $x$ [a](javascript:b) \x1b[31m \u202e \ud800 \x00"


@exercise("1", title="Gain below $K_u$", points=4)
def gain(K=between(1.05, 9.95, step=0.05, reference=2), T=between(11, 99, "s", reference=20)):
    """A lag of {T} with the gain {K}."""
    return answers(
        K=number(2 * K, "K/%", "twice the gain"),
        T=number(T, "s", "the time constant"),
        H=expression(K / (T * s + 1), what="the transfer function"),
    )


@gain.mistake("The {T} are not in hours.")
def _(T):
    return {"T": T / 3600}


@gain.mistake(r"That is the gain itself, $\frac{{K}}{{1}}$, not twice of it.")
def _(K):
    return {"K": K}


@exercise("2", title="Action", points=1)
def action(way=choice("heating", "cooling")):
    """What action does a controller for {way} need?"""
    key = "reverse" if way == "heating" else "direct"
    return answers(action=word(key, ["reverse", "direct"], "the action"))


def key_in_words(kind):
    return f"{getattr(kind, 'expr', kind.key)} {kind.unit}".strip()


def result_of(student, given, course=(gain, action), **more):
    """A marked result, made by the exercises themselves: their judging of the answers of a student."""
    done = []
    for one in course:
        question = one.question(student.id)
        mine = given(question) if callable(given) else given.get(one.number, {})
        answers_ = tuple(
            JudgedAnswer(v.name, v.status, v.says, mine.get(v.name), key_in_words(question.key[v.name]))
            for v in question.check(**mine).verdicts
        )
        done.append(JudgedExercise(one.number, one.title, one.points, question.statement, (), answers_))
    file = f"{student.id}/heater.ipynb"
    usual = Result("heater", student.id, file, True, "0" * 64, "complete", "", (), (), tuple(done))
    return Marked.of(replace(usual, **more))


def changed(mark, **fields):
    """The same with other fields of its result."""
    return Marked.of(replace(mark.result, **fields))


def right(question):
    """All answers right, as plain data."""
    return {name: str(kind.expr) if hasattr(kind, "expr") else kind.key for name, kind in question.key.items()}


def own_mistake(question):
    return right(question) | ({"K": float(question.values["K"])} if "K" in question.values else {})


RIGHT_ALL = result_of(ADA, right)
NAMED = result_of(BOB, own_mistake)
STOPPED = result_of(
    EVE,
    {"1": {"K": HOSTILE.replace("\ud800", ""), "T": 1.234}},
    status="stopped",
    says="stopped in cell 4: it took longer than 60 s",
    errors=(CellError(3, f"NameError: {HOSTILE}"),),
    looks=("wrote to the answers' stream",),
)
MISSING = result_of(ZOE, {}, status="missing", file="")
RESULTS = [RIGHT_ALL, NAMED, STOPPED, MISSING]


def test_the_example_has_every_kind_of_verdict():
    statuses = {v.status for mark in RESULTS for e in mark.result.exercises for v in e.answers}
    assert statuses == {RIGHT, MISTAKE, WRONG, UNJUDGED, OPEN}


# Grades.


def rows(text):
    return list(csv.reader(io.StringIO(text)))


def test_grades_have_the_columns_that_canvas_imports():
    table = rows(grades_csv(TITLE, CLASS, RESULTS))
    assert table[0] == ["Student", "ID", "SIS User ID", "SIS Login ID", "Section", TITLE]
    assert table[1] == ["Ada Lovelace", "17", "900", "ada", "A", "5"]


def test_grades_have_two_decimals_at_most():
    assert rows(grades_csv(TITLE, CLASS, RESULTS))[2][-1] == "3.67"


def test_who_handed_in_nothing_has_no_grade():
    assert rows(grades_csv(TITLE, CLASS, RESULTS))[4][-1] == ""


def test_who_was_not_graded_has_no_row():
    assert len(rows(grades_csv(TITLE, CLASS, [NAMED]))) == 2


def test_a_roster_without_identifications_of_an_lms_is_known_by_its_own():
    assert rows(grades_csv(TITLE, CLASS, RESULTS))[2][:4] == ["Bob Bode", "", "s1002", ""]


@pytest.mark.parametrize("name", ["=1+1", "+1", "-1", "@SUM(A1)", " =1", "\t=1", "\r\n=1", "Doe;=1", "＝1", "Doe; -1"])
def test_no_name_is_a_formula(name):
    cell = rows(grades_csv(TITLE, [Student("s1", name)], [changed(RIGHT_ALL, student="s1")]))[1][0]
    assert all(not part.strip().startswith(("=", "+", "-", "@", "＝")) for part in cell.split(";"))
    assert "\n" not in cell


@pytest.mark.parametrize("name", ["Anne-Marie O'Hara", "Doe, Jane", 'Jane "J" Doe', "李 小龙", "Ünal"])
def test_other_names_stay_as_they_are(name):
    text = grades_csv(TITLE, [Student("s1", name)], [changed(RIGHT_ALL, student="s1")])
    assert rows(text)[1][0] == name


# Pages.


class Checker(html.parser.HTMLParser):
    """Complains about what is no valid page of ours; collects the text."""

    VOID = ("meta", "br", "path", "use")

    def __init__(self, text):
        super().__init__()
        self.open, self.tags, self.attributes, self.text = [], [], [], []
        self.feed(text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag, attributes):
        assert len({name for name, _ in attributes}) == len(attributes)
        self.tags.append(tag)
        self.attributes += attributes
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attributes):
        self.tags.append(tag)
        self.attributes += attributes

    def handle_endtag(self, tag):
        if tag not in self.VOID:
            assert self.open.pop() == tag

    def handle_data(self, data):
        self.text.append(data)


def pages(results):
    by_id = {student.id: student for student in CLASS}
    found = [feedback_html(TITLE, by_id[mark.result.student], mark) for mark in results]
    return [*found, summary_html(TITLE, CLASS, results, ["two notebooks: a.ipynb and <b>.ipynb; keep one"])]


@pytest.mark.parametrize("text", pages(RESULTS))
def test_pages_are_whole_and_need_nothing_else(text):
    checked = Checker(text)
    assert text.startswith('<!DOCTYPE html>\n<html lang="en">')
    assert checked.tags.count("title") == checked.tags.count("h1") == checked.tags.count("main") == 1
    assert not {"script", "link", "img", "iframe", "object", "a", "form"} & set(checked.tags)
    addresses = [value for name, value in checked.attributes if name in ("href", "src", "xlink:href")]
    assert all(value.startswith("#") for value in addresses)
    assert not [name for name, _ in checked.attributes if name.startswith("on")]
    text.encode()
    assert re.search(r"[\x00-\x09\x0b-\x1f\x7f-\x9f\u202e]", text) is None


@pytest.mark.parametrize("text", pages(RESULTS))
def test_identifiers_in_a_page_are_unique(text):
    identifiers = [value for name, value in Checker(text).attributes if name == "id"]
    assert len(set(identifiers)) == len(identifiers)


def test_a_students_texts_are_shown_and_not_run():
    text = feedback_html(TITLE, Student("s1003", HOSTILE), STOPPED)
    assert "".join(Checker(text).text).count("<script>alert(1)</script>") >= 3
    assert "<script" not in text
    assert "\\x1b[31m" in text
    assert "\\u202e" in text


def test_the_page_says_what_became_of_each_answer():
    text = "".join(Checker(feedback_html(TITLE, BOB, NAMED)).text)
    assert "3.67 of 5 points" in text
    assert "2.67 of 4 points" in text
    assert "≈ K mistake: That is the gain itself" in text
    assert f"Your answer: {float(gain.question(BOB.id).values['K']):.12g}" in text


def test_the_page_says_what_stopped_and_what_failed():
    for text in (feedback_html(TITLE, EVE, STOPPED), feedback_markdown(TITLE, EVE, STOPPED)):
        assert "stopped in cell 4: it took longer than 60 s" in text
        assert "cell 3: NameError" in text
        assert "stream" not in text  # what makes the instructor look is for the instructor


# Whatever is registered.

each_output = pytest.mark.parametrize("one", registered(), ids=lambda one: one.file)


def texts(one, results=RESULTS, students=CLASS, **more):
    return [text for _, text in one.files(TITLE, students, results, **more)]


@each_output
def test_an_output_is_one_file_or_one_for_each_student(one):
    assert len(texts(one)) == (len(RESULTS) if one.is_for_each_student else 1)
    assert len(texts(one, [])) == (0 if one.is_for_each_student else 1)


@each_output
@pytest.mark.parametrize("reveal", [False, True])
def test_keys_are_shown_only_where_they_are_revealed(one, reveal):
    """And to students alone: who grades the class has them."""
    result = result_of(ADA, {"1": {"K": 1.5}})
    exercises_ = tuple(
        replace(one, answers=tuple(replace(answer, key=f"KEY{answer.name}") for answer in one.answers))
        for one in result.result.exercises
    )
    result = changed(result, exercises=exercises_)
    (text,) = texts(one, [result], reveal=reveal)
    assert text.count("KEY") == (4 if reveal and one.is_for_each_student else 0)


@each_output
def test_without_a_jail_an_output_says_so(one):
    assert all("without a jail" in text for text in texts(one, [changed(mark, jailed=False) for mark in RESULTS]))
    assert not any("without a jail" in text for text in texts(one))


@each_output
def test_what_a_student_writes_leaves_no_output_torn(one):
    hostile = Student("s1003", HOSTILE)
    for text in texts(one, [STOPPED], [hostile]):
        text.encode()
        assert re.search(r"[\x00-\x09\x0b-\x1f\x7f-\x9f\u202e]", text) is None


def test_the_command_lists_every_output():
    told = " ".join(CliRunner().invoke(app, ["grade", "--help"], env={"COLUMNS": "200"}).output.split())
    for one in registered():
        assert f"{one.file}: {one.what}" in told


@pytest.mark.parametrize(
    ("file", "what", "makes", "says"),
    [
        ("grades.csv", "the grades", lambda marks: "", "two outputs have the file 'grades.csv'"),
        ("", "the grades", lambda marks: "", "an output has the file ''"),
        ("/grades.csv", "the grades", lambda marks: "", "expected a place in the folder of the grades"),
        ("a/../../grades.csv", "the grades", lambda marks: "", "expected a place in the folder of the grades"),
        ("new.csv", "", lambda marks: "", "it is not said what it is"),
        ("new.csv", None, lambda marks: "", "it is not said what it is"),
        ("new.csv", "the grades", lambda course: "", "asks for 'course': expected some of title, students, marks"),
        ("new.csv", "the grades", lambda student: "", "asks for 'student': expected some of title, students, marks"),
        ("{student}.csv", "the grade", lambda marks: "", "asks for 'marks': expected some of title, student, mark"),
    ],
)
def test_what_an_output_lacks_is_said(file, what, makes, says):
    with pytest.raises(GradingError, match=re.escape(says)):
        output(file, what)(makes)


def test_the_output_that_contributors_are_shown_is_one(monkeypatch):
    monkeypatch.setattr(reports.outputs, "_REGISTERED", dict(reports.outputs._REGISTERED))
    contributing.run("Add an output for an LMS")
    (one,) = [one for one in registered() if one.file == "names.txt"]
    assert dict(one.files(TITLE, CLASS, RESULTS)) == {"names.txt": "\n".join(student.name for student in CLASS)}


def test_what_is_no_text_is_refused():
    with pytest.raises(GradingError, match=r"the output 'new\.csv' returns None: expected a text"):
        list(reports.Output("new.csv", "the grades", lambda marks: None).files(TITLE, CLASS, RESULTS))


def test_a_module_of_the_folder_that_registers_nothing_is_named(tmp_path, monkeypatch):
    (tmp_path / "lectern_of_nobody.py").write_text("def grades(marks):\n    return ''\n")
    monkeypatch.setattr(reports.outputs, "__path__", [*reports.outputs.__path__, str(tmp_path)])
    with pytest.raises(GradingError, match="lectern_of_nobody registers no output: expected a function with @output"):
        registered()


def luminance(colour):
    parts = [int(colour[k : k + 2], 16) / 255 for k in (1, 3, 5)]
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


@pytest.mark.parametrize(
    ("colours", "ground"),
    [({k: c for k, (_, c) in MARKS.items()}, "#f4f4f4"), (page.ON_DARK, "#222222")],
    ids=["light", "dark"],
)
def test_the_words_of_the_statuses_can_be_read(colours, ground):
    assert colours.keys() == MARKS.keys()
    for colour in colours.values():
        low, high = sorted([luminance(colour), luminance(ground)])
        assert (high + 0.05) / (low + 0.05) >= 4.5


# Formulas.


@pytest.mark.parametrize(
    ("sentence", "mathml"),
    [
        (r"here $T_c = \tau$", "<msub><mi>T</mi><mi>c</mi></msub>"),
        (r"$\frac{K}{T s + 1}$", "<mfrac>"),
        ("from $-1$ on", "−"),
    ],
)
def test_formulas_are_mathml(sentence, mathml):
    text = page.sentence(sentence)
    assert mathml in text
    assert "$" not in text


@pytest.mark.parametrize(
    "latex", [r"\text{<script>x</script>}", r"\text{<b onclick='x'>y</b>}", r"\left(", "x^", "{" * 2000, r"\frac{}"]
)
def test_what_is_no_formula_is_shown_as_it_is(latex):
    tags = Checker(page.sentence(f"see ${latex}$")).tags
    assert set(tags) <= {"code", "math", "mrow", "mi", "mo", "mfrac"}


@pytest.mark.parametrize("latex", [r"\href{javascript:alert(1)}{x}", r"\style{background:url(//evil)}{x}"])
def test_formulas_bring_no_links_and_no_styles(latex):
    assert {name for name, _ in Checker(page.sentence(f"${latex}$")).attributes} <= {"display"}


def test_every_formula_in_the_banks_sentences_is_mathml():
    sentences = {
        s for chapter in ("4", "5", "10", "18") for one in exercises(chapter).values() for s, _ in one.mistakes
    }
    formulas = {
        f"${f}$" for s in sentences for f in re.findall(r"\$([^$]+)\$", s.replace("{{", "{").replace("}}", "}"))
    }
    assert len(formulas) > 20
    for formula in formulas:
        assert page.sentence(formula).startswith("<math"), formula
        assert "\\" not in page.sentence(formula), formula


def test_a_single_dollar_sign_begins_no_formula():
    assert page.sentence("5 $ each") == "5 $ each"


# Markdown.


@pytest.mark.parametrize(
    "text",
    [
        "<b>",
        "*a*",
        "_a_",
        "`a`",
        "[a](b)",
        "# a",
        "- a",
        "1. a",
        "12) a",
        "a | b",
        "$x$",
        "&amp;",
        "~~a~~",
        "\\",
        "a\n\n# b",
    ],
)
def test_markdown_shows_a_text_as_it_is(text):
    rendered = markdown_to_text(in_markdown(text))
    assert rendered == " ".join(text.split())


def markdown_to_text(line):
    """A line of Markdown as it is shown, where a sign without a backslash must be one that does nothing."""
    bare = re.sub(r"\\(.)", "", line)
    assert not re.search(r"[*_`<>\[\]#|$&~]|^\d+[.)]|^[-+]", bare)
    return re.sub(r"\\(.)", r"\1", line)


def test_formulas_stay_formulas_in_markdown():
    assert sentence_in_markdown("*so* $K_c < 4$") == r"\*so\* $K_c \lt 4$"


def test_the_pages_in_markdown():
    text = feedback_markdown(TITLE, BOB, NAMED)
    assert text.startswith(f"# {TITLE}\n\nBob Bode (s1002)\n\n**3.67 of 5 points**\n")
    assert r"- ≈ `K` **mistake**: That is the gain itself, $\frac{K}{1}$, not twice of it." in text
    hostile = feedback_markdown(TITLE, Student("s1003", HOSTILE), STOPPED)
    outside_code = re.sub(r"(?<!\\)(`+)(?!`).*?(?<!`)\1(?!`)", "", hostile)
    assert not re.search(r"(?<!\\)<", outside_code)
    hostile.encode()


def test_the_tables_of_the_summary_in_markdown_have_equal_rows():
    widths, text = set(), summary_markdown(TITLE, CLASS, RESULTS)
    for block in re.findall(r"(?:^\|.*\n)+", text, re.MULTILINE):
        counts = {len(re.findall(r"(?<!\\)\|", line)) for line in block.splitlines()}
        assert len(counts) == 1
        widths |= counts
    assert widths == {4, 5, 6, 9}


# Gradescope.


def test_gradescope_reads_the_result():
    data = json.loads(results_json(NAMED))
    assert data["score"] == 3.67
    assert data["output_format"] == data["test_output_format"] == data["test_name_format"] == "text"
    assert data["visibility"] == "visible"
    first, second = data["tests"]
    assert (first["number"], first["name"]) == ("1", "Gain below K_u")
    assert (first["score"], first["max_score"], first["status"]) == (2.67, 4, "failed")
    assert (second["score"], second["max_score"], second["status"]) == (1, 1, "passed")
    assert first["output"].splitlines()[0].startswith("≈ K: mistake, That is the gain itself, (K)/(1), not twice")


def test_gradescope_shows_keys_only_when_grades_are_published():
    data = json.loads(results_json(NAMED, reveal=True))
    assert {data["visibility"], *(test["visibility"] for test in data["tests"])} == {"after_published"}


def test_hostile_texts_leave_gradescopes_format_whole():
    text = results_json(STOPPED)
    text.encode()
    assert "stopped in cell 4" in json.loads(text)["output"]


# The summary.


def test_the_summary_counts():
    for text in (
        summary_html(TITLE, CLASS, RESULTS),
        summary_markdown(TITLE, CLASS, RESULTS),
    ):
        assert "3 submissions, 1 missing." in text
        assert "Mean 2.89, median 3.67 of 5 points" in text
        assert "wrote to the answers" in text
        assert "stopped in cell 4" in text


def test_the_summary_of_nothing():
    for students, results in [((), []), (CLASS, []), (CLASS, [MISSING])]:
        Checker(summary_html(TITLE, students, results))
        assert "0 submissions" in summary_markdown(TITLE, students, results)


def test_complaints_are_in_the_summary():
    complaint = "x_<y>.ipynb belongs to no student"
    assert "x_&lt;y&gt;.ipynb belongs to no student" in summary_html(TITLE, CLASS, [], [complaint])
    assert r"- x\_\<y\>.ipynb belongs to no student" in summary_markdown(TITLE, CLASS, [], [complaint])


def test_what_was_not_judged_is_in_the_summary():
    unreadable = {"2": {"action": "either"}, "1": {"H": "K | $x$"}}
    results = [result_of(BOB, unreadable), RIGHT_ALL]
    assert [one[:4] for one in Findings(CLASS, results).unjudged] == [
        ("1", "H", "s1002", "K | $x$"),
        ("2", "action", "s1002", "either"),
    ]
    assert "## Not judged" not in summary_markdown(TITLE, CLASS, [RIGHT_ALL])
    for text in (summary_html(TITLE, CLASS, results), summary_markdown(TITLE, CLASS, results)):
        assert "You may see what was meant." in text
        assert "is none of the words: expected reverse or direct" in text
    many = [result_of(Student(f"s{k}", "A"), unreadable) for k in range(51)]
    assert "There are 2 more, on the pages of the students." in summary_markdown(TITLE, CLASS, many)


@pytest.mark.parametrize(
    ("settings", "says"),
    [
        ({"Kp": 2, "Ti": "inf", "Td": 0, "Tf": 0, "form": "parallel"}, "Kp = 2"),
        (
            {"Kp": "1/3", "Ti": "2 min", "Td": 1.5, "form": "serial"},
            "Kp = 0.33333333, Ti = 2 min, Td = 1.5, serial form",
        ),
        ({"Kp": "1/0", "Ti": [HOSTILE[:5]], "form": {}}, "Kp = 1/0, Ti = [</cod]"),
        ({"Kp": 2, "form": "parallel", "more": 1}, "{Kp: 2, form: parallel, more: 1}"),
        ({"Kp": "9" * 400 + "/7", "form": ""}, "Kp = 9999"),
    ],
)
def test_a_controller_in_words(settings, says):
    assert answer_in_words(settings).startswith(says)


def test_the_hardest_exercise_comes_first():
    found = Findings(CLASS, RESULTS)
    assert [one.number for one in found.exercises] == ["1", "2"]
    assert found.exercises[0].fraction == pytest.approx((4 + 8 / 3 + 0) / 12)
    assert {asked.name: asked.fraction for asked in found.exercises[0].asked} == {
        "K": pytest.approx(1 / 3),
        "T": pytest.approx(2 / 3),
        "H": pytest.approx(2 / 3),
    }


def test_mistakes_are_counted():
    third = result_of(EVE, own_mistake)
    (most, *_) = Findings(CLASS, [RIGHT_ALL, NAMED, third]).mistakes
    assert most[:2] == ("1", "K")
    assert most[2].startswith("That is the gain itself")
    assert most[3] == 2


def test_a_mistake_is_one_whatever_the_numbers_in_its_sentence():
    hours = [result_of(one, {"1": {"T": gain.question(one.id).given("T") / 3600.0}}) for one in CLASS]
    assert Findings(CLASS, hours).mistakes == [("1", "T", "The …\N{NO-BREAK SPACE}s are not in hours.", 4)]
    assert Findings(CLASS, hours[:1]).mistakes[0][2].startswith("The 40\N{NO-BREAK SPACE}s are")


def summing(points, earned):
    """A marked result of so many points of those possible."""
    exercise_ = JudgedExercise("1", "Gain", points, "", (), (JudgedAnswer("K", WRONG, "", 1, "2"),))
    return Marked(replace(RIGHT_ALL.result, exercises=(exercise_,)), (MarkedExercise(exercise_, earned),))


@pytest.mark.parametrize("points", [0.5, 1, 3, 5, 10, 24, 37, 100, 250])
def test_every_sum_has_its_place_in_the_distribution(points):
    earned = [points * k / 30 for k in range(31)]
    steps = Findings(CLASS, [summing(points, sum_) for sum_ in earned]).steps
    assert sum(count for _, _, count in steps) == 31
    assert steps[0][0] == 0
    assert steps[-1][1] == points
    assert 1 <= len(steps) <= 12


def test_the_distribution_has_the_colours_of_its_page():
    drawing = re.search(r"<svg.*</svg>", summary_html(TITLE, CLASS, RESULTS), re.DOTALL)[0]
    colours = set(re.findall(r"(?:fill|stroke): (#\w+|\w+)", drawing))
    assert colours == {"#0072b2", "#888888", "currentColor", "none"}
    assert 'aria-label="Distribution of the points: 0 to 0.5: 1 submission;' in drawing


def test_a_sum_of_thirds_is_not_below_its_step():
    steps = Findings(CLASS, [summing(5, 1 / 3 + 1 / 3 + 1 / 3 - 1e-16)]).steps
    assert [count for _, _, count in steps if count] == [1]
    assert next(lower for lower, _, count in steps if count) == 1


# Equal answers.


def given(student, K, H="", way=""):
    return result_of(student, {"1": {"K": K, "H": H or None}, "2": {"action": way or None}})


def equal(marks):
    return equal_answers([mark.result for mark in marks])


def test_an_answer_that_is_right_for_another_student_is_reported():
    copied = 2 * float(gain.question(ADA.id).values["K"])
    (found,) = equal([given(ADA, copied), given(BOB, f"{copied} K/%"), given(BOB, copied), given(ZOE, 1.0)])
    assert (found.number, found.name, found.right, found.others) == ("1", "K", (ADA.id,), (BOB.id,))


def test_an_equal_wrong_expression_is_reported_in_any_spacing():
    (found,) = equal([given(ADA, None, "3.217/(s + 1)"), given(BOB, None, "3.217 / (s+1)")])
    assert (found.name, found.right, found.others) == ("H", (), (ADA.id, BOB.id))


def test_equal_answers_that_mean_little_are_not_reported():
    assert equal([given(ADA, 100), given(BOB, 100)]) == []  # few digits
    assert equal([given(ADA, None, way="direct"), given(BOB, None, way="direct")]) == []  # words
    assert equal([given(ADA, 123.4), given(ADA, 123.4)]) == []  # the same numbers
    assert equal([given(ADA, None), given(BOB, None)]) == []  # nothing


def test_reactions_to_equal_answers_are_in_the_summary():
    results = [given(ADA, 123.4), given(BOB, "123.4")]
    assert "123.4" in summary_html(TITLE, CLASS, results)
    assert "| 1 | `K` | `123.4` |  | Ada Lovelace (s1001), Bob Bode (s1002) |" in summary_markdown(
        TITLE, CLASS, results
    )


@pytest.mark.parametrize(
    ("answer", "digits"),
    [
        (0, 1),
        (2.0, 1),
        (0.00250, 2),
        (1e-7, 1),
        (2.345e10, 4),
        (1200, 2),
        (True, 0),
        (None, 0),
        ("S12, S13", 0),
        ("K/(T*s + 1)", 1),
        ("2.50 min", 2),
        (".125", 3),
        ([1, 2.345], 4),
        ({"unreadable": "it has no form"}, 0),
    ],
)
def test_significant_digits(answer, digits):
    assert significant_digits(answer) == digits


# All of it.


def bank_class(count):
    """A class in which everybody solves four exercises of the bank more or less well."""
    course = [one for chapter in ("5", "10") for one in list(exercises(chapter).values())[:2]]
    luck = random.Random(8)
    students = [Student(f"s{k:04}", f"Student {k}") for k in range(count)]
    results = []
    for student in students:

        def some(question):
            everything = {
                name: str(kind.expr) if hasattr(kind, "expr") else kind.key
                for name, kind in question.key.items()
                if isinstance(kind.key, (int, float, str)) or hasattr(kind, "expr")
            }
            return {
                name: luck.choice([value, value, value, -value if isinstance(value, float) else value, None])
                for name, value in everything.items()
            }

        results.append(result_of(student, some, course))
    return students, results


def test_the_outputs_of_the_bank_do_not_depend_on_order_or_place(tmp_path):
    students, results = bank_class(12)
    reports.write_all(tmp_path / "a", TITLE, students, results)
    reports.write_all(tmp_path / "b", TITLE, students, results[::-1])
    one, other = (
        {
            path.relative_to(tmp_path / name): path.read_bytes()
            for path in (tmp_path / name).rglob("*")
            if path.is_file()
        }
        for name in "ab"
    )
    assert len(one) == sum(len(students) if one.is_for_each_student else 1 for one in registered())
    assert one == other
    assert all(b"\r" not in content for content in one.values())


def test_results_of_others_are_left_out_and_nothing_is_deleted(tmp_path):
    kept = tmp_path / "feedback" / "s0" / "feedback.md"
    kept.parent.mkdir(parents=True)
    kept.write_text("mine")
    reports.write_all(tmp_path, TITLE, [ADA], [*RESULTS, changed(RIGHT_ALL, student="../../x")])
    assert sorted(path.name for path in (tmp_path / "feedback").iterdir()) == ["s0", "s1001"]
    assert kept.read_text() == "mine"


def test_a_large_class_takes_a_moment(tmp_path):
    students = [Student(f"s{k:04}", f"Student {k}") for k in range(200)]
    results = [changed(RESULTS[k % 3], student=student.id) for k, student in enumerate(students)]
    start = time.process_time()
    reports.write_all(tmp_path, TITLE, students, results)
    assert time.process_time() - start < 2


def test_the_line_about_the_jail_is_a_sentence():
    assert NO_JAIL.endswith(".")
