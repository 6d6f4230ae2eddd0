"""Exercises as files of other systems: what is escaped, cut, weighed and left out."""

from exercisebook.authoring import Credit, answers, between, choice, exercise, expression, figure, number, word
from exercisebook.credit import NOTHING
from exercisebook.export import moodle
from exercisebook.export.cells import cells
from moodle_reader import read


def spring(**more):
    """An exercise with signs that mean something to Moodle in all its texts."""

    @exercise("1.1", title="Force / energy", weights={"E": 1.5}, **more)
    def asked(k=between(100, 900, "N/m", reference=200), x=choice(2, 3, unit="m", reference=2)):
        r"A spring {{1:NUMERICAL:=2}} of {k} is longer by {x}: [[input:ans1]], $F = \frac{ k }{1}$ & 50 %."
        return answers(
            F=number(k * x, "N", "the force"),
            E=number(k * x**2 / 2, "J", "the energy"),
            to=word("a < b", ["a < b", "c=d~e"]),
        )

    asked.mistake(r"The rate $\{k\}$ = 100 % ~ #1 & <b>, in N\m.")(lambda k, x: {"F": k, "to": "c=d~e"})
    asked.mistake("(50 %) Half of it is missing.")(lambda k, x: {"E": k * x**2})
    asked.mistake("That is a little more.")(lambda k, x: {"E": k * x**2 * 1.004})
    asked.mistake("That is right.")(lambda k, x: {"F": k * x * 1.001})
    return asked


def the_question(question, credit=NOTHING, **how):
    (file,) = moodle.exported([[question]], "Springs / I", credit, **how).files
    return next(read(file))


def test_what_means_something_to_moodle_comes_through():
    found = the_question(spring().question())
    assert found.category == "$course$/top/Springs // I/1.1 Force // energy"
    assert [cell.weight for cell in found.cells] == [2, 3, 2]
    assert "&#123;1:NUMERICAL:=2&#125;" in found.text
    assert "&#91;&#91;input" in found.text
    assert "points" not in found.text
    assert found.cells[0].mark("200")[1] == found.cells[2].mark("c=d~e")[1]
    assert found.cells[0].mark("200")[1].endswith(r"= 100 % ~ #1 &amp; &lt;b&gt;, in N\m.")
    assert found.cells[2].mark("a &lt; b") == (100, "")


def test_two_mistakes_that_are_near_are_parted_in_the_middle():
    energy = the_question(spring().question()).cells[1]
    assert [energy.mark(answer) for answer in ("801", "802")] == [
        (50, "Half of it is missing."),
        (0, "That is a little more."),
    ]
    assert energy.mark("404") == (100, "")
    assert energy.mark("405") == (0, "")


def test_a_mistake_within_the_accuracy_is_right():
    assert "That is right." not in [known.says for cell in cells(spring().question()) for known in cell.known]


def test_what_an_assignment_credits_is_a_share():
    force = the_question(spring().question(), Credit(unit=60, mistake=25)).cells[0]
    assert [force.mark(answer)[0] for answer in ("400", "200", "0.4", "-400", "7")] == [100, 25, 60, 0, 0]


def test_a_question_that_cannot_be_held_is_named():
    @exercise("2", title="A law")
    def law(k=between(1, 9, reference=2)):
        "Which law, for {k}?"
        return answers(F=expression("k*x"), sketch=figure("a sketch"))

    found = moodle.exported([[law.question()], [spring().question()]], "Springs")
    assert (found.left_out, found.questions, len(found.files)) == ({"2": "expression"}, 1, 1)


def test_equal_variants_are_one_and_a_large_file_is_split(monkeypatch):
    variants = [spring().question(name) for name in ("Ada", "Ada", "Mira", "Noor")]
    (whole,) = moodle.exported([variants], "Springs").files
    assert len(list(read(whole))) == 3
    monkeypatch.setattr(moodle, "LARGEST", len(whole) * 2 // 3)
    parts = [list(read(part)) for part in moodle.exported([variants], "Springs").files]
    assert [[one.name[-1] for one in part] for part in parts] == [["1", "2"], ["3"]]
    assert len({one.category for part in parts for one in part}) == 1
