"""The exercises of the chapters as forms of a page, with the fields of control engineering."""

import json

import pytest

from draws import of_the_day
from exercisebook.forms.fields import field_of
from exercisebook.kinds.kind import LINE, LINES, ONE, ORDER, PARTS, SEVERAL
from loopbook.exercises import bank, exercise
from loopbook.exercises.forms import Sheet, answer
from loopbook.exercises.kinds import Settings
from loopbook.pid import PID
from typed import Read, assert_is_whole, assert_tells_nothing, typed

NUMBERS = [number for chapter in bank.chapters() for number in bank.exercises(chapter)]


def checked(number, answers):
    return json.loads(answer(json.dumps({"do": "check", "exercise": number, "answers": answers})))


def test_the_keys_typed_in_the_fields_are_right():
    """Of each kind there are many: a quarter a day. That a key is right in every form is proved of every exercise."""
    for number in of_the_day(NUMBERS, len(NUMBERS) // 4, "typed"):
        answers = {name: typed(kind) for name, kind in Sheet(exercise(number)).question.key.items()}
        reply = checked(number, answers)
        assert reply.get("right"), (number, answers, reply)


def test_every_form_is_whole():
    for number in of_the_day(NUMBERS, len(NUMBERS) // 2, "forms"):
        assert_is_whole(Sheet(exercise(number, "Mira")))


def test_a_field_says_nothing_of_the_key_and_a_page_nothing_of_what_a_notebook_calls():
    for number in NUMBERS:
        assert "given(" not in Sheet(exercise(number)).text
        for name, kind in exercise(number).key.items():
            assert_tells_nothing(name, kind, field_of)


def test_a_kind_has_a_field_of_its_own():
    kinds = [kind for number in NUMBERS for kind in exercise(number).key.values()]
    controls = {getattr(kind, "example", kind).maker: field_of("x", kind).control for kind in kinds}
    assert controls.pop("words") in (SEVERAL, ORDER)
    fields = {
        LINE: "number numbers poles expression transfer_function time_function",
        ONE: "word",
        PARTS: "settings",
        LINES: "sequential_chart instrument_diagram",
    }
    for control, makers in fields.items():
        assert {controls[maker] for maker in makers.split()} == {control}


PI_2_10 = {"Kp": "2", "Ti": "10 min"}
TWO_STEPS = "Wait -> Fill: start\nFill: inlet on"


@pytest.mark.parametrize(
    ("number", "answers", "given"),
    [
        ("10.7", {"pid": PI_2_10 | {"Td": "", "form": "parallel"}}, {"pid": PI_2_10}),
        ("10.7", {"pid": {"Kp": "x", "Ti": "10"}}, {"pid": {"Kp": "x", "Ti": "10"}}),
        ("10.7", {"pid": "PI with K_c = 2 and tau_I = 10"}, {"pid": "PI with K_c = 2 and tau_I = 10"}),
        ("7.3", {"pid": {"Kp": "PID(1.25, 40)"}}, {"pid": {"Kp": "1.25", "Ti": "40"}}),
        ("13.2", {"poles": "-1 ± 2j"}, {"poles": "-1 ± 2j"}),
        ("12.9", {"chart": TWO_STEPS}, {"chart": TWO_STEPS}),
    ],
)
def test_what_is_typed_is_judged_as_in_a_notebook(number, answers, given):
    reply, response = checked(number, answers), exercise(number).check(**given)
    found = [(one["name"], one["status"], one["says"]) for one in reply["verdicts"]]
    assert found == [(one.name, one.status, one.says) for one in response.verdicts]


def test_what_a_controller_does_is_drawn():
    [drawn] = Read(checked("10.7", {"pid": {"Kp": "2", "Ti": "10"}})["html"]).all("img")
    assert drawn["alt"]
    assert drawn["src"].startswith("data:image/png;base64,")


def test_where_both_forms_of_a_controller_are_right_one_is_chosen():
    field = field_of("x", Settings(PID(2, Ti=3)))
    assert field.more["forms"] == ("parallel", "serial")
    assert field.help == "Leave empty what the controller does not have."
    assert "forms" not in field_of("x", Settings(PID(2, Ti=3), form="parallel")).more
