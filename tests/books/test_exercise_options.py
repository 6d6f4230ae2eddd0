"""Words of control engineering: other words for the same, and what one asks oneself about them."""

import pytest

from exercisebook.grammar import Unreadable
from exercisebook.judging import RIGHT, WRONG
from exercisebook.kinds.words import SAME, bare, named
from judged import assert_judged
from loopbook.exercises import bank
from loopbook.exercises.authoring import word
from loopbook.exercises.kinds import Word, Words

ACTIONS, STABLE = ("reverse", "direct"), ("stable", "unstable")
SIGNALS = ("setpoint", "control error", "control signal", "disturbance", "process output", "measurement noise")
SAID = {
    ("set point", SIGNALS): "setpoint",
    ("desired value", SIGNALS): "setpoint",
    ("error", SIGNALS): "control error",
    ("MV", SIGNALS): "control signal",
    ("load", SIGNALS): "disturbance",
    ("the process variable", SIGNALS): "process output",
    ("sensor noise", SIGNALS): "measurement noise",
    ("Reverse-acting", ACTIONS): "reverse",
    ("direct action", ACTIONS): "direct",
    ("not stable", STABLE): "unstable",
    ("slower", ("more sluggish", "faster")): "more sluggish",
    ("a PI controller", ("P", "PI", "PID")): "PI",
    ("relief valve", ("check valve", "safety valve")): "safety valve",
    ("indicating", ("indicator", "controller")): "indicator",
}


@pytest.mark.parametrize(("text", "among"), SAID)
def test_usual_other_words_are_read(text, among):
    assert word(among[0], among).read(text)[0] == SAID[text, among]


@pytest.mark.parametrize(
    ("text", "among"),
    [
        ("not unstable", STABLE),
        ("marginally stable", STABLE),
        ("no direct action", ACTIONS),
        ("indirect", ACTIONS),
        ("control", SIGNALS),
        ("measurement", SIGNALS),
        ("P or PI", ("P", "PI", "PID")),
    ],
)
def test_what_denies_an_option_or_may_be_several_is_none(text, among):
    with pytest.raises(Unreadable):
        word(among[0], among).read(text)


@pytest.mark.parametrize(
    ("options", "says"),
    [
        (ACTIONS, "which way must the control signal go"),
        (("heating", "cooling"), "when this actuator does more"),
        (("rises", "falls"), "what flows in and out"),
        (STABLE, "where do the poles"),
        (("overdamped", "underdamped"), "how large is the damping"),
    ],
)
def test_of_a_wrong_word_it_is_said_what_to_ask_oneself(options, says):
    assert_judged(word(options[0], options), options[1], WRONG, says)
    assert_judged(word(options[0], options), options[0], RIGHT, "right")


LISTS = sorted(
    {
        kind.among
        for chapter in bank.chapters()
        for one in bank.exercises(chapter).values()
        for kind in one.question().key.values()
        if isinstance(kind, Word | Words)
    }
)


def test_no_option_of_the_bank_is_read_as_another_one():
    for among in LISTS:
        assert len(set(map(bare, among))) == len(among)
        assert all(sum(bare(one) in row for one in among) < 2 for row in SAME), "a row holds two options"
        for option in among:
            assert named(option, among) == named(option.upper(), among) == option
            for text in (f"not {option}", f"hardly {option}", f"un-{option}", f"{option} or {among[0]}"):
                assert named(text, among) != option
