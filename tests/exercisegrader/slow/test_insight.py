"""What a class tells: how hard a question is and for whom, mistakes that no page knows, whose numbers were posted."""

import csv
import datetime
import io
import json
import random

import pytest

from assignments import students
from exercisebook.pages import page
from exercisegrader import GradingError, insight
from exercisegrader.assignment import Assignment
from exercisegrader.insight import Attempt
from exercisegrader.released import Released, texts
from exercisegrader.results import JudgedAnswer, JudgedExercise

#: Ten exercises: what is given, with ranges and units; the formula with its unit; and a mistake that no page knows.
PLANTED = [
    ("m 2 9 kg, k 100 400 N/m", "f = sqrt(k/m)/(2*pi)  [1/s]", "f = sqrt(k/m)"),
    ("A 1 5 m², h 1 4 m, q 2 9 L/s", "t = A*h/q  [min]", "t = 1000*A*h/q"),
    ("T_1 20 60 °C, T_2 70 95 °C, w 1 4 kg/s", "P = 4.19*w*(T_2 - T_1)", "P = 4.19*w*(T_2 + T_1)"),
    ("K 2 9 , T 10 60 s, L 2 9 s", "K_p = T/(K*(L + L))", "K_p = T/(K*L)"),
    ("U 5 24 V, R 20 90 Ω", "P = U**2/R", "P = U*R"),
    ("K 1 5 , T 20 90 s, t 5 60 s", "y = K*(1 - exp(-t/T))", "y = K*exp(-t/T)"),
    ("d 20 90 mm, v 1 4 m/s", "q = pi/4*d**2*v/1000", "q = pi*d**2*v/1000"),
    ("a 2 9 m, b 2 9 m, c 2 9 m²", "s = a*b + c", "s = a*(b + c)"),
    ("I 5 20 , low 10 40 °C, span 50 90 K", "T = low + (I - 4)/16*span", "T = low + I/16*span"),
    ("D 5 60 %, n 2 8 ", "r = (1 - D)**n", "r = 1 - (D/100)**n"),
]


def _page(number, givens, formula):
    rows = "".join(
        "| {} | {} … {} | {} | |\n".format(*f"{one} ".split(" ")[:4]) for one in givens.split(", ")
    )  # every given has a name, a range and a unit that may be empty
    name = formula.partition(" ")[0]
    return (
        f"# {number} Title (1 point)\n\nWhat?\n\n## Given\n| name | values | unit | |\n|---|---|---|---|\n{rows}"
        f"\n## Formulas\n```\n{formula}\n```\n\n## Asked\n- `{name}` the value\n\n"
    )


PAGES = page.of("".join(_page(k, *one[:2]) for k, one in enumerate(PLANTED, 1)), "pages.md")[1]


def judged(question, answers, share=None):
    """The answers of somebody to an exercise, right or wrong; without an answer, right."""
    found = []
    for name, kind in question.key.items():
        answer = answers.get(name, kind.key)
        status = "right" if kind.agrees(kind.read(answer)[0]) else "wrong"
        found.append(JudgedAnswer(name, status, "not right", answer, ""))
    return JudgedExercise(question.exercise.number, "", 1, "", (), tuple(found))


def a_class(seed, mistaken, guessing):
    """What sixty students answer: some make the mistake of an exercise, some guess; and who made which."""
    rng, attempts, made = random.Random(seed), [], {}
    for (number, one), (*_, mistake) in zip(PAGES.items(), PLANTED, strict=True):
        change = dict([one._read_change(mistake)])
        for k in range(60):
            question, what = one.question(f"s{seed}-{k}"), rng.random()
            ((name, kind),) = question.key.items()
            answers = {}
            if what < mistaken:
                answers = {name: float(f"{one.following(question.values, change, name).key:.4g}")}
                made.setdefault(number, set()).add(f"s{k}")
            elif what < mistaken + guessing:
                near = kind.key * 2 ** rng.gauss(0, 1)
                guess = rng.choice([near, near, round(near, 1), rng.choice([1, 2, 5, 10, 20, 50, 100])])
                answers = {name: float(f"{guess:.3g}")}
            attempts.append(Attempt(f"s{k}", judged(question, answers), question))
    return attempts, made


@pytest.mark.parametrize("seed", [1])
def test_planted_mistakes_are_found(seed):
    attempts, made = a_class(seed, mistaken=0.15, guessing=0.15)
    found = {}
    for one in insight.mined(attempts):
        assert len(made[one.number] & one.numbers.keys()) >= 0.8 * len(one.numbers), one  # none is another's
        found[one.number] = one
    assert sum(len(found[number].numbers) >= 0.8 * len(made[number]) for number in found) >= 8, sorted(found)
    one = found["8"]  # what is proposed is a line of the page
    mended = page.of(_page(8, *PLANTED[7][:2]) + f"## Mistakes\n- `{one.line}` A sentence.\n", "p.md")[1]["8"]
    for attempt in attempts:
        if attempt.student in one.numbers:
            question = mended.question(attempt.question.student)
            assert question.check(s=one.numbers[attempt.student]).verdicts[0].says.startswith("A sentence")


@pytest.mark.parametrize("seed", [1])
def test_of_guessers_nothing_is_proposed(seed):
    assert insight.mined(a_class(seed, mistaken=0, guessing=1)[0]) == []


def test_how_hard_a_question_is_and_for_whom():
    rng, attempts = random.Random(5), []
    for k in range(60):
        for number in ("5", "8"):
            question = PAGES[number].question(f"s{k}")
            hard = float(question.values["U"]) > 14 if number == "5" else k % 5 == 0
            wrong = {name: 3 * kind.key for name, kind in question.key.items()}
            attempts.append(Attempt(f"s{k}", judged(question, wrong if hard and rng.random() < 0.95 else {}), question))
    first, second = insight.items(attempts)
    assert 0.3 < first.mean < 0.7 < second.mean < 0.9
    (says,) = first.says
    assert says == "differs with U: 75 % for up to 16 (40), 5 % for above 16 (20)"
    assert second.says == []
    days = insight.by_day(attempts, {f"s{k}": datetime.datetime(2026, 11, 1 + k % 2, 12) for k in range(30)})
    assert [(day, count) for day, count, _ in days] == [("2026-11-01", 15), ("2026-11-02", 15)]
    text, table = insight.report(attempts, days, [insight.Proposal("5", "P", "P = U*R", {"s1": 2.0}, 4)])
    assert "- `P = U*R` …\n  (5 P: 1 of 4 wrong, s1 2)" in text
    assert insight.report(attempts[:6], [], [])[0].count("too few") == 2  # of three students nothing is told
    rows = list(csv.DictReader(io.StringIO(table.lstrip("\ufeff"))))
    assert [row["remark"] for row in rows][2:] == [
        "handed in on 2026-11-01", "handed in on 2026-11-02", "propose: P = U*R"
    ]  # fmt: skip


def test_whose_numbers_were_posted(tmp_path):
    source = '# Title\n\n```toml\nsecret = "a secret of many letters"\n```\n\n' + _page(1, *PLANTED[0][:2])
    given = Assignment.of(source, "posted", tmp_path / "posted.md")
    with pytest.raises(GradingError, match="no record of a release"):
        insight.whose(given, "m=2")
    record = Released("posted")
    for one in students("Ada", "Bob", "Eve"):
        record = record.with_release(one, {"1": texts(given.question(one.id, "1"))})
    record.write(given.record, given.secret)
    own = given.question("s1002", "1")
    m, k, f = own.values["m"], own.values["k"], own.key["f"].key
    for posted in (f"m={m}, k = {k}", f"{m} kg and {k} N/m", f"k={k}; the answer is {f:.4f}".replace(".", ",")):
        assert [who[:2] for who in insight.whose(given, posted)] == [("s1002", "Bob")], posted
    assert insight.whose(given, f"m={m}, k={k + 1000}") == []
    with pytest.raises(GradingError, match="'help' has no number"):
        insight.whose(given, "help")


def test_saved_progress_is_read(tmp_path):
    source = '# Title\n\n```toml\nsecret = "a secret of many letters"\n```\n\n' + _page(1, *PLANTED[0][:2])
    given = Assignment.of(source, "practice", tmp_path / "practice.md")
    right = {name: str(kind.key) for name, kind in given.exercises["1"].question("Mira").key.items()}
    tried = {"1 Mira": {"answers": right, "attempts": 3, "hints": 1}, "9.9": {"answers": {}}}
    (tmp_path / "one.json").write_text(json.dumps({"answered": {"1 Mira": True}, "tried": tried}), encoding="utf-8")
    (tmp_path / "other.json").write_text('{"tried": {"1": 3}}', encoding="utf-8")
    ((one,), (remark,)) = insight.of_progress(given, tmp_path)
    assert (one.student, one.attempts, one.hints, one.judged.answers[0].status) == ("one", 3, 1, "right")
    assert remark.startswith("other.json holds no progress")
