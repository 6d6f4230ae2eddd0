"""Answers that are words, one or several, in any spelling and where asked in their order."""

import numpy as np
import pytest
import sympy

from exercisebook.judging import MISTAKE, RIGHT, UNJUDGED, WRONG
from exercisebook.kinds import synonyms
from exercisebook.reading import Unreadable
from judged import assert_judged
from loopbook.exercises import bank
from loopbook.exercises.authoring import word, words
from loopbook.exercises.kinds import Word, Words

STEPS = words(["S2", "S4"], ["S1", "S2", "S3", "S4"], "the active steps")
LETTERS = words(["B", "C"], ["A", "B", "C", "D"], "the curves")
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
    (STEPS, ["S2", "S4", "S1"], WRONG, "but also something that does not belong there"),
    (STEPS, [], WRONG, "at least one belongs here"),
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
    (STEPS, "S2 und S4", RIGHT, "right"),
    (STEPS, "only S2 and S4", RIGHT, "right"),
    (STEPS, "none", WRONG, "at least one belongs here"),
    *(
        (ACTION, one, RIGHT, 'read as "reverse"')
        for one in ("r", "R", "rev", "increase-decrease", "reverse-acting controller")
    ),
    (ACTION, "x", UNJUDGED, "none of the words"),
    (word("V2", ["V1", "V2", "V3"]), 2, RIGHT, 'read as "V2"'),
    (word("V2", ["V1", "V2", "V3"]), 4, UNJUDGED, "not text"),
    (LETTERS, "only B", WRONG, "missing"),
    (LETTERS, "B und C", RIGHT, "right"),
    (LETTERS, "B or C", UNJUDGED, "'B or C' is none of the words"),
    (LETTERS, "it isn't B", UNJUDGED, "none of the words"),
    (ACTION, "un-reverse", UNJUDGED, "none of the words"),
    (word("no", ["yes", "no"]), "not no", UNJUDGED, "none of the words"),
    (word("C", ["A", "B", "C"]), "Curve C (blue dash-dot)", RIGHT, "right"),
    (word("C", ["A", "B", "C"]), "(C)", RIGHT, "right"),
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
    ("in the field", "in the control room", "behind the panel"): {
        "in the field": ["field", "the field", "locally"],
        "in the control room": ["control room", "the control room", "it is in the control room"],
        "behind the panel": ["behind panel", "behind the pannel"],
        None: ["panel", "the panel", "in the", "not in the field", "in front of the door"],
    },
    ("A", "B"): {
        "A": ["loop A", "A.", "a", "A wins"],
        "B": ["b", "loop B", "B is better"],
        None: ["A or B", "A and B", "not A", "loop", "a loop", "C"],
    },
}  # fmt: skip
#: The options of the bank, and how students type them.
TYPED = {
    ("gain too high", "gain too low", "integral time too short", "integral time too long"): {
                "gain too high": ["Kp too large", "too high gain", "the gain is too high", "gain too big",
            "gain too large", "too much gain", "high gain", "Kc too high", "K_p is too big",
            "gain is much too high", "excessive gain", "controller gain too high", "gain high",
            "too large a gain", "proportional gain too strong", "too high Kp", "gain to high",
            "too strong gain", "The gain was set too high.", "gain not low enough"],
                "gain too low": ["Kp too small", "the gain is too low", "low gain", "too low gain",
            "gain too weak", "too little gain", "not enough gain", "gain not high enough", "Kc too low",
            "insufficient gain", "K_c too small", "gain way too low", "gain is too small"],
                "integral time too short": ["Ti too short", "integral time is too small",
            "integral time too small", "short integral time", "Ti too low", "tau_I too small",
            "reset time too short", "too short integral time", "T_i too small", "too small Ti",
            "integral action too strong", "too much integral action", "intergal time too short",
            "integral too strong", "integration time too short"],
                "integral time too long": ["Ti too long", "Ti too large", "too long integral time",
            "integral time too big", "integral time is too high", "integral action too weak", "T_i is too long",
            "integral time too large", "not enough integral action", "long integral time",
            "too little integral action"],
                None: ["gain", "integral time", "gain too high or too low", "gain not too high", "lower gain",
            "the gain should be lower", "gain wrong", "too high gain and too short integral time", "Ti wrong",
            "raise the gain", "integral gain too high", "gain too high and low", "less gain", "more gain",
            "integral time should be longer", "gain ok", "not too high", "Ki too high",
            "neither gain too high nor too low", "increase the gain"],
    },
    ("too weak", "too strong", "too late", "too early"): {
                "too late": ["late", "too slow", "delayed", "it comes too late", "it is late", "too delayed",
            "acts too late", "comes late"],
        "too early": ["early", "too fast", "too soon", "acts too early", "comes too soon", "too quick"],
                "too weak": ["weak", "too small", "too little", "undercompensates", "gain too low",
            "not strong enough", "too low", "insufficient", "not enough", "under-compensated",
            "it is too weak"],
                "too strong": ["strong", "too big", "too much", "too large", "overcompensates", "too high",
            "gain too high", "over-compensated"],
        None: ["too weak and too late", "not too late", "right", "perfect", "ok", "neither"],
    },
    ("less stable", "as it was", "more sluggish"): {
        "more sluggish": ["too slow", "slow", "slower", "sluggish", "it becomes slower", "too sluggish"],
        "less stable": ["more oscillatory", "closer to instability", "it is less stable", "less damped"],
        None: ["faster", "stable", "more stable"],
    },
    ("towards", "away"): {
                "away": ["opposite", "inverse response", "wrong direction", "in the opposite direction",
            "the opposite way", "away from it", "backwards"],
        "towards": ["right direction", "toward", "it goes towards it"],
        None: ["not opposite", "up"],
    },
    ("at a limit", "wrong action", "no integral term", "oscillation"): {
                "at a limit": ["saturated", "saturation", "limit", "at its limit", "the valve is at a limit",
            "saturates", "valve saturated", "the control signal is at its limit"],
                "wrong action": ["wrong direction", "wrong sign", "the action is wrong", "action wrong",
            "wrong controller action", "acts the wrong way"],
                "no integral term": ["missing integral term", "integral term missing", "no integral action",
            "integral action missing", "the integral term is missing", "no integral", "P only", "only P",
            "without integral term", "proportional only", "it has no integral term", "integral missing",
            "lacks integral action", "lack of integral action"],
        "oscillation": ["oscillates", "oscillating", "it oscillates", "oscillations", "the loop oscillates"],
                None: ["no oscillation", "integral term", "no action", "integral action", "not at a limit",
            "wrong", "does not oscillate"],
    },
    ("sign of the damper", "sign of the spring", "D and K interchanged", "mass multiplied"): {
                "sign of the damper": ["damper sign", "wrong sign of the damper",
            "the damper has the wrong sign", "damper sign wrong", "sign of damper", "damping sign",
            "sign of the damping", "damper"],
                "sign of the spring": ["spring sign", "wrong sign of the spring",
            "the sign of the spring is wrong", "spring"],
                "D and K interchanged": ["K and D swapped", "D and K swapped", "K and D interchanged",
            "D and K exchanged", "D and K are mixed up", "D and K confused", "interchanged"],
                "mass multiplied": ["multiplied by mass", "multiplied by the mass", "mass is multiplied",
            "the mass is multiplied instead of divided", "mass multiplied instead of divided"],
        None: ["sign", "sign of the mass", "damper and spring", "no sign of the damper"],
    },
    ("oscillates more and more", "runs away to one side", "settles elsewhere", "settles at F/K"): {
                "oscillates more and more": ["growing oscillation", "growing oscillations",
            "oscillates with growing amplitude", "oscillation grows", "oscillates",
            "it oscillates more and more"],
        "runs away to one side": ["runs away", "it runs away", "runs to one side", "runs away to the side"],
                "settles elsewhere": ["settles at another value", "settles at a wrong value",
            "settles somewhere else", "settles at a different value", "it settles elsewhere"],
        "settles at F/K": ["F/K", "settles to F/K", "it settles at F/K", "at F/K"],
        None: ["settles", "does not settle", "stable", "it does not oscillate"],
    },
    ("decays without oscillating", "decays oscillating", "grows without oscillating", "grows oscillating"): {
                "decays without oscillating": ["decays without oscillation", "no oscillation, decays",
            "decays monotonically", "non-oscillating decay", "decaying without oscillations",
            "dies out without oscillating", "decays with no oscillation"],
                "decays oscillating": ["damped oscillation", "decaying oscillation", "oscillates and decays",
            "decays with oscillation", "decaying oscillations", "decays with oscillations",
            "oscillation dies out", "damped oscillations", "oscillating decay"],
                "grows without oscillating": ["grows without oscillation", "grows monotonically",
            "growth without oscillation", "grows with no oscillations"],
                "grows oscillating": ["growing oscillation", "oscillates and grows", "growing oscillations",
            "grows with oscillation", "oscillates with growing amplitude", "diverging oscillation",
            "oscillating growth"],
                None: ["oscillates", "decays", "grows", "does not decay, oscillates",
            "not decaying oscillating", "neither grows nor decays", "stable", "oscillates without decaying",
            "grows and decays"],
    },
        ("a load that raises the output", "a load that lowers the output", "noise of the measurement",
        "a change of the setpoint"): {
                "a load that raises the output": ["load that raises the output", "load raising the output",
            "load increases the output", "a disturbance that raises the output", "load raises output"],
                "a load that lowers the output": ["load lowering the output",
            "disturbance that lowers the output", "a load that decreases the output"],
        "noise of the measurement": ["noise", "measurement noise", "noise on the measurement"],
                "a change of the setpoint": ["setpoint change", "change of setpoint", "setpoint",
            "a setpoint change", "change in the setpoint", "set-point change", "change of the set point"],
        None: ["load", "output", "a load"],
    },
    ("no transmitter", "no signal to the valve", "wrong letter", "wrong number", "wrong place"): {
                "no transmitter": ["transmitter missing", "missing transmitter", "the transmitter is missing",
            "there is no transmitter", "without transmitter", "lacks a transmitter"],
                "no signal to the valve": ["signal to the valve missing", "no signal to valve",
            "the signal to the valve is missing", "missing signal to the valve", "no signal",
            "valve has no signal", "signal missing"],
        "wrong letter": ["letter wrong", "wrong letters", "the letter is wrong", "letter"],
        "wrong number": ["number wrong", "the number is wrong", "number"],
        "wrong place": ["wrong location", "place wrong", "place", "the place is wrong"],
        None: ["wrong", "no valve", "no", "no letter", "nothing"],
    },
        ("ball valve", "butterfly valve", "check valve", "hand valve", "pneumatic valve", "safety valve",
        "solenoid valve"): {
        "check valve": ["non-return valve", "check", "checkvalve"],
        "ball valve": ["ball", "a ball valve", "ball-valve", "ball valv"],
        "hand valve": ["manual valve", "hand-operated valve", "hand", "manually operated valve"],
        "safety valve": ["relief valve", "safety relief valve"],
        "solenoid valve": ["magnetic valve", "solenoid", "solenoid-valve", "selenoid valve"],
        "pneumatic valve": ["pneumatic control valve", "pneumatic", "pneumatic valves"],
        "butterfly valve": ["butterfly", "butterfly-valve"],
        None: ["valve", "control valve", "gate valve", "no valve"],
    },
        ("column with trays", "cyclone", "packed column", "plate exchanger", "reactor",
        "shell and tube exchanger", "silo"): {
        "column with trays": ["tray column", "trays column", "column with tray", "plate column"],
        "packed column": ["packed tower", "packed", "packed bed column"],
        "plate exchanger": ["plate heat exchanger", "heat exchanger with plates"],
                "shell and tube exchanger": ["shell-and-tube heat exchanger", "shell and tube heat exchanger",
            "shell & tube exchanger", "shell and tube"],
        "reactor": ["stirred reactor", "a reactor", "stirred tank reactor"],
        None: ["column", "exchanger", "heat exchanger", "tank"],
    },
    ("axial fan", "centrifugal pump", "compressor", "gear pump", "motor", "radial fan", "turbine"): {
        "axial fan": ["axial", "fan, axial", "axial fans", "fan (axial)"],
        "centrifugal pump": ["centrifugal", "centrifugal pumps"],
        "motor": ["electric motor", "a motor"],
        "gear pump": ["gear", "gearpump", "gear wheel pump"],
        "turbine": ["steam turbine"],
        None: ["pump", "fan"],
    },
        ("capillary", "data link", "electrical signal", "hydraulic signal", "pneumatic signal",
        "process connection", "radio signal"): {
        "electrical signal": ["electric signal", "electrical", "electric", "electrical signal line"],
        "pneumatic signal": ["pneumatic", "pneumatic line"],
        "hydraulic signal": ["hydraulic", "hydraulic line"],
        "radio signal": ["radio", "wireless"],
        "data link": ["data", "bus", "data bus", "fieldbus", "data line"],
        "capillary": ["capillary tube", "a capillary"],
        "process connection": ["process", "connection to the process"],
        None: ["signal", "line"],
    },
    ("own instrument", "shared display", "computer function"): {
        "own instrument": ["separate instrument", "discrete instrument", "its own instrument"],
        "shared display": ["display", "shared", "a shared display", "shared display / shared control"],
        "computer function": ["computer", "function of a computer", "computer functions", "function in the computer"],
        None: ["function or instrument"],
    },
    ("V1", "V2", "V3", "V4"): {
        "V1": ["valve 1", "V 1", "1", "v1", "valve V1", "the valve V1", "V-1", "V1 valve"],
        "V2": ["valve no 2", "V_2"],
        None: ["V5", "valve", "valve 5", "12", "V12", "V1 or V2", "flow 1"],
    },
    ("resolution", "inaccuracy"): {
        "inaccuracy": ["accuracy", "the inaccuracy", "inacuracy"],
        "resolution": ["the resolution", "quantization", "resolution of the converter"],
        None: ["both"],
    },
    ("Load", "Heat", "Mix", "Rinse", "none"): {
        "Heat": ["heat", "step Heat", "the step Heat", "heating"],
        "none": ["none", "no step"],
        None: ["Load and Heat"],
    },
    ("difference", "fraction", "none"): {
        "difference": ["differential", "difference of pressure", "delta"],
        "fraction": ["ratio"],
        "none": ["no", "no modifier", "nothing", "without"],
    },
    ("IAE", "ISE", "ITAE"): {
        "ISE": ["the ISE", "ise"],
        "ITAE": ["ITAE grows most"],
        None: ["IE"],
    },
    ("inside", "outside"): {
        "inside": ["in the window", "within the window", "inside of it"],
        "outside": ["not inside"],
    },
    ("inverse response", "overshoot", "neither"): {
        "inverse response": ["inverse", "it starts with an inverse response"],
        "overshoot": ["it overshoots", "with an overshoot", "overshooting"],
        "neither": ["neither", "none of both"],
        None: ["no inverse response"],
    },
    ("rises", "falls"): {
                "rises": ["up", "it rises first", "goes up first", "first rises", "increases", "level goes up",
            "it first goes up"],
        "falls": ["down", "it first falls", "first it falls", "decreases first"],
    },
    ("reverse", "direct"): {
        "reverse": ["inverse", "rev", "reverse acting", "reverse (increase/decrease)", "inverse action"],
        "direct": ["dir", "direct acting", "the action is direct"],
        None: ["not inverse"],
    },
    ("stable", "unstable"): {
        "unstable": ["diverges", "becomes unstable", "it goes unstable", "unstable loop", "not stable"],
        "stable": ["it stays stable", "remains stable", "stable loop"],
    },
    ("dead end", "orphan", "covered branch", "waiting forever", "twice active", "sound"): {
        "dead end": ["dead-end", "a dead end"],
        "covered branch": ["branch covered", "a branch is covered", "covered"],
        "waiting forever": ["waits forever", "it waits for ever", "forever waiting"],
        "twice active": ["active twice", "a step is active twice"],
        "orphan": ["orphan step", "orphaned", "an orphan step"],
        "sound": ["ok", "correct", "no mistake", "it is correct"],
    },
    ("in the field", "in the control room", "behind the panel"): {
        "in the field": ["field", "locally", "field mounted", "local"],
        "in the control room": ["control room", "central control room"],
        "behind the panel": ["behind panel", "behind", "at the back of the panel"],
    },
    ("electrical signal", "process connection", "pipe"): {
        "electrical signal": ["electric", "signal", "electrical line", "an electric signal"],
        "process connection": ["connection", "process", "connection to the process"],
        "pipe": ["a pipe", "piping", "pipeline"],
    },
}  # fmt: skip


def test_a_word_is_found_in_what_people_write(subtests):
    for options, rows in (*SAID.items(), *TYPED.items()):
        kind = word(options[0], options)
        for option, texts in rows.items():
            with subtests.test(f"{option} of {options}"):
                for text in texts:
                    if option is None:
                        with pytest.raises(Unreadable, match="none of the words"):
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
    for among, option in ((row, option) for row in LISTS for option in row):
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


def test_judging(subtests):
    for kind, given, status, says in JUDGED:
        with subtests.test(f"{given!r:.60}"):
            assert_judged(kind, given, status, says)
