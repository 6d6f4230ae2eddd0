"""Machines as a textbook draws them: a conveyor belt, a mass on a spring, a motor with its load, a lift, a funnel."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from loopbook.diagrams.drawing import LIQUID, Drawing, mathematics

if TYPE_CHECKING:
    from loopbook.figures import Picture


def conveyor_belt(title: str | None = None) -> Picture:
    """Draw a conveyor belt, which turns an inflow into the same outflow some time later.

    Arguments:
        title: written above the drawing.
    Returns:
        A `Picture`, which a notebook shows as the value of a cell.

    >>> conveyor_belt(title="Figure 6.3")
    <Figure 6.3: conveyor belt: F_in falls on one end, F_out leaves the other end tau later>
    """
    drawing = Drawing()
    length, r = 8.4, 0.42
    drawing.wire((0, r), (length, r))
    drawing.wire((0, -r), (length, -r))
    for x in (0, length):
        drawing.circle(x, 0, r)
        drawing.dot(x, 0)
    # the layer of material, from where it falls to where it leaves, and the way that it goes
    end = [(length, r + 0.32), (length + 0.3, r + 0.18), (length + r, 0.1), (length, r)]
    drawing.area([(0.15, r), (0.45, r + 0.32), *end], fill=LIQUID)
    drawing.wire((length / 2 - 0.7, 0), (length / 2 + 0.7, 0), arrow="->")
    # the chute
    for side in (-1, 1):
        drawing.wire((0.45 + side * 0.75, 2.4), (0.45 + side * 0.25, 1.75), (0.45 + side * 0.25, 1.35))
    drawing.wire((0.45, 3.1), (0.45, r + 0.4), arrow="->")
    drawing.text(0.7, 3.0, r"$F_{\mathrm{in}}$", halign="left")
    drawing.wire((length + r + 0.1, -0.1), (length + r + 0.1, -1.5), arrow="->")
    drawing.text(length + r + 0.35, -1.1, r"$F_{\mathrm{out}}$", halign="left")
    # the time on the belt, as a dimension line
    for x in (0.45, length + r + 0.1):
        drawing.wire((x, -1.75), (x, -2.25), width=0.8)
    drawing.wire((0.45, -2), (length + r + 0.1, -2), arrow="<->", width=0.8)
    drawing.text((0.55 + length + r) / 2, -1.9, r"$\tau$", valign="bottom")
    return drawing.picture(title, "conveyor belt: F_in falls on one end, F_out leaves the other end tau later")


def mass_spring_damper(
    mass: str = "m",
    spring: str = "K",
    damper: str = "D",
    force: str = "F",
    position: str = "y",
    title: str | None = None,
    standing: bool = False,
) -> Picture:
    """Draw a mass that a spring and a damper hold to a wall and a force that pulls it, or one that stands on them.

    Arguments:
        mass, spring, damper, force, position: mathematics at the parts; no force is drawn where its name is empty.
        title: written above the drawing.
        standing: True for a mass on top of spring and damper, on which the force presses; its position counts down.
    Returns:
        A `Picture`, which a notebook shows as the value of a cell.

    >>> mass_spring_damper(title="Figure 2.4")
    <Figure 2.4: mass m on a wall by a spring K and a damper D, moved by the force F to the position y>
    >>> mass_spring_damper(standing=True)
    <mass m on the ground by a spring K and a damper D, moved by the force F to the position y>
    """
    drawing, near, far = Drawing(), 4.2, 5.7 if standing else 6.4

    def at(*points):  # standing, what is along the spring is upward
        return [(y, x) for x, y in points] if standing else points

    def parts(*points, **look):
        drawing.wire(*at(*points), **look)

    _wall(drawing, at)
    parts((0, 0.75), (0.7, 0.75))
    drawing.zigzag(*at((0.7, 0.75), (3.5, 0.75)), teeth=7, height=0.28)
    parts((3.5, 0.75), (near, 0.75))
    parts((0, -0.75), (1.6, -0.75))
    parts((2.6, -0.4), (1.6, -0.4), (1.6, -1.1), (2.6, -1.1))
    parts((2.2, -0.45), (2.2, -1.05), width=2.2)
    parts((2.2, -0.75), (near, -0.75))
    drawing.area(at((near, -1.3), (near, 1.3), (far, 1.3), (far, -1.3)), fill="white")
    drawing.text(*at(((near + far) / 2, 0))[0], mathematics(mass))
    if standing:
        drawing.text(1.25, 2.1, mathematics(spring), halign="left")
        drawing.text(-1.3, 2.1, mathematics(damper), halign="right")
        parts((far + 1.4, 0), (far, 0), arrow="->", width=1.7)
        drawing.text(0.2, far + 1.1, mathematics(force), halign="left")
        parts((far, 1.45), (far, 2.05), width=0.8)
        parts((far, 1.75), (far - 1.8, 1.75), arrow="->", width=0.8)
        drawing.text(2.15, far, "0", halign="left", size=10)
        drawing.text(1.95, far - 1.7, mathematics(position), halign="left")
    else:
        drawing.text(2.1, 1.2, mathematics(spring), valign="bottom")
        drawing.text(2.1, -1.25, mathematics(damper), valign="top")
        if force:
            parts((far, 0), (far + 1.6, 0), arrow="->", width=1.7)
            drawing.text(far + 1.2, 0.15, mathematics(force), valign="bottom")
        _axis(drawing, near, -1.45, 2.4, position)
    moved = f"moved by the force {force} to the position {position}" if force else f"at the position {position}"
    where = "the ground" if standing else "a wall"
    return drawing.picture(title, f"mass {mass} on {where} by a spring {spring} and a damper {damper}, {moved}")


def motor_with_load(title: str | None = None) -> Picture:
    """Draw a motor that moves a load along a line, by a gear and a rod.

    Arguments:
        title: written above the drawing.
    Returns:
        A `Picture`, which a notebook shows as the value of a cell.

    >>> motor_with_load(title="Figure 3.14")
    <Figure 3.14: a motor with current i_m and inertia J turns a gear wheel of radius r, which moves a rod with load m against the force F_L to the position y>
    """  # noqa: E501
    drawing, wheel, r = Drawing(), 4.6, 0.9
    drawing.wire((-1.4, 1.2), (0, 1.2), arrow="->")
    drawing.text(-0.8, 1.32, "$i_m$", valign="bottom")
    drawing.box(0, 1.2, 2, 1.5, "Motor")
    drawing.text(1, 2.05, "$J$", valign="bottom")
    for side in (-0.06, 0.06):
        drawing.wire((2, 1.2 + side), (wheel, 1.2 + side))
    # the load's torque acts against the turning
    for x, turning, name in ((2.4, "ccw", r"$\theta$"), (3.15, "cw", "$T_1$")):
        drawing.arc(x, 1.2, 0.4, 1.1, -70, 70, arrow=turning)
        drawing.text(x, 1.9, name, valign="bottom")
    # the wheel, its teeth and the rack, which is the upper side of the rod
    corners = []
    for n in range(40):
        turn, reach = 2 * math.pi * (n + 0.5) / 40, r + (0.07 if n % 4 < 2 else -0.07)
        corners.append((wheel + reach * math.cos(turn), 1.2 + reach * math.sin(turn)))
    drawing.area(corners, fill="white", zorder=3)
    drawing.circle(wheel, 1.2, 0.08, fill="black", zorder=4)
    drawing.wire((wheel, 1.2), (wheel + 0.62, 1.2 + 0.62), arrow="->", width=0.8, zorder=4)
    drawing.text(wheel + 0.45, 1.22, "$r$")
    top = 1.2 - r - 0.07
    drawing.area([(3.2, top - 0.35), (3.2, top), (8, top), (8, top - 0.35)], fill="white")
    drawing.wire((wheel - 0.2, top - 0.6), (wheel + 1.2, top - 0.6), arrow="->")
    drawing.text(wheel - 0.35, top - 0.6, "$F_1$", halign="right")
    drawing.box(8, top - 0.18, 1.5, 1.5, "$m$")
    drawing.wire((11.1, top - 0.18), (9.5, top - 0.18), arrow="->", width=1.7)
    drawing.text(10.5, top - 0.05, "$F_L$", valign="bottom")
    _axis(drawing, 8, top - 1.1, 2.4, "y")
    words = (
        "a motor with current i_m and inertia J turns a gear wheel of radius r, which moves a rod with load m against "
        "the force F_L to the position y"
    )
    return drawing.picture(title, words)


def hoist(
    left: str = "m_1", right: str = "m_2", inertia: str = "J", radius: str = "r", title: str | None = None
) -> Picture:
    """Draw two masses on the two ends of a rope over a drum, and the torque at the drum that lifts the left one.

    Arguments:
        left, right: mathematics at the two masses.
        inertia, radius: mathematics at the drum.
        title: written above the drawing.
    Returns:
        A `Picture`, which a notebook shows as the value of a cell.

    >>> hoist()
    <a rope over a drum of inertia J and radius r, with the masses m_1 on its left and m_2 on its right; the torque T lifts m_1 with a>
    """  # noqa: E501
    drawing, r = Drawing(), 1.5
    drawing.circle(0, 0, r)
    drawing.circle(0, 0, 0.08, fill="black", zorder=4)
    drawing.wire((0, 0), (0.7 * r, -0.7 * r), arrow="->", width=0.8, zorder=4)
    drawing.text(0.2, -0.75, mathematics(radius), halign="right")
    drawing.text(0, 0.6, mathematics(inertia))
    drawing.arc(0, 0, 2 * r + 0.7, 2 * r + 0.7, 55, 125, arrow="cw")
    drawing.text(0, r + 0.5, "$T$", valign="bottom")
    for x, length, mass, height in ((-r, 2.4, left, 1.7), (r, 1.7, right, 1.2)):
        drawing.wire((x, 0), (x, -length))
        drawing.box(x - 1.15, -length - height / 2, 2.3, height, mathematics(mass))
    drawing.wire((-r - 1.6, -4), (-r - 1.6, -2.5), arrow="->")
    drawing.text(-r - 1.8, -3.2, "$a$", halign="right")
    words = (
        f"a rope over a drum of inertia {inertia} and radius {radius}, with the masses {left} on its left and {right} "
        f"on its right; the torque T lifts {left} with a"
    )
    return drawing.picture(title, words)


def widening_tank(power: float, width: str = "R", outflow: str = "q_o", title: str | None = None) -> Picture:
    """Draw the section of a tank whose width grows with a power of the height, from a tip at its bottom.

    Arguments:
        power: 1 for straight walls, below it for a bowl, above it for a goblet.
        width: mathematics at half of the width of the rim, as a radius.
        outflow: mathematics at the arrow out of the tank.
        title: written above the drawing.
    Returns:
        A `Picture`, which a notebook shows as the value of a cell.
    Raises:
        ValueError: for a power that is not positive.

    >>> widening_tank(1)
    <section of a tank, at the height H of the half width R, with liquid up to h; q_i flows in, q_o out at the bottom>
    """
    if power <= 0:
        raise ValueError(f"the width grows with a power above zero of the height, not {power}")
    drawing, half, rim, surface = Drawing(), 2.0, 3.2, 2.0
    heights = [rim * n / 40 for n in range(41)]
    wall = [(half * (y / rim) ** power, y) for y in heights]
    wet = [(x, y) for x, y in wall if y <= surface]
    drawing.area([(-x, y) for x, y in reversed(wet)] + wet, fill=LIQUID, outline=0)
    drawing.wire((-wet[-1][0], surface), (wet[-1][0], surface), width=0.8)
    drawing.wire(*[(-x, y) for x, y in reversed(wall)], *wall, width=1.7)
    # the heights, as dimension lines
    for x, y, label in ((half + 0.5, surface, "$h$"), (half + 1.4, rim, "$H$")):
        drawing.wire((x, 0), (x, y), arrow="<->", width=0.8)
        drawing.wire((x - 0.2, y), (x + 0.2, y), width=0.8)
        drawing.text(x + 0.15, y / 2, label, halign="left")
    drawing.wire((half + 0.3, 0), (half + 1.6, 0), width=0.8)
    drawing.wire((0, rim + 0.3), (half, rim + 0.3), arrow="<->", width=0.8)
    for x in (0, half):
        drawing.wire((x, rim + 0.1), (x, rim + 0.5), width=0.8)
    drawing.text(half / 2, rim + 0.4, mathematics(width), valign="bottom")
    drawing.wire((-half - 1.2, rim + 0.9), (-0.6 * half, rim + 0.9), (-0.6 * half, rim - 0.3), arrow="->", width=1.7)
    drawing.text(-half - 0.7, rim + 1, "$q_i$", valign="bottom")
    drawing.wire((0, 0), (0, -0.5), (1.6, -0.5), arrow="->", width=1.7)
    drawing.text(1.1, -0.4, mathematics(outflow), valign="bottom")
    words = (
        f"section of a tank, at the height H of the half width {width}, with liquid up to h; q_i flows in, {outflow} "
        f"out at the bottom"
    )
    return drawing.picture(title, words)


def _wall(drawing, at):
    """A hatched wall at zero; `at` puts points where they belong."""
    drawing.wire(*at((0, -1.5), (0, 1.5)), width=1.7)
    for n in range(10):
        y = 3 * (n + 0.5) / 10 - 1.5
        drawing.wire(*at((0, y), (-0.3, y - 0.3)), width=0.8)


def _axis(drawing, x, y, length, label):
    """An arrow from zero in the direction in which a position is counted."""
    drawing.wire((x, y - 0.15), (x, y - 0.75), width=0.8)
    drawing.wire((x, y - 0.45), (x + length, y - 0.45), arrow="->", width=0.8)
    drawing.text(x - 0.12, y - 0.5, "0", halign="right", size=10)
    drawing.text(x + length + 0.15, y - 0.45, mathematics(label), halign="left")
