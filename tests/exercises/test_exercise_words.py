"""Answers that are words, one or several, in any spelling and where asked in their order."""

import numpy as np
import pytest
import sympy

from exercisebook.judging import MISTAKE, RIGHT, UNJUDGED, WRONG
from exercisebook.kinds.words import SAME, bare, named
from exercisebook.reading import Unreadable
from judged import assert_judged
from loopbook.exercises import bank
from loopbook.exercises.authoring import word, words
from loopbook.exercises.kinds import Word, Words

STEPS = words(["S2", "S4"], ["S1", "S2", "S3", "S4"], "the active steps")
LETTERS = words(["B", "C"], ["A", "B", "C", "D"], "the curves")
ROUTE = words(["fill", "heat", "empty"], ["fill", "heat", "empty", "wait"], "the steps", ordered=True)
ACTION = word("reverse", ["reverse", "direct"], "the action")
TAG = words(["L", "C"], ["L", "C", "LC"], "the letters", ordered=True)
FUNCTIONS = words(["indicator", "controller"], ["indicator", "controller", "secure control"], ordered=True)
TRUE = word("yes", ["yes", "no"], "whether it is stable")

JUDGED = [
    (ACTION, " REVERSE", RIGHT, "right"),
    (ACTION, "direct", WRONG, "which way must the control signal go"),
    (ACTION, "backwards", UNJUDGED, "reverse or direct"),
    (ACTION, 1, UNJUDGED, "not text"),
    (TRUE, True, RIGHT, "right"),
    (STEPS, "S2", WRONG, "missing"),
    (STEPS, ["S2", "S4", "S1"], WRONG, "but also something that does not belong there"),
    (STEPS, [], WRONG, "at least one belongs here"),
    (STEPS, ["S2", "S9"], UNJUDGED, "none of the words"),
    (ROUTE, ["empty", "heat", "fill"], MISTAKE, "opposite order"),
    (ROUTE, ["heat", "fill", "empty"], WRONG, "order"),
    (ROUTE, {"heat", "fill", "empty"}, UNJUDGED, "a set has no order"),
    (ACTION, True, UNJUDGED, "True is a truth value: expected reverse or direct"),
    # in other forms and spellings
    *(
        (ACTION, one, RIGHT, "right")
        for one in ("reverse.", "'Reverse'", ["reverse"], {"reverse"}, np.array("reverse"))
    ),
    *((TRUE, one, RIGHT, "right") for one in (np.True_, sympy.true)),
    (ACTION, "-", UNJUDGED, "none of the words"),
    (word("cascade control", ["cascade control", "feedforward"]), "cascade-control", RIGHT, "right"),
    (word("2", ["1", "2"]), 2, RIGHT, "right"),
    (word("+", ["+", "-"]), "-", WRONG, "not right"),
    *(
        (STEPS, one, RIGHT, "right")
        for one in ("S2 and S4", "S2 S4", "S2; S4", "S2 & S4", "only S2 und S4", "S4 + S2.")
    ),
    *((STEPS, one, RIGHT, "right") for one in (["S4", "S2", "S2"], {"s2", "s4"}, np.array(["S2", "S4"]), "{S2, S4}")),
    *((ROUTE, one, RIGHT, "right") for one in ("fill -> heat → empty", "fill, then heat, then empty")),
    *((LETTERS, one, RIGHT, "right") for one in ("BC", "B und C")),
    (STEPS, "none", WRONG, "at least one belongs here"),
    (ACTION, "reverse acting", RIGHT, 'read as "reverse"'),
    (word("V2", ["V1", "V2", "V3"]), 2, UNJUDGED, "not text"),
    (LETTERS, "only B", WRONG, "missing"),
    (LETTERS, "B or C", UNJUDGED, "'or' is none of the words"),
    (LETTERS, "it isn't B", UNJUDGED, "none of the words"),
    (STEPS, "S2, but not S4", UNJUDGED, "'but not S4' is none of the words"),
    (TAG, "L C", RIGHT, "right"),
    (FUNCTIONS, "indicating, contoller", RIGHT, 'read as "indicator", "controller"'),
    (FUNCTIONS, "secure control", WRONG, "none of them belongs there"),
]

#: {options: {option: the ways to say it}}; what is under None is none of them.
SAID = {
    ("setpoint", "control error", "control signal", "disturbance", "process output", "measurement noise"): {
        "setpoint": ["set point", "Set-Point", "the set_point", "SETPOINT.", "reference", "desired value", "setponit"],
        "disturbance": ["a disturbance", "load", "disturbace"],
        "process output": ["process variable", "PV", "proces output"],
        "control signal": ["controller output", "MV", "control-signal"],
        "measurement noise": ["sensor noise", "measurment noise"],
        None: ["control", "measurement", "not the setpoint", "setpoint or disturbance", "both", "the", "", "?"],
    },
    ("yes", "no"): {
        "yes": ["Yes.", "true", "y"],
        "no": ["No!", "false", "n"],
        None: ["maybe", "yes and no", "yes, it does not", "not no", "not yes", "neither", "nothing"],
    },
    ("stable", "unstable"): {
        "stable": ["stabel", "(stable)"],
        "unstable": ["not stable", "not-stable", "un-stable", "unstabel"],
        None: ["now stable", "not unstable", "hardly stable", "marginally stable", "it is not stable"],
    },
    ("reverse", "direct"): {
        "reverse": ["reverse acting", "Reverse-acting", "reverse action", "revers"],
        "direct": ["direct action", "drect", "directs"],
        None: ["not reverse", "un-reverse", "indirect", "director", "reverse or direct", "no direct action", "x"],
    },
    ("gain too high", "gain too low", "no integral term"): {
        "gain too high": ["Gain too high.", "gain-too-high"],
        "no integral term": ["no integrall term"],
        None: ["gain", "gain not too high", "gain to low", "now integral term", "an integral term"],
    },
    ("inside", "outside"): {"inside": ["insde"], None: ["aside", "not inside"]},
    ("a load that raises the output", "a load that lowers the output"): {
        "a load that raises the output": ["load that raises output", "the load that rises the output"],
        None: ["a load", "a load that raises or lowers the output"],
    },
    ("P", "PI", "PID"): {"PI": ["pi", "PI-controller", "a PI controller"], None: ["P or PI", "PIP", "controller"]},
    ("A", "B"): {"A": ["A.", "a", "(A)"], "B": ["b"], None: ["A or B", "A and B", "A B", "not A", "it isn't B", "C"]},
    ("V1", "V2", "V12"): {"V1": ["v1", "V 1", "V_1", "V-1"], None: ["V", "V3", "V1 2", "1"]},
    ("LSHH7", "LSLL7"): {None: ["LSHL7", "LSH7"]},
    ("21", "-21"): {"21": ["21", 21], "-21": ["-21", -21], None: ["2 1", "2-1"]},
    ("increase", "rises", "falls"): {"increase": ["increase"], "rises": ["rises"], None: ["up"]},
}  # fmt: skip


@pytest.mark.parametrize("options", SAID, ids=", ".join)
def test_an_option_is_recognised_and_what_denies_it_is_not(options):
    kind = word(options[0], options)
    for option, texts in SAID[options].items():
        for text in texts:
            if option is None:
                with pytest.raises(Unreadable, match=r"none of the words|not text"):
                    kind.read(text)
            else:
                meant, remark = kind.read(text)
                assert meant == option, text
                assert remark in ("", f'read as "{option}"')


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
            for text in (f"not {option}", f"hardly {option}", f"un{option}", f"{option} or {among[0]}"):
                assert named(text, among) != option


def test_judging(subtests):
    for kind, given, status, says in JUDGED:
        with subtests.test(f"{given!r:.60}"):
            assert_judged(kind, given, status, says)
