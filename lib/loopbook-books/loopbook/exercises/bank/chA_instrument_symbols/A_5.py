"""The tags of exercise A.5."""

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


def functions(tags):
    """What each instrument does, and the number of its loop, as the library reads the tags."""
    return [f"{' '.join(decode(tag).functions)} {decode(tag).loop}" for tag in tags]
