"""Python beside the page of exercise A.5."""

from loopbook import diagrams as draw
from loopbook.instruments import decode


def tagged(quantity, letters, numbers):
    """The tags with these letters behind the first one, and one number or a number each; no letters are no tag."""
    numbers = numbers if isinstance(numbers, list) else [numbers] * len(letters)
    return [f"{quantity}{rest}{n}" for rest, n in zip(letters, numbers, strict=True) if rest]


def all_tags(quantity, n, alarm):
    """The tags of the loop and some that are almost right."""
    other = "L" if alarm == "H" else "H"
    right = ["T", "IC", "V", f"A{alarm}", f"S{2 * alarm}"]
    wrong = ["CI", "C", "VC", f"A{other}", f"{alarm}A", f"S{2 * other}", f"S{alarm}"]
    return sorted(tagged(quantity, right + wrong, n) + tagged(quantity, ["T", "V"], n + 1))


def solution_picture(transmitter, controller, valve, bell, switch):
    """The loop on a drawing: transmitter, controller in the control room, valve, alarm and switch."""
    layout = f"""
        in  tank  {transmitter}  {controller}  {bell}
        .   tank  {switch}  .     .
        .   1     P1   {valve}   out"""
    parts = {"tank": draw.tank(), "P1": draw.pump("P1"), valve: draw.control_valve(valve)}
    parts |= {controller: draw.instrument(controller, "panel"), bell: draw.instrument(bell, "panel", "shared")}
    wires = f"tank {transmitter} {controller} {valve}, {controller} {bell}, tank {switch} P1"
    return draw.instrumentation_diagram(layout, f"in tank 1 P1 {valve} out", wires, parts)


def are_read_as(tags, functions, n):
    """Whether the tags are read as these functions, and have the number."""
    return [" ".join(decode(tag).functions) for tag in tags] == functions and all(tag.endswith(str(n)) for tag in tags)


def limit_of(tag):
    """The letters of the limit."""
    return "".join(part.letter for part in decode(tag).at("limit"))
