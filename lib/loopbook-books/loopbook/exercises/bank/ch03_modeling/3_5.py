"""Python beside the page of exercise 3.5."""

from exercisebook.parameters import written
from loopbook import diagrams as draw


def picture(m_1, m_2, J, r):
    """A rope over a drum of {J} with the radius {r}; on its left hangs the cabin of {m_1}, on its right the
    counterweight of {m_2}. The torque T lifts the cabin."""
    cabin, weight = f"${written(m_1)}$ kg", f"${written(m_2)}$ kg"
    return draw.hoist(cabin, weight, f"${written(J)}$ kg m²", f"${written(r)}$ m")
