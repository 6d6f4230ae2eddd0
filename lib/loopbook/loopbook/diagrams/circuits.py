"""Circuits of resistors, capacitors and inductors, with their currents and voltages."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING

from loopbook.diagrams.drawing import Drawing, mathematics, text_size, wording

if TYPE_CHECKING:
    from loopbook.figures import Picture


def rc_circuit(resistor: str = "R", capacitor: str = "C", title: str | None = None) -> Picture:
    """Draw an RC circuit, from the voltage v_in at its left to the voltage v_out at its right.

    Arguments:
        resistor, capacitor: mathematics at the components.
        title: written above the circuit.
    Returns:
        A `Picture`, which a notebook shows as the value of a cell.

    >>> rc_circuit(title="Figure 3.19")
    <Figure 3.19: RC circuit: v_in over the resistor R, with voltage v_R and current i, and the capacitor C; v_out over C>
    """  # noqa: E501
    drawing = Drawing()
    _component(drawing, "Resistor", (1, 2.6), (4.6, 2.6), resistor, "v_R", "i")
    _component(drawing, "Capacitor", (5.6, 2.6), (5.6, 0), capacitor, current="i_C")
    for points in (((0, 2.6), (1, 2.6)), ((4.6, 2.6), (8, 2.6)), ((0, 0), (8, 0))):
        drawing.wire(*points)
    drawing.dot(5.6, 2.6)
    drawing.dot(5.6, 0)
    _terminals(drawing, 0, "v_{in}")
    _terminals(drawing, 8, "v_{out}")
    words = (
        f"RC circuit: v_in over the resistor {resistor}, with voltage v_R and current i, and the capacitor "
        f"{capacitor}; v_out over {capacitor}"
    )
    return drawing.picture(title, words)


def voltage_divider(
    upper: Sequence[str],
    lower: Sequence[str],
    in_series: bool = False,
    title: str | None = None,
    voltages: Mapping[str, str] | None = None,
) -> Picture:
    """Draw a circuit of resistors and capacitors between an input voltage, at its left, and an output voltage.

    Arguments:
        upper: names of the components that lead from the input to the output, beside one another; a name that begins
            with C is a capacitor, any other one a resistor.
        lower: names of the components that lead from the output to ground.
        in_series: whether these follow one another, from the top down, instead of being side by side.
        title: written above the circuit.
        voltages: ``{component: voltage}``, each mathematics beside its component, between its signs.
    Returns:
        A `Picture`, which a notebook shows as the value of a cell.

    >>> voltage_divider(["R_1"], ["R_2", "C"], in_series=True)
    <circuit: R_1 from v_in to v_out; R_2, then C, from v_out to ground>
    """
    drawing, top, voltages = Drawing(), 4.2 if in_series else 2.6, voltages or {}
    pitch = 2.1 if voltages else 1.5
    for n, name in enumerate(upper):
        y = top + pitch * n
        _component(drawing, _kind(name), (1.2, y), (4.4, y), name, voltages.get(name, ""))
    for x in (1.2, 4.4) if len(upper) > 1 else ():
        drawing.wire((x, top), (x, top + pitch * (len(upper) - 1)))
        drawing.dot(x, top)
    levels = [top * (1 - k / len(lower)) for k in range(len(lower) + 1)] if in_series else [top, 0.0]
    places = [5.8] * len(lower) if in_series else [5.8 + (2.8 if voltages else 1.9) * k for k in range(len(lower))]
    for k, (name, x) in enumerate(zip(lower, places, strict=True)):
        start, end = (levels[k], levels[k + 1]) if in_series else (levels[0], levels[1])
        _component(drawing, _kind(name), (x, start), (x, end), name, voltages.get(name, ""))
    right = places[-1] + 1.6
    drawing.wire((0, top), (1.2, top))
    drawing.wire((4.4, top), (right, top))
    drawing.wire((0, 0), (right, 0))
    for x in dict.fromkeys(places):
        drawing.dot(x, top)
        drawing.dot(x, 0)
    _terminals(drawing, 0, "v_{in}", top)
    _terminals(drawing, right, "v_{out}", top)
    names = (", then " if in_series else " beside ").join(lower)
    return drawing.picture(
        title, f"circuit: {' beside '.join(upper)} from v_in to v_out; {names}, from v_out to ground"
    )


def current_loop(inputs: Sequence[str], wire: str = "R_w", source: str = "I", title: str | None = None) -> Picture:
    """Draw a loop in which a current goes through one wire of a cable, through all inputs, and back through the other.

    Arguments:
        inputs: names of the resistors at the far end, one behind the other.
        wire: the resistance of each of the two wires.
        source: words or mathematics at what drives the current.
        title: written above the circuit.
    Returns:
        A `Picture`, which a notebook shows as the value of a cell.
    Raises:
        ValueError: without an input.

    >>> current_loop(["R_1", "R_2"])
    <circuit: I drives a current through a wire R_w, then R_1, then R_2, and back through a wire R_w>
    """
    if not inputs:
        raise ValueError("a current loop has one input or more")
    drawing, top, right = Drawing(), 2.6 * len(inputs), 7.0
    width = max(1.5, text_size(wording(source))[0] + 0.5)
    drawing.box(-width / 2, top / 2, width, 1.5, wording(source))
    for y, rim in ((top, top / 2 + 0.75), (0, top / 2 - 0.75)):
        drawing.wire((0, rim), (0, y), (1.6, y))
        drawing.wire((5.4, y), (right, y))
        _component(drawing, "Resistor", (1.6, y), (5.4, y), wire)
    drawing.wire((0, top), (0.9, top), arrow="->")
    for k, name in enumerate(inputs):
        _component(drawing, "Resistor", (right, top - 2.6 * k), (right, top - 2.6 * (k + 1)), name)
    middle = ", ".join(f"then {name}" for name in inputs)
    words = f"circuit: {source} drives a current through a wire {wire}, {middle}, and back through a wire {wire}"
    return drawing.picture(title, words)


def _kind(name):
    return "Capacitor" if name.startswith("C") else "Resistor"


def two_terminal_components(title: str | None = None) -> Picture:
    """Draw a resistor, a capacitor and an inductor, each with its current, its voltage and the law between them.

    >>> two_terminal_components(title="Figure 3.18").alt
    'Figure 3.18: resistor R: v = R i; capacitor C: i = C dv/dt; inductor L: v = L di/dt'
    """
    drawing = Drawing()
    laws = {"Resistor": "v=Ri", "Capacitor": r"i=C\,\frac{dv}{dt}", "Inductor2": r"v=L\,\frac{di}{dt}"}
    for n, ((kind, law), letter) in enumerate(zip(laws.items(), "RCL", strict=True)):
        x = 4.6 * n
        _component(drawing, kind, (x, 0), (x + 3.4, 0), letter, "v", "i")
        drawing.text(x + 1.7, -1.7, mathematics(law))
    return drawing.picture(title, "resistor R: v = R i; capacitor C: i = C dv/dt; inductor L: v = L di/dt")


def resistor_combinations(title: str | None = None) -> Picture:
    """Draw two resistors in series and in parallel, and the one resistor that does the same.

    >>> resistor_combinations(title="Figure 3.17").alt[:54]
    'Figure 3.17: R_1 and R_2 in series equal R_1 + R_2; in'
    """
    drawing = Drawing()
    _component(drawing, "Resistor", (0, 0), (2.6, 0), "R_1")
    _component(drawing, "Resistor", (2.6, 0), (5.2, 0), "R_2")
    for side, name in ((0.8, "R_1"), (-0.8, "R_2")):
        drawing.wire((0.7, -3), (0.7, -3 + side))
        _component(drawing, "Resistor", (0.7, -3 + side), (4.5, -3 + side), name)
        drawing.wire((4.5, -3), (4.5, -3 + side))
    for x, out in ((0.7, 0), (4.5, 5.2)):
        drawing.wire((x, -3), (out, -3))
        drawing.dot(x, -3)
    for y, law in ((0, "R_{series}=R_1+R_2"), (-3, r"R_{parallel}=\frac{R_1R_2}{R_1+R_2}")):
        drawing.text(6, y, r"$\Leftrightarrow$", size=18)
        _component(drawing, "Resistor", (6.8, y), (10.6, y), law)
        for x in (0, 5.2, 6.8, 10.6):
            drawing.circle(x, y, 0.07)
    return drawing.picture(title, "R_1 and R_2 in series equal R_1 + R_2; in parallel they equal R_1 R_2/(R_1 + R_2)")


def kirchhoff_laws(title: str | None = None) -> Picture:
    """Draw a junction of currents and a loop of voltages, with the law for each.

    >>> kirchhoff_laws(title="Figure 3.16").alt[:58]
    'Figure 3.16: currents i_1, i_2, i_3 into a junction, with '
    """
    drawing = Drawing()
    for n, (x, y) in enumerate(((-1.8, 0), (1.3, 1.3), (1.3, -1.3)), 1):
        drawing.wire((x, y), (0, 0))
        drawing.wire((x, y), (0.45 * x, 0.45 * y), arrow="->")
        drawing.text(0.6 * x - (0 if n == 1 else 0.3), 0.6 * y + (0.15 if n < 3 else -0.15), f"$i_{n}$",
                   halign="center" if n == 1 else "right", valign="bottom" if n < 3 else "top")  # fmt: skip
    drawing.dot(0, 0)
    drawing.text(-0.2, -2.2, "$i_1+i_2+i_3=0$")
    corners = [(4, -1.3), (4, 1.3), (8.4, 1.3), (8.4, -1.3)]
    for n, (start, end) in enumerate(pairwise(corners), 1):
        _component(drawing, "ResistorIEC", start, end, "", f"v_{n}")
    drawing.wire(corners[3], corners[0])
    drawing.arc(6.2, 0, 1.2, 1.2, 130, 40, arrow="cw")
    drawing.text(6.2, -2.2, "$v_1+v_2+v_3=0$")
    words = (
        "currents i_1, i_2, i_3 into a junction, with the sum 0; voltages v_1, v_2, v_3 around a loop, with the sum 0"
    )
    return drawing.picture(title, words)


def _component(drawing, kind, start, end, label, voltage="", current=""):
    """A two-terminal component: its letter on one side, the voltage on the other, the current at its first wire."""
    from schemdraw import elements

    drawing.schemdraw.add(getattr(elements, kind)().at(start).to(end))
    (x0, y0), (x1, y1) = start, end
    x, y = (x0 + x1) / 2, (y0 + y1) / 2
    if x0 == x1:
        if label:
            drawing.text(x - 0.75, y, mathematics(label), halign="right")
        signs = [(x - 0.4, y + (0.9 if y1 < y0 else -0.9)), (x - 0.4, y - (0.9 if y1 < y0 else -0.9))]
        place, name = (x - 0.75 if not label else x + 0.75, y), {"halign": "right" if not label else "left"}
    else:
        if label:
            drawing.text(x, y + 0.52 + text_size(mathematics(label))[1] / 2, mathematics(label))
        signs = [(x - 0.9, y - 0.4), (x + 0.9, y - 0.4)]
        place, name = (x, y - 0.4), {"valign": "top"}
    if voltage:
        for (across, up), sign in zip(signs, "+-", strict=True):
            drawing.text(across, up, f"${sign}$")
        drawing.text(*place, mathematics(voltage), **name)
    if current:
        at = 0.12
        drawing.wire(
            start, (x0 + at * (x1 - x0) + 0.15 * (x1 > x0), y0 + at * (y1 - y0) - 0.15 * (y1 < y0)), arrow="->"
        )
        if x0 == x1:
            drawing.text(x0 + 0.15, y0 - 0.35, mathematics(current), halign="left")
        else:
            drawing.text(x0 + 0.3, y0 + 0.15, mathematics(current), valign="bottom")


def _terminals(drawing, x, voltage, top=2.6):
    for y in (top, 0):
        drawing.circle(x, y, 0.08)
    drawing.text(x, top - 0.4, "$+$")
    drawing.text(x, top / 2, mathematics(voltage))
    drawing.text(x, 0.4, "$-$")
