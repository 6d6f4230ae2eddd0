"""Sliders: what a function shows, again at each move. The sliders carry words and units, and a page without a kernel
shows the first picture."""

from __future__ import annotations

import html
import inspect
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from loopbook.figures import Picture
from plainmath.tables import marked

if TYPE_CHECKING:
    from ipywidgets import Widget

__all__ = ["sliders"]

Shown = TypeVar("Shown", bound=Callable[..., Any])


def sliders(labels: Mapping[str, Any]) -> Callable[[Shown], Shown]:
    """Show what the function below returns, with a slider for each of its parameters.

    Arguments:
        labels: the words beside each slider, such as ``"filter [s]"``, and its range, in the order of the function's
            parameters. A range is (least, greatest, step), a list to choose from, True or False for a box to tick, or
            a widget of ipywidgets. The sliders begin at the function's defaults.
    Returns:
        A decorator. The function may return a figure, a table, a text, or a list of such. Where no kernel runs, the
        first of its figures is seen.
    Raises:
        TypeError: if the function has not one parameter for each label.
        ValueError: if a range is none.

    >>> from loopbook.figures import time_plot
    >>> from loopbook.transfer import first_order, step_response
    >>> @sliders({"time constant [s]": (1, 10, 0.5)})
    ... def lag(T=5):
    ...     return time_plot({"$y$": step_response(first_order(1, T))}, range(30))
    """

    def shown(function: Shown) -> Shown:
        from IPython import get_ipython
        from IPython.display import display
        from ipywidgets import HTML, VBox

        parameters = inspect.signature(function).parameters
        if len(parameters) != len(labels):
            raise TypeError(
                f"{function.__name__} has {len(parameters)} parameters, and there are {len(labels)} sliders: "
                "expected one for each"
            )
        controls = {
            name: _control(label, given, parameter.default)
            for (name, parameter), (label, given) in zip(parameters.items(), labels.items(), strict=True)
        }
        first = function(**{name: control.value for name, control in controls.items()})
        view = HTML(_seen(first))

        def moved(_):
            try:
                view.value = _seen(function(**{name: control.value for name, control in controls.items()}))
            except Exception as problem:  # a reader sees it in its place, and moves the slider on
                view.value = f"<p>{html.escape(f'{type(problem).__name__}: {problem}')}</p>"

        for control in controls.values():
            control.observe(moved, "value")
        if get_ipython() is not None:
            picture = next((part for part in _parts(first) if isinstance(part, Picture)), None)
            data, metadata = picture._repr_mimebundle_() if picture else ({"text/plain": str(first)}, {})
            widget = VBox([*controls.values(), view])._repr_mimebundle_()
            display(widget | data, metadata=metadata, raw=True)
        return function

    return shown


def _control(label: str, given: Any, default: Any) -> Widget:
    """A slider, a list, a box, or the widget itself, with its label."""
    from ipywidgets import ValueWidget
    from ipywidgets.widgets.interaction import interactive

    if isinstance(given, bool) and isinstance(default, bool):
        given = default
    if isinstance(given, tuple) and isinstance(default, float):
        given = tuple(map(float, given))  # a slider of whole numbers would begin at another one
    control = given if isinstance(given, ValueWidget) else interactive.widget_from_abbrev(given, default)
    if control is None:
        raise ValueError(
            f"no slider for {label!r} can be made of {given!r}: expected (least, greatest, step), or a list"
        )
    control.description = label
    control.style.description_width = "14em"
    control.layout.width = "34em"
    control.layout.max_width = "100%"
    if "readout_format" in control.traits() and "step" in control.traits() and isinstance(control.step, float):
        control.readout_format = f".{max(map(_decimals, (control.step, *np.ravel(control.value))))}f"
    return control


def _decimals(number: float) -> int:
    """How many decimals a number needs.

    >>> _decimals(0.5), _decimals(2.0)
    (1, 0)
    """
    return len(f"{number:f}".rstrip("0").partition(".")[2])


def _parts(shown: Any) -> list[Any]:
    return list(shown) if isinstance(shown, list | tuple) else [shown]


def _seen(shown: Any) -> str:
    """What a function returned, as HTML."""
    return "\n".join(map(_part, _parts(shown)))


def _part(part: Any) -> str:
    if isinstance(part, Picture):
        data, metadata = part._repr_mimebundle_()
        width = metadata["image/png"]["width"]
        text = html.escape(part.alt)
        picture = f"data:image/png;base64,{data['image/png']}"
        return f'<img class="loopbook-figure" src="{picture}" alt="{text}" width="{width}" style="max-width:100%">'
    if isinstance(part, str):
        return f"<p>{marked(part)}</p>"
    if hasattr(part, "_repr_html_"):
        return part._repr_html_()
    return f"<pre>{html.escape(repr(part))}</pre>"
