"""Sliders: labels, ranges, the first picture, and what a reader sees when the function fails."""

import pytest
from ipywidgets import Checkbox, Dropdown, FloatSlider, IntSlider

from loopbook import sliders as module
from loopbook.figures import time_plot
from loopbook.sliders import sliders


@pytest.fixture
def shown(monkeypatch):
    """What is displayed where a kernel runs: pairs of data and metadata, and the boxes of widgets."""
    import IPython
    import ipywidgets

    found = []
    boxes = []
    monkeypatch.setattr(IPython, "get_ipython", lambda: object())
    monkeypatch.setattr(IPython.display, "display", lambda data, metadata, raw: found.append((data, metadata)))
    box = ipywidgets.VBox
    monkeypatch.setattr(ipywidgets, "VBox", lambda parts: boxes.append(box(parts)) or boxes[-1])
    return found, boxes


def picture(T=5):
    return time_plot({"$y$": [0, 1, T]}, [0, 1, 2], f"T = {T}")


def test_the_stored_output_has_the_first_picture_and_the_widget(shown):
    sliders({"time constant [s]": (1, 10, 1)})(picture)
    ((data, metadata),) = shown[0]
    assert {"image/png", "application/vnd.jupyter.widget-view+json"} <= set(data)
    assert "T = 5" in metadata["image/png"]["alt"]


def test_sliders_carry_words_units_and_decimals(shown):
    @sliders({"gain [%/%]": (0.05, 1, 0.05), "steps": (1, 9, 1), "method": ["PI", "PID"], "anti wind-up": True})
    def f(K=0.5, n=3, method="PID", on=False):
        return f"{K} {n} {method} {on}"

    *controls, view = shown[1][0].children
    assert [type(c) for c in controls] == [FloatSlider, IntSlider, Dropdown, Checkbox]
    assert [c.description for c in controls] == ["gain [%/%]", "steps", "method", "anti wind-up"]
    assert controls[0].readout_format == ".2f"
    assert view.value == "<p>0.5 3 PID False</p>"


def test_a_start_between_the_steps_is_shown_as_it_is(shown):
    sliders({"zero": (0, 4, 1)})(lambda zero=0.5: f"{zero}")
    assert shown[1][0].children[0].readout_format == ".1f"


def test_a_move_shows_what_the_function_returns_then(shown):
    sliders({"T [s]": (1, 10, 1)})(picture)
    slider, view = shown[1][0].children
    before = view.value
    slider.value = 8
    assert "T = 8" in view.value != before


def test_an_error_after_a_move_is_said_in_place_and_the_first_one_is_raised(shown):
    @sliders({"x": (0, 2, 1)})
    def f(x=1):
        return f"{1 / x}"

    slider, view = shown[1][0].children
    slider.value = 0
    assert "ZeroDivisionError" in view.value
    slider.value = 2
    assert view.value == "<p>0.5</p>"
    with pytest.raises(ZeroDivisionError):
        sliders({"x": (0, 2, 1)})(lambda x=0: 1 / x)


def test_each_parameter_has_a_slider_and_each_range_is_one():
    with pytest.raises(TypeError, match="picture has 1 parameters, and there are 2 sliders"):
        sliders({"a": (0, 1, 1), "b": (0, 1, 1)})(picture)
    with pytest.raises(ValueError, match="no slider for 'T'"):
        sliders({"T": object()})(picture)


def test_several_pictures_and_tables_are_shown_under_each_other():
    from plainmath.tables import quantities

    seen = module._seen([picture(), quantities(K=2), "<b>"])
    assert seen.count("<img") == 1
    assert "<table" in seen
    assert "&lt;b&gt;" in seen
