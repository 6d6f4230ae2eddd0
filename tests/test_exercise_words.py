"""Answers that are words, one or several, in any spelling and where asked in their order."""

import numpy as np
import pytest
import sympy

from judged import assert_judged
from loopbook.exercises import bank
from loopbook.exercises.authoring import word, words
from loopbook.exercises.judging import MISTAKE, RIGHT, UNJUDGED, WRONG
from loopbook.exercises.kinds import Word, Words, synonyms
from loopbook.exercises.reading import Unreadable

STEPS = words(["S2", "S4"], ["S1", "S2", "S3", "S4"], "the active steps")
ROUTE = words(["fill", "heat", "empty"], ["fill", "heat", "empty", "wait"], "the steps", ordered=True)
ACTION = word("reverse", ["reverse", "direct"], "the action")
TRUE = word("yes", ["yes", "no"], "whether it is stable")

JUDGED = [
    (ACTION, " REVERSE", RIGHT, "right"),
    (ACTION, "direct", WRONG, "which way must the control signal go"),
    (ACTION, "backwards", UNJUDGED, "reverse or direct"),
    (ACTION, 1, UNJUDGED, "not text"),
    (TRUE, True, RIGHT, "right"),
    (STEPS, {"s2", "s4"}, RIGHT, "right"),
    (STEPS, "S2", WRONG, "missing"),
    (STEPS, ["S2", "S4", "S1"], WRONG, "but also more"),
    (STEPS, [], WRONG, "empty"),
    (STEPS, ["S2", "S9"], UNJUDGED, "none of the words"),
    (ROUTE, ["empty", "heat", "fill"], MISTAKE, "opposite order"),
    (ROUTE, ["heat", "fill", "empty"], WRONG, "order"),
    (ROUTE, {"heat", "fill", "empty"}, UNJUDGED, "a set has no order"),
    (ACTION, True, UNJUDGED, "True is a truth value: expected reverse or direct"),
    (STEPS, "S2 and S4", RIGHT, "right"),
    (STEPS, "S2 S4", RIGHT, "right"),
    (STEPS, ["S4", "S2", "S2"], RIGHT, "right"),
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
        for one in ("S2; S4", "{S2, S4}", np.array(["S2", "S4"]), {"S2": 1, "S4": 1}.keys())
    ),
    (ROUTE, "fill -> heat → empty", RIGHT, "right"),
    (ROUTE, "fill, then heat, then empty", RIGHT, "right"),
    (STEPS, "S2 & S4", RIGHT, "right"),
    (STEPS, "S2 + S4.", RIGHT, "right"),
    (word("setpoint", ["setpoint", "disturbance"]), "Set-point", RIGHT, 'read as "setpoint"'),
    (
        words(["indicator", "controller"], ["indicator", "controller", "alarm"], ordered=True),
        "indicates and controls",
        RIGHT,
        'read as "indicator", "controller"',
    ),
]

#: {options: {option: the ways to say it}}.
SAID = {
    (
        "setpoint", "control error", "control signal", "disturbance", "process output", "measurement noise",
    ): {
        "setpoint": [
            "set point", "Set-Point", "the set point", "a setpoint", "reference", "desired value", "setpoints",
            "setponit",
        ],
        "disturbance": [
            "a disturbance", "the disturbance", "load", "it is a disturbance", "disturbances", "disturbace",
            "load disturbance",
        ],
        "process output": [
            "the process output", "process variable", "controlled variable", "PV", "output of the process", "output",
            "proces output",
        ],
        "control signal": [
            "the control signal", "controller output", "manipulated variable", "MV", "it's the control signal",
            "control-signal",
        ],
        "measurement noise": ["noise", "sensor noise", "the measurement noise", "measurment noise"],
        "control error": ["error", "the error signal", "control deviation", "it must be the control error"],
        None: [
            "control", "secure control", "control error signal", "measurement", "not the setpoint",
            "setpoint or disturbance", "actuator", "", "?", "both", "set", "the",
        ],
    },
    ("up", "down"): {
        "up": ["upwards", "it goes up", "increases", "rises", "Up!", "higher"],
        "down": ["downwards", "goes down", "it decreases", "falls", "lower"],
        None: ["not up", "up or down", "up and down", "u", "sideways", "it does not go up"],
    },
    ("rises", "falls"): {
        "rises": ["it rises", "rising", "goes up", "increases", "risess", "rise"],
        "falls": ["falling", "it falls", "drops", "decreases", "the level falls", "fals", "fall"],
        None: ["it rises and then falls", "does not rise", "stays"],
    },
    ("well damped", "poorly damped"): {
        "well damped": ["it is well damped", "well-damped", "well", "sufficiently damped", "well dampd"],
        "poorly damped": ["poorly", "poorly-damped", "badly damped", "the loop is poorly damped", "porly damped"],
        None: ["damped", "not well damped", "undamped", "overdamped"],
    },
    ("yes", "no"): {
        "yes": ["Yes.", "true", "yes, it does", "yes it oscillates", "y", "Yes, it is underdamped", "it does"],
        "no": ["No!", "false", "no, it does not", "it doesn't", "no, never", "n", "not at all"],
        None: ["maybe", "yes and no", "yes, it does not", "perhaps yes", "it is unclear"],
    },
    ("runs over", "runs empty"): {
        "runs over": ["it runs over", "overflows", "the cistern overflows", "it will run over"],
        "runs empty": ["empties", "it runs dry", "runs emty"],
        None: ["runs", "it does not run over", "runs over or runs empty"],
    },
    ("towards", "away"): {
        "towards": ["toward", "in the right direction", "towards it"],
        "away": ["away from it", "in the wrong direction", "it sets out away"],
        None: ["not away", "first away, then towards"],
    },
    ("reverse", "direct"): {
        "reverse": ["reverse acting", "reverse-acting", "reverse action", "Reversed", "revers", "it must be reverse"],
        "direct": ["direct action", "Direct-acting", "direct acting", "drect", "a direct action"],
        None: ["not reverse", "indirekt", "director", "reverse or direct", "no direct action"],
    },
    ("stable", "unstable"): {
        "stable": ["it is stable", "remains stable", "still stable", "stabel"],
        "unstable": [
            "not stable", "it is unstable", "no longer stable", "unstabel", "the loop becomes unstable",
            "it is not stable any more",
        ],
        None: ["marginally stable", "not unstable", "stable or unstable", "nearly unstable"],
    },
    ("smaller", "larger"): {
        "smaller": ["it is smaller", "less", "lower", "reduced", "smaler"],
        "larger": ["bigger", "greater", "it becomes larger", "higher"],
        None: ["not larger", "equal", "larger or smaller", "no smaller"],
    },
    ("less stable", "as it was", "more sluggish"): {
        "less stable": ["it is less stable", "less stable than before", "closer to instability"],
        "as it was": ["unchanged", "the same", "no change", "it is as it was", "as before"],
        "more sluggish": ["sluggish", "slower", "it becomes more sluggish"],
        None: ["stable", "more stable", "not less stable", "better"],
    },
    ("cascade", "single loop"): {
        "cascade": ["the cascade", "cascade control", "in the cascade", "cascad"],
        "single loop": ["single", "the single loop", "single-loop", "single lop"],
        None: ["loop", "neither", "the cascade or the single loop"],
    },
    ("lower", "upper"): {
        "lower": ["the lower half", "lower part", "in the lower half"],
        "upper": ["upper half", "in the upper one", "uper"],
        None: ["slower", "not lower", "supper", "middle"],
    },
    ("dead end", "orphan", "covered branch", "waiting forever", "twice active", "sound"): {
        "dead end": ["deadend", "a dead end", "dead-end"],
        "waiting forever": ["forever", "waits forever", "it waits for ever", "never stops waiting"],
        "twice active": ["active twice", "twice-active", "it is twice active"],
        "covered branch": ["a covered branch", "covered"],
        "sound": ["no mistake", "it is sound", "nothing wrong"],
        "orphan": ["an orphan", "orphn"],
        None: ["active", "no orphan", "not sound"],
    },
    ("inverse response", "overshoot", "neither"): {
        "inverse response": [
            "an inverse response", "inverse-response", "it is an inverse response", "invers response",
        ],
        "overshoot": ["an overshoot", "it overshoots", "overshot"],
        "neither": ["neither of them", "none", "neither of both"],
        None: ["no overshoot", "without overshoot", "response", "overshoot and inverse response"],
    },
    ("inside", "outside"): {
        "inside": ["inside the window", "it is inside", "within", "insde"],
        "outside": ["outside of the window", "it lies outside", "outsid"],
        None: ["on the border", "not outside", "inside and outside"],
    },
    ("in the field", "in the control room", "behind the panel"): {
        "in the field": ["field", "the field", "locally"],
        "in the control room": ["control room", "the control room", "it is in the control room"],
        "behind the panel": ["behind panel", "behind the pannel"],
        None: ["in the", "not in the field", "in front of the door"],
    },
    ("A", "B"): {
        "A": ["loop A", "A.", "a", "A wins"],
        "B": ["b", "loop B", "B is better"],
        None: ["A or B", "A and B", "not A", "loop", "a loop", "C"],
    },
    ("Small", "Medium", "Large", "none"): {
        "Small": ["small", "the small one"],
        "Medium": ["medium", "Meduim"],
        "none": ["None", "nothing", "none of them"],
        None: ["smaller", "Small or Large", "no Small"],
    },
    ("T1", "T1a", "T1b", "T2", "T3"): {
        "T1": ["rule T1", "t1"],
        "T1a": ["T1a", "the rule T1a"],
        None: ["T", "T1c", "T4", "T1 or T2", "T11"],
    },
    ("LAL7", "LIC7", "LT7", "LT8"): {
        "LAL7": ["lal7", "LAL7."],
        "LT7": ["LT7"],
        None: ["LT9", "LAX7", "LIC8", "LIC", "LC7"],
    },
}  # fmt: skip
WAYS = [(options, option, text) for options, rows in SAID.items() for option, texts in rows.items() for text in texts]


@pytest.mark.parametrize(("options", "option", "text"), WAYS, ids=[f"{text}-{option}" for _, option, text in WAYS])
def test_a_word_is_found_in_what_people_write(options, option, text):
    kind = word(options[0], options)
    if option is None:
        with pytest.raises(Unreadable, match="none of the words"):
            kind.read(text)
    else:
        meant, remark = kind.read(text)
        assert meant == option
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


@pytest.mark.parametrize("among", LISTS, ids=[among[0] for among in LISTS])
def test_no_option_of_the_bank_is_read_as_another_one(among):
    for option in among:
        assert synonyms.found(option, among) in (option, None)
        for text in (
            f"the {option}",
            f"it is {option}",
            f"{option}s",
            option.upper(),
            option[1:],
            option[:-1],
            f"x{option}",
        ):
            assert synonyms.found(text, among) in (option, None) or text in among
        denials = () if option in ("no", "none", "neither") else (f"no {option}", f"hardly {option}", f"not {option}")
        for text in (*denials, f"{option} or {among[0]}", f"either {option}"):
            assert synonyms.found(text, among) != option or option == among[0]
        for row in synonyms.SAME.strip().splitlines():
            forms = [synonyms.bare(form) for form in row.split(",")]
            if synonyms.bare(option) in forms:
                assert sum(synonyms.bare(one) in forms for one in among) == 1, "a row holds two options"
                assert {synonyms.found(form, among) for form in forms} <= {
                    option,
                    None,
                    *(o for o in among if synonyms.bare(o) in forms),
                }


@pytest.mark.parametrize(("kind", "given", "status", "says"), JUDGED, ids=range(len(JUDGED)))
def test_judging(kind, given, status, says):
    assert_judged(kind, given, status, says)
