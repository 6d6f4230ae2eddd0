"""Python beside the page of exercise 2.8."""

from exercisebook.parameters import written
from loopbook import diagrams as draw
from loopbook.exercises import authoring


def one_of(key, among, what):
    """One of some words."""
    return authoring.word(key, among, what)


def _parts(fault, m, D, K):
    """The numbers and signs of the inner and of the outer loop, and whether the sum is multiplied by the mass."""
    inner, outer = (K, D) if fault == "D and K interchanged" else (D, K)
    signs = ["+" if fault == wrong else "-" for wrong in ("sign of the damper", "sign of the spring")]
    return written(inner), written(outer), *signs, fault == "mass multiplied", written(m)


def formula_of(fault, m, D, K):
    """The formula of the diagram as a hand would write it."""
    inner, outer, of_v, of_y, is_multiplied, mass = _parts(fault, m, D, K)
    block = mass if is_multiplied else rf"\frac{{1}}{{{mass}}}"
    return rf"{block}\,(F {of_v} {inner}\,v {of_y} {outer}\,y)"


def in_words(fault, m, D, K):
    """The diagram in words."""
    inner, outer, of_v, of_y, is_multiplied, mass = _parts(fault, m, D, K)
    names = {"+": "plus", "-": "minus"}
    loops = f"{names[of_y]} {outer} times $y$, {names[of_v]} {inner} times $v$"
    way = f"{'multiplied' if is_multiplied else 'divided'} by {mass}"
    return f"$F$, {loops}, then {way}, then an integrator to $v$ and an integrator to $y$"


def seen_in(acceleration, K):
    """What the position does, by the formula of the diagram."""
    F, v, y = (next(one for one in acceleration.free_symbols if one.name == name) for name in "Fvy")
    of_F, of_v, of_y = (acceleration.expand().coeff(name) for name in (F, v, y))
    if of_y > 0:
        return "runs away to one side"
    if of_v > 0:
        return "oscillates more and more"
    return "settles at F/K" if -of_F / of_y == 1 / K else "settles elsewhere"


def picture(fault, m, D, K):
    """A block diagram: {diagram}."""
    inner, outer, of_v, of_y, is_multiplied, mass = _parts(fault, m, D, K)
    block = draw.multiplication(mass) if is_multiplied else draw.division(mass)
    braked = draw.feedback_loop([block, draw.integrator("0")], draw.multiplication(inner), sign=of_v)
    return draw.block_diagram(
        "F", draw.feedback_loop([braked, "v", draw.integrator("0")], draw.multiplication(outer), sign=of_y), "y"
    )
