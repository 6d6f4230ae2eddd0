"""Answers that are words, one or several, in any spelling and where asked in their order."""

import numpy as np
import pytest
import sympy

from exercisebook.authoring import word, words
from exercisebook.grammar import Unreadable
from exercisebook.judging import MISTAKE, RIGHT, UNJUDGED, WRONG
from exercisebook.kinds.words import SAME, also_said
from judged import assert_judged

STEPS = words(["S2", "S4"], ["S1", "S2", "S3", "S4"], "the active steps")
LETTERS = words(["B", "C"], ["A", "B", "C", "D"], "the curves")
ROUTE = words(["fill", "heat", "empty"], ["fill", "heat", "empty", "wait"], "the steps", ordered=True)
WAY = word("left", ["left", "right"], "the way")
TAG = words(["L", "C"], ["L", "C", "LC"], "the letters", ordered=True)
TOOLS = words(["hammer", "spanner"], ["hammer", "spanner", "screw driver"], ordered=True)
TRUE = word("yes", ["yes", "no"], "whether it holds")

JUDGED = [
    *((WAY, one, RIGHT, "right") for one in (" LEFT", "left.", "'Left'", ["left"], {"left"}, np.array("left"))),
    (WAY, "right", WRONG, "not right"),
    (WAY, "backwards", UNJUDGED, "left or right"),
    (WAY, "-", UNJUDGED, "none of the words"),
    (WAY, 1, UNJUDGED, "not text"),
    (WAY, True, UNJUDGED, "True is a truth value: expected left or right"),
    *((TRUE, one, RIGHT, "right") for one in (True, np.True_, sympy.true)),
    (word("2", ["1", "2"]), 2, RIGHT, "right"),
    (word("V2", ["V1", "V2", "V3"]), 2, UNJUDGED, "not text"),
    (word("+", ["+", "-"]), "-", WRONG, "not right"),
    # several
    *(
        (STEPS, one, RIGHT, "right")
        for one in ("S2 and S4", "S2 S4", "S2; S4", "S2 & S4", "only S2 und S4", "S4 + S2.", "{S2, S4}")
    ),
    *((STEPS, one, RIGHT, "right") for one in (["S4", "S2", "S2"], {"s2", "s4"}, np.array(["S2", "S4"]))),
    (STEPS, "S2", WRONG, "something is missing"),
    (STEPS, ["S2", "S4", "S1"], WRONG, "but also something that does not belong there"),
    (STEPS, [], WRONG, "at least one belongs here"),
    (STEPS, "none", WRONG, "at least one belongs here"),
    (STEPS, ["S2", "S9"], UNJUDGED, "none of the words"),
    (STEPS, "S2, but not S4", UNJUDGED, "'but not S4' is none of the words"),
    *((LETTERS, one, RIGHT, "right") for one in ("BC", "B und C")),
    (LETTERS, "only B", WRONG, "missing"),
    (LETTERS, "B or C", UNJUDGED, "'or' is none of the words"),
    (LETTERS, "it isn't B", UNJUDGED, "none of the words"),
    # in their order
    *((ROUTE, one, RIGHT, "right") for one in ("fill -> heat → empty", "fill, then heat, then empty")),
    (ROUTE, ["empty", "heat", "fill"], MISTAKE, "opposite order"),
    (ROUTE, ["heat", "fill", "empty"], WRONG, "order"),
    (ROUTE, {"heat", "fill", "empty"}, UNJUDGED, "a set has no order"),
    (TAG, "L C", RIGHT, "right"),
    (TOOLS, "the hamer, spaner", RIGHT, 'read as "hammer", "spanner"'),
    (TOOLS, "screw driver", WRONG, "none of them belongs there"),
]


def test_judging(subtests):
    for kind, given, status, says in JUDGED:
        with subtests.test(f"{given!r:.60}"):
            assert_judged(kind, given, status, says)


#: {options: {option: the ways to say it}}; what is under None is none of them.
SAID = {
    ("mass point", "motion", "momentum", "mean velocity"): {
        "mass point": ["mass-point", "Mass Point", "the mass_point", "MASSPOINT.", "(mass point)", "mass piont"],
        "momentum": ["a momentum", "momentun", "momntum"],
        "mean velocity": ["mean velocty", "mean-velocity", "its mean velocity is meant"],
        None: ["mass", "mo", "velocity", "not the momentum", "momentum or motion", "both", "the", "", "?", "x" * 300],
    },
    ("yes", "no"): {
        "yes": ["Yes.", "true", "y"],
        "no": ["No!", "false", "n"],
        None: ["maybe", "yes and no", "yes, it does not", "not no", "not yes", "neither", "nothing"],
    },
    ("elastic", "inelastic"): {
        "elastic": ["elastc", "it is elastic"],
        None: ["not elastic", "un-elastic", "hardly elastic", "elasticity", "elastic or inelastic?"],
    },
    ("speed too high", "speed too low", "no friction at all"): {
        "speed too high": ["Speed too high.", "speed-too-high"],
        "no friction at all": ["no frction at all"],
        None: ["speed", "speed not too high", "now friction at all", "friction at all"],
    },
    ("inside", "outside"): {"inside": ["insde"], None: ["aside", "not inside"]},
    ("a wind that raises the drag", "a wind that lowers the drag"): {
        "a wind that raises the drag": ["wind that raises drag", "the wind that rises the drag"],
        None: ["a wind", "a wind that raises or lowers the drag"],
    },
    ("A", "B"): {"A": ["A.", "a", "(A)"], "B": ["b"], None: ["A or B", "A and B", "A B", "not A", "it isn't B", "C"]},
    ("V1", "V2", "V12"): {"V1": ["v1", "V 1", "V_1", "V-1"], None: ["V", "V3", "V1 2", "1"]},
    ("LSHH7", "LSLL7"): {None: ["LSHL7", "LSH7"]},
    ("21", "-21"): {"21": ["21", 21], "-21": ["-21", -21], None: ["2 1", "2-1"]},
    ("increase", "rises", "falls"): {"increase": ["increase"], "rises": ["rises"], None: ["up"]},
    ("up", "down"): {"up": ["increases"], "down": ["falls"], None: ["larger"]},
}


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


def test_words_of_a_subject_mean_the_same_when_that_is_said():
    kind = word("bike", ["bike", "car"])
    with pytest.raises(Unreadable):
        kind.read("velo")
    also_said("bike, push bike, the velo")
    try:
        assert kind.read("Push-bike")[0] == kind.read("velo")[0] == "bike"
    finally:
        SAME.pop()
