"""The pages of students and the summary: what they say."""

import functools
import re
from dataclasses import replace

import pytest

from exercisebook.judging import MISTAKE, OPEN, RIGHT, UNJUDGED, WRONG
from exercisegrader.lateness import Lateness
from exercisegrader.lms.gradescope import results_json
from exercisegrader.marking import Marked, Notice
from exercisegrader.overrides import Mark
from exercisegrader.reports import write_all
from exercisegrader.reports.concerns import concerns
from exercisegrader.reports.equal_answers import equal_answers
from exercisegrader.reports.findings import Findings
from exercisegrader.reports.outputs import registered
from exercisegrader.reports.outputs.feedback import feedback
from exercisegrader.reports.outputs.summary import summary
from exercisegrader.results import CellError, Look
from small_class import (
    ADA,
    BOB,
    CLASS,
    EVE,
    MISSING,
    NAMED,
    RESULTS,
    RIGHT_ALL,
    STOPPED,
    TITLE,
    ZOE,
    by_hand,
    changed,
    gain,
    grades,
    own_mistake,
    result_of,
)
from whole_pages import Checker


def read(page):
    """What a reader of the page sees, its cells and lines apart."""
    return " ".join(Checker(re.sub("<(?=br|/t[dh]>|/li>|/?div)", " <", page)).text.split())


def rows(page):
    """The rows of the tables of a page, as a reader sees them."""
    return [read(row) for row in re.findall("<tr>.*?</tr>", page, re.DOTALL)]


def waiting(mark, number, *, earned=None, **more):
    """The same with an exercise that has other points, none where it waits."""
    exercises = tuple(
        replace(one, earned=earned, **more) if one.judged.number == number else one for one in mark.exercises
    )
    return replace(mark, exercises=exercises)


def with_answer(mark, number, name, **fields):
    """The same with other fields of one answer."""
    exercises = tuple(
        replace(one, answers=tuple(replace(a, **fields) if a.name == name else a for a in one.answers))
        if one.number == number
        else one
        for one in mark.result.exercises
    )
    return changed(mark, exercises=exercises)


ADAS = 2 * float(gain.question(ADA.id).values["K"])
NOT_RUN = result_of(BOB, {}, status="not run", says="two notebooks: a.ipynb and <b>.ipynb; keep one")


# The page of a student.

READ_AS = {
    "T": {"answer": "2 min", "says": "right, converted from min"},
    "K": {"answer": 2, "status": "wrong", "says": "not right; asked: the gain · read as 2"},
    "H": {"answer": "2/s", "status": "mistake", "says": "no $T$ · read as 2.0/s"},
}
FIGURE, TEXT = ("3", "sketch"), ("3", "why")
HALF_MARKED = {FIGURE: Mark(2, "no *axes*"), TEXT: Mark(None, "and why?")}
LATE = replace(NAMED, late="2 days late: 20 % off", deduction=0.7333, comments=("See me.",))
COMMENTED = waiting(NAMED, "1", comments=("the plot has *no* axes",), history=("3 points before",))
OTHER_NAME = (Look("owner", "it names another student: s1002"),)
#: What a page says, and what it does not.
PAGES = {
    "what became of each answer": (
        NAMED,
        [f"{TITLE} Bob Bode (s1002) 3.67 of 5 points", "(2.67 of 4 points)", "≈ K mistake: That is the gain itself"],
        ["somebody else"],
    ),
    "how an answer was read where that is not what was typed": (
        functools.reduce(lambda mark, name: with_answer(mark, "1", name, **READ_AS[name]), READ_AS, RIGHT_ALL),
        ["2 min, converted from min", "2/s, read as 2.0/s", "not right; asked: the gain Your answer: 2 ✓"],
        [],
    ),
    # what makes the instructor look is for the instructor
    "what stopped and failed": (STOPPED, ["stopped in cell 4: it took longer than 60 s", "cell 3: Name"], ["stream"]),
    "how the file was chosen": (changed(NAMED, chosen="counts as the latest of a<b>.ipynb"), ["of a<b>.ipynb."], []),
    "whose it is": (changed(NAMED, owner="s1001"), ["This is somebody else's notebook: it was made for"], []),
    "that it is one's own": (changed(NAMED, owner="s1002"), [], ["somebody else"]),
    "what the summary says of another name": (
        changed(RIGHT_ALL, owner="s1001", looks=OTHER_NAME),
        ["Of this notebook: it names another student: s1002. It was graded with the numbers of"],
        [],
    ),
    "what waits, and comments": (
        COMMENTED,
        ["3.67 of 5 points so far", "(waits for a mark)", "From your instructor:", "has *no* axes", "3 points before"],
        [],
    ),
    "the points of an exercise by hand": (waiting(NAMED, "1", earned=3.5), ["(3.5 of 4 points)"], []),
    "what a person marks": (
        by_hand(),
        ["oscillates !", "to be marked: a person", "9 words, where at most 5 are asked for", "5 of 9 points so far"],
        ["begins after"],
    ),
    "what is marked in part": (
        by_hand(HALF_MARKED),
        ["sketch marked by hand", "why to be marked", 'sketch: 2 of 3 points by hand: "no *axes*"', "why: and why?"],
        [],
    ),
    "what is marked": (by_hand(HALF_MARKED | {TEXT: Mark(1)}), ["8 of 9 points"], ["so far"]),
    "what being late cost": (LATE, ["2.93 of 5 points", "2 days late: 20 % off (0.73 points).", "See me."], []),
    "no zero to who is missing": (MISSING, ["no points yet, of 5"], ["Exercise", "Show this page"]),
    "no zero where nothing was run": (NOT_RUN, ["no points yet", "Show this page", NOT_RUN.result.says], ["Exercise"]),
    "what was marked all the same": (Marked.of(NOT_RUN.result, {("2", ""): Mark(1, "on paper")}), ["Exercise 2"], []),
}  # fmt: skip


@pytest.mark.parametrize("what", PAGES)
def test_the_page_says(what):
    mark, said, unsaid = PAGES[what]
    text = read(page_of(mark))
    assert [one for one in said if one not in text] == []
    assert [one for one in unsaid if one in text] == []


def test_the_page_names_the_question_the_numbers_and_the_file():
    values, given = gain.question(BOB.id).values, (("K", "2 K/%"), ("T", "30 s"))
    exercises = tuple(replace(one, given=given) for one in NAMED.result.exercises[:1])
    text = read(page_of(changed(NAMED, exercises=exercises)))
    assert "The question, with your numbers" in text
    assert re.search(rf"A lag of {values['T']}.s with the gain", text)
    assert "Your numbers: " in text
    assert f"Your answer: {float(values['K']):.12g}" in text
    assert text.count("Gain below") == 1  # the heading of the statement is that of the exercise
    assert "s1002/heater.ipynb" in text


def test_what_a_person_marks_is_shown_whole():
    text = page_of(by_hand())
    assert text.count("<img") == 1
    assert 'alt="the figure that was handed in for sketch"' in text
    assert "<bdi>the dead time is long</bdi><br><bdi>&lt;b&gt;so&lt;/b&gt; it oscillates" in text
    assert "Key: it begins after the dead time" in read(page_of(by_hand(), reveal=True))


def page_of(mark, **more):
    """The page of the student whose mark this is."""
    return feedback(grades([mark], **more), next(one for one in CLASS if one.id == mark.result.student), mark)


# What to look at.


def told(marks, complaints=()):
    """The concerns by their titles: pairs of the students and the points of each case."""
    found = concerns(marks, complaints)
    return {kind: [(*case.students, round(case.points, 3)) for case in cases] for kind, cases in found.items()}


FAILED = (CellError(9, "NameError: x"),)
HALF = result_of(BOB, {"1": {"K": 1.0}})
UNREAD = result_of(BOB, {"1": {"H": "K | x", "K": 1.0}}, errors=FAILED)
LOOKS = (Look("owner", "it names another student: s1001"), Look("odd lines", "it told 3"))
OF_ANOTHER = changed(NAMED, looks=LOOKS[:1])
EITHER = [changed(result_of(one, {"2": {"action": "either"}}), student=one.id) for one in CLASS[:2]]
NOBODYS = "x_<y>.ipynb: is named after no student of the roster"
BESIDE = f"notes.pdf: is not a notebook (.ipynb), beside {RIGHT_ALL.result.file}"
OPEN_CELLS, UNJUDGEABLE = "Cells that failed, with answers left open", "Answers that could not be judged"
NOT_COUNTED, ODD = (
    "Answers that do not count where they stand",
    "Notebooks that sent the grader something else than answers",
)
WAITS, DECIDE = "Answers that wait for a mark", "Marks and times that need a decision"
#: Marks and complaints, with the cases by their titles.
CONCERNS = {
    "all is well": ([RIGHT_ALL, NAMED, MISSING], [], {}),
    "the costliest case of a kind first": (
        [*EITHER, result_of(EVE, {"1": {"H": "K | $x$"}})],
        [],
        {UNJUDGEABLE: [("s1003", 1.333), ("s1001", 1), ("s1002", 1)]},
    ),
    "what hangs on an answer by its weight": (
        [with_answer(result_of(BOB, {"1": {"H": "K | x"}}), "1", "H", weight=2)], [], {UNJUDGEABLE: [("s1002", 2)]},
    ),
    "of somebody else, and odd lines": (
        [changed(NAMED, looks=LOOKS)],
        [],
        {"Notebooks that say they are somebody else's": [("s1002", 5)], ODD: [("s1002", 3.667)]},
    ),
    "chosen of several": ([changed(NAMED, chosen="it"), MISSING], ["s1002/heater.ipynb: it"], {}),
    "failed after the answers were in": ([changed(RIGHT_ALL, errors=FAILED)], [], {}),
    "said of the choice alone": ([changed(HALF, says="of two notebooks the latest")], [], {}),
    "failed before": ([changed(HALF, errors=FAILED)], [], {OPEN_CELLS: [("s1002", 3.667)]}),
    "waits for a mark": ([by_hand({TEXT: Mark(1)})], [], {WAITS: [("s1001", 3)]}),
    "wait for marks": (
        [by_hand(), changed(by_hand(), student="s1002")],
        [],
        {WAITS: [("s1001", "s1002", 3), ("s1001", "s1002", 1)]},
    ),
    "needs a decision": (
        [Marked.of(NAMED.result, looks=(Notice(2, "changed"),)), Marked.of(MISSING.result, looks=(Notice(5, "late"),))],
        [],
        {DECIDE: [("s1004", 5), ("s1002", 2)]},
    ),
    "unread": ([UNREAD], [], {UNJUDGEABLE: [("s1002", 1.333)], OPEN_CELLS: [("s1002", 2.333)]}),
    "unread and decided": ([Marked.of(UNREAD.result, {("1", "H"): Mark(1)})], [], {OPEN_CELLS: [("s1002", 2.333)]}),
    "decided exercise by exercise": (
        [Marked.of(UNREAD.result, {("1", ""): Mark(1), ("2", "action"): Mark(0)})], [], {},
    ),
    "decided as a whole": ([Marked.of(UNREAD.result, {("", ""): Mark(2)})], [], {}),
    "not run and decided": ([Marked.of(NOT_RUN.result, {("", ""): Mark(2)})], [], {}),
    "of another and decided": ([Marked.of(OF_ANOTHER.result, {("", ""): Mark(2)})], [], {}),
    "a file of nobody": ([RIGHT_ALL], [NOBODYS], {}),
    "a file of nobody where somebody is missing": (
        [RIGHT_ALL, MISSING], [NOBODYS], {"Files that were not graded": [(5,)]},
    ),
    "a file beside another": ([RIGHT_ALL, MISSING], [BESIDE], {}),
    "not run, once": (
        [NOT_RUN, MISSING],
        [f"{NOT_RUN.result.file}: {NOT_RUN.result.says}"],
        {"Notebooks that could not be run": [("s1002", 5)]},
    ),
}  # fmt: skip


@pytest.mark.parametrize("what", CONCERNS)
def test_what_is_to_look_at(what):
    marks, complaints, cases = CONCERNS[what]
    assert told(marks, complaints) == cases


def test_what_may_cost_most_comes_first():
    waits = replace(with_answer(RIGHT_ALL, "2", "action", weight=1), exercises=RIGHT_ALL.exercises)
    flagged = with_answer(NAMED, "1", "T", look="it has no value at $t = 0$")
    cases = told([waits, flagged, STOPPED, NOT_RUN])
    unjudged = cases.pop(UNJUDGEABLE)
    assert [*cases.items()] == [
        ("Notebooks that could not be run", [("s1002", 5)]),
        # H and the action are open
        ("Notebooks that were stopped before all answers were in", [("s1003", 2.333)]),
        ("Answers that were judged and are unusual", [("s1002", 1.333)]),
        (ODD, [("s1003", 0)]),  # and they brought nothing
    ]
    assert unjudged[0][0] == "s1003"


@pytest.mark.parametrize("kind", ["unasked", "no code"])
def test_answers_that_do_not_count_where_they_stand_cost_what_is_open(kind):
    mark = changed(HALF, looks=(Look(kind, "in exercise 1 it answers 'k'", "1"),))
    assert told([mark]) == {NOT_COUNTED: [("s1002", 2.667)]}
    anywhere = changed(mark, looks=(Look(kind, "it answers '11'"),))
    assert told([anywhere]) == {NOT_COUNTED: [("s1002", 3.667)]}
    decided = Marked.of(mark.result, {("1", ""): Mark(4)})
    assert told([decided]) == {}
    for text in (read(page_of(mark)), results_json(grades([mark]), BOB, mark)):
        assert "in exercise 1 it answers 'k'" in text


def test_the_summary_says_what_is_to_look_at():
    assert "Nothing." in read(summary(grades([changed(RIGHT_ALL, errors=FAILED)])))
    assert "cell 9: NameError: x" in read(summary(grades([changed(HALF, errors=FAILED)])))
    waits = read(summary(grades([by_hand(), changed(by_hand(), student="s1002")])))
    assert re.search("3 · .?sketch.?; to look for: it begins after the dead time", waits)
    look = "exercise 1, K: marked by hand with 1, and the answer has changed since"
    assert look in read(summary(grades([Marked.of(NAMED.result, looks=(Notice(2, look),))])))
    for marks in ([], [MISSING]):
        assert NOBODYS in read(summary(grades(marks, [NOBODYS])))
    complaint = f"{NOT_RUN.result.file}: {NOT_RUN.result.says}"
    assert read(summary(grades([NOT_RUN, MISSING], [complaint]))).count("keep one") == 1


def test_equal_answers_are_told():
    marks = [given(ADA, ADAS), given(BOB, ADAS)]
    assert told(marks) == {"Equal answers where the numbers differ": [("s1001", "s1002", 1.333)]}
    (row,) = [row for row in rows(summary(grades(marks))) if f": {ADAS}" in row]
    assert row.endswith(f" 1.33 1 · K: {ADAS} right for s1001, not for s1002")


# The summary.


def test_the_summary_counts():
    text = read(summary(grades()))
    assert "3 submissions, 1 missing." in text
    assert "Mean 2.89, median 3.67 of 5 points, over 3 grades." in text
    assert "wrote to the answers" in text
    assert "stopped in cell 4" in text


def test_means_are_over_those_who_have_a_grade():
    marks = [RIGHT_ALL, NOT_RUN, waiting(changed(NAMED, student="s1003"), "1")]
    text = read(summary(grades(marks)))
    assert "3 submissions, 1 not graded yet, 1 not run, 1 waiting for a mark." in text
    assert "Mean 5, median 5 of 5 points, over 1 grade." in text
    means = {one.number: one.mean for one in Findings(grades(marks)).exercises}
    assert means == {"1": None, "2": 1}
    text = read(summary(grades([waiting(RIGHT_ALL, "1")])))
    assert "Mean" not in text


def test_the_summary_of_nothing():
    for students, marks in [((), []), (CLASS, []), (CLASS, [MISSING])]:
        assert "0 submissions" in read(summary(grades(marks, students=students)))


def test_pages_lead_to_each_other_and_to_the_notebooks_that_were_kept():
    text = summary(grades([STOPPED, MISSING], notebooks=["s1003"]))
    assert '<a href="feedback/s1003/feedback.html"><bdi>=HYPERLINK(1)</bdi>' in text
    assert '<a href="notebooks/s1003.html">notebook</a>' in text
    assert 'href="feedback/s1004/feedback.html"' in text
    assert "feedback/s1002" not in text
    assert "notebooks/s1003" not in summary(grades())
    link = 'href="../../notebooks/s1002.html"'
    assert link in page_of(NAMED, notebooks=["s1002"])
    assert link not in page_of(NAMED, notebooks=["s1001"])


def test_late_hand_ins_are_in_the_summary():
    late = Marked.of(NAMED.result, lateness=Lateness(0.2, "2 days late: 20 % of the points are deducted"))
    found = rows(summary(grades([late])))
    assert "Bob Bode (s1002) 0.73 2 days late: 20 % of the points are deducted" in found


def test_answers_to_be_marked_have_a_column_where_there_are_any():
    found = rows(summary(grades([by_hand()])))
    assert "exercise quantity in percent ✓ right ≈ mistake ✗ wrong ? not judged ✎ to be marked … open" in found
    assert "3 sketch 0 0 0 0 1 0" in found
    assert "to be marked" not in read(summary(grades([RIGHT_ALL])))


def test_each_file_that_was_written_is_told_and_no_other(tmp_path):
    write_all(tmp_path, TITLE, CLASS, RESULTS, notes=["other numbers than at the release"])
    text = (tmp_path / "summary.html").read_text(encoding="utf-8")
    of_all = [one for one in registered() if "{" not in one.file]
    told = {one.file for one in of_all if f"<code>{one.file}</code>" in text and one.what in read(text)}
    assert told == {path.name for path in tmp_path.iterdir() if path.is_file()} - {"summary.html"}
    assert "grades.csv" in told
    assert len(told) < len(of_all) - 2
    assert "other numbers than at the release" in read(text)
    assert "How the class was graded" not in read(summary(grades()))


def test_the_tables_of_the_summary_have_equal_rows():
    widths = []
    for table in re.findall("<table>.*?</table>", summary(grades()), re.DOTALL):
        widths.append({len(re.findall("</t[dh]>", row)) for row in re.findall("<tr>.*?</tr>", table, re.DOTALL)})
    assert [*map(len, widths)] == [1] * len(widths)
    assert set.union(*widths) == {2, 3, 4, 8}


def test_the_words_of_a_verdict_are_those_of_its_status():
    statuses = {answer.status for mark in RESULTS for one in mark.result.exercises for answer in one.answers}
    text = read(summary(grades()))
    assert statuses == {RIGHT, MISTAKE, WRONG, UNJUDGED, OPEN}
    assert all(status in text for status in statuses)


def test_the_hardest_exercise_comes_first_and_one_that_waits_last():
    found = Findings(grades())
    assert [one.number for one in found.exercises] == ["1", "2"]
    waits = Findings(grades([by_hand(), changed(NAMED, student="s1003")]))
    assert waits.exercises[-1].number == "3"
    assert found.exercises[0].fraction == pytest.approx((4 + 8 / 3 + 0) / 12)
    assert {asked.name: asked.fraction for asked in found.exercises[0].asked} == {
        "K": pytest.approx(1 / 3),
        "T": pytest.approx(2 / 3),
        "H": pytest.approx(2 / 3),
    }


def test_mistakes_are_counted():
    third = result_of(EVE, own_mistake)
    (most, *_) = Findings(grades([RIGHT_ALL, NAMED, third])).mistakes
    assert most[:2] == ("1", "K")
    assert most[2].startswith("That is the gain itself")
    assert most[3] == 2


def test_a_mistake_is_one_whatever_the_numbers_in_its_sentence():
    hours = [result_of(one, {"1": {"T": gain.question(one.id).given("T") / 3600.0}}) for one in CLASS]
    assert Findings(grades(hours)).mistakes == [("1", "T", "The …\N{NO-BREAK SPACE}s are not in hours.", 4)]
    assert Findings(grades(hours[:1])).mistakes[0][2] == "The 40\N{NO-BREAK SPACE}s are not in hours."


def test_where_the_middle_half_of_a_class_is():
    many = [changed(NAMED if k % 2 else RIGHT_ALL, student=f"s{k}") for k in range(8)]
    assert "over 8 grades; half of them are from 3.67 to 5." in read(summary(grades(many, students=[])))
    assert "half of them" not in read(summary(grades(many[:7], students=[])))


# Equal answers.


def given(student, K, H="", way=""):
    return result_of(student, {"1": {"K": K, "H": H or None}, "2": {"action": way or None}})


def equal(marks):
    return equal_answers([mark.result for mark in marks])


def test_an_answer_that_is_right_for_another_student_is_reported():
    (found,) = equal([given(ADA, ADAS), given(BOB, f"{ADAS} K/%"), given(BOB, ADAS), given(ZOE, 1.0)])
    assert (found.number, found.name, found.right, found.others) == ("1", "K", (ADA.id,), (BOB.id,))


def test_an_expression_is_reported_in_any_spacing():
    (found,) = equal([given(ADA, None, "4.4/(40*s + 1)"), given(BOB, None, "4.4 / (40*s+1)")])
    assert (found.name, found.right, found.others) == ("H", (ADA.id,), (BOB.id,))


def test_equal_answers_that_mean_little_are_not_reported():
    assert equal([given(ADA, 123.4), given(BOB, 123.4)]) == []  # wrong for both
    assert equal([given(EVE, None, way="reverse"), given(BOB, None, way="reverse")]) == []  # words
    assert equal([given(ADA, ADAS), given(ADA, ADAS)]) == []  # the same numbers
    assert equal([given(ADA, None), given(BOB, None)]) == []  # nothing
