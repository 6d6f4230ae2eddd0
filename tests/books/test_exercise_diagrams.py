"""P&I diagrams as readers write them: read in many forms, compared by their structure, and drawn."""

import re

import pytest

from exercisebook.judging import RIGHT, UNJUDGED, WRONG, judge
from loopbook.exercises import bank
from loopbook.exercises.connections import connections
from loopbook.exercises.kinds import InstrumentDiagram

KEY = """vessel -> LT11 -> LC11 -> FC12 -//-> FV12 -> outlet
outlet -> FT12 -> FC12
LT11 -> LAH11"""
KIND = InstrumentDiagram(
    KEY, {"inlet": "pipe", "vessel": "vessel", "outlet": "pipe"}, "the diagram", {"vessel": ["tank"]}
)


def changed(old, new=""):
    assert old in KEY
    return KEY.replace(old, new)


@pytest.mark.parametrize(
    "text",
    [
        KEY,
        KEY.splitlines(),
        "lt-11: tank; LT 11 → LIC-11 → FIC-12; FT12 in the outlet pipe; FT-12 --> FIC-12; FIC12 -pneumatic-> FV-12; "
        "FV12 acts on outlet; lt11 -> lah11",
        "1. vessel -> LT11 -> LC11 -> FC12\n2. FC12 ~> FV12 -> outlet\n3. FT12 -> outlet, FT12 -> FC12\n"
        "4. LT11 -> LAH11",
        "LT11 -(electrical)-> LC11; LC11 -> FC12; FC12 -//-> FV12; outlet -> FV12; outlet -> FT12 -> FC12; "
        "LT11 measures vessel; LT11 -> LAH11",
        "vessel -> LT11 -> LC11, LAH11\nLC11 -> FC12 - // -> FV12 -> outlet\nFC12 <- FT12 <- outlet",
        "vessel → lt11 → lc11 → fc12 ⫽→ fv12 → outlet; fc12 ← ft12 ← outlet; lah11 <- lt11",
        "vessel -> LT11 -> LC11 -> FC12 (setpoint)\noutlet <- FV12 <-//- FC12\n"
        "outlet -> FT12 -> FC12 (measurement)\nLT11 -> LAH11",
        [
            ("vessel", "LT11"),
            ("LT11", "LC11"),
            ("LC11", "FC12"),
            ("FC12", "FV12", "pneumatic"),
            ("FV12", "outlet"),
            ("outlet", "FT12"),
            ("FT12", "FC12"),
            ("LT11", "LAH11"),
        ],
        changed("-//-> FV12", "-> FV12 (pneumatic)\nFV12"),
    ],
)
def test_diagrams_in_many_forms_are_right(text):
    assert judge("diagram", KIND, text).status == RIGHT, judge("diagram", KIND, text)
    answer, _ = KIND.read(text)
    assert KIND.read(answer) == (answer, "")


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (changed("\nLT11 -> LAH11"), "something is missing: there is no high level alarm in loop 11"),
        (changed("LAH11", "LAL11"), "LAL11 reacts when the level is low: is that the side of the text?"),
        (changed("FV12", "LV12"), "LV12 begins with L, for level: a valve has the letter of what its loop controls"),
        (changed("FT12", "PT12"), "PT12 begins with P, for pressure: is that what is to be measured?"),
        (changed("12", "11"), "FC11 has the number 11: which loop does it belong to"),
        (changed("outlet -> FT12", "FT12"), "nothing says where FT12 measures"),
        (changed("FV12 -> outlet", "FV12"), "nothing says where FV12 acts"),
        (changed("outlet -> FT12", "inlet -> FT12"), "FT12 is in the wrong place, 'inlet': which flow is meant?"),
        (changed("FV12 -> outlet", "FV12 -> inlet"), "FV12 is in the wrong place, 'inlet': which flow should"),
        (changed("FV12 -> outlet", "outlet"), "something is missing: there is no flow valve in loop 12"),
        (changed("LC11 -> FC12 -//-> FV12", "LC11 -//-> FV12"), "LC11 should not act on FV12 itself"),
        (KEY.replace("LT11 -> LC11", "LT11; LC11 -> LT11; LC11"), "the signal between LT11 and LC11 goes the other"),
        (changed("FC12\nLT11", "FC12 -> LC11\nLT11"), "the signal between LC11 and FC12 goes the other way"),
        (changed("LT11 -> LC11 -> FC12", "LT11 -> FC12; LC11 -> FC12"), "LT11 is connected to FC12: is the level"),
        (changed("outlet -> FT12 -> FC12", "outlet -> FT12 -> FV12"), "FT12 is connected to FV12 itself: what"),
        (changed("FT12 -> FC12", "FT12"), "FC12 has no measurement: no signal of FT12 comes to it"),
        (changed("LC11 -> FC12", "LC11; FC12"), "nothing connects LC11 and FC12"),
        (changed("FC12 -//-> FV12", "FC12; FV12"), "FC12 acts on nothing: its signal does not come to FV12"),
        (changed("LT11 -> LAH11", "LC11 -> LAH11"), "LC11 is connected to LAH11, which is not asked"),
        (changed("-//->", "->"), "the signal from FC12 to FV12 is electrical in your diagram"),
        (KEY + "\nLT11 -> LI11", "LI11 is not asked for: the text names no level indicator in loop 11"),
        (KEY + "\nLC11 -> vessel", "LC11 acts on 'vessel' itself: what moves there?"),
    ],
)
def test_what_is_wrong_is_named(text, says):
    found = judge("diagram", KIND, text)
    assert found.status == WRONG
    assert says in found.says
    assert "\n" not in found.says


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("vessel -> LT -> LC", "connection 1, .*: LT has no number: expected that of its loop, as in LT101"),
        ("vessel -> BT11", "connection 1, .*: BT11 begins with B, which has no meaning in a tag"),
        ("the level is measured", "connection 1, .*: there is no arrow"),
        ("vessel -> LT11\nboiler -> TT12", "connection 2, .*: 'boiler' is neither a tag nor a place"),
        ("inlet -> vessel", "connection 1, .*: inlet and vessel are both parts of the process"),
        ("LT11 -> LT-11", "connection 1, .*: LT11 is connected to itself"),
        (KEY + "\nFC12 -> FV12", "the signal from FC12 to FV12 is of two kinds: expected one of them"),
        (KEY + "\nFC12 -//-> FV12 (electrical)", "connection 4, .*: its arrow is that of a pneumatic signal"),
        ("", "the diagram is empty"),
        ("vessel -> LT11 " * 400, "the text is very long"),
        (3, "this is not a diagram: expected connections such as"),
    ],
)
def test_what_cannot_be_read_is_said(text, message):
    found = judge("diagram", KIND, text)
    assert found.status == UNJUDGED
    assert re.search(message, found.says), found.says


@pytest.mark.parametrize(
    "text",
    [
        KEY,
        changed("FV12 -> outlet", "FV12 -> inlet"),
        changed("outlet -> FT12", "inlet -> FT12"),
        "vessel -> LT11 -> FV12",
        "vessel -> LT11 -> FV12 -> vessel",
        "LC1 -> LC2 -> LC3 -> LC1",
        "inlet -> FT1 -> FT2; outlet -> FT2",
        "inlet -> FT1 -> FC1 -> FV1 -> inlet; outlet -> FT2 -> FC2 -> FV2 -> outlet; FT1 -> FC2; FT2 -> FC1",
        "vessel -> LT1 -> LC1 -> LV1 -> outlet; vessel -> PT2 -> PC2 -> PV2 -> inlet; vessel -> TT3 -> TI3",
        "TV1 -> TC1 -> TT1 -> vessel",
        "LC1 -> vessel",
        "FC1 -> outlet; FT1 -> FC1",
    ],
)
def test_every_diagram_can_be_drawn(text):
    picture = KIND.picture(KIND.read(text)[0])
    assert picture.png()[:4] == b"\x89PNG"
    for one in connections(KIND.read(text)[0]):
        for name in (one.start, one.end):
            assert name in picture.alt or name in KIND.places


def test_every_response_has_its_picture():
    exercise = next(one for one in bank.exercises("A").values() if "diagram" in one.question().key)
    question = exercise.question("Ada")
    kind = question.key["diagram"]
    for diagram in (kind.key, *(wrong for _, wrong in question.mistakes["diagram"])):
        [picture] = question.check(diagram=diagram).pictures
        assert picture.png()[:4] == b"\x89PNG"
