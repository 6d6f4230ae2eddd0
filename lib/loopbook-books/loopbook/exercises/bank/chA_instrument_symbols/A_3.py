"""The loops of exercise A.3."""

from loopbook import instruments
from loopbook.exercises import authoring


def number_of_loop(key):
    """The number of the loop that only shows its quantity."""
    return authoring.number(key, "", "the number of the loop that is only watched", within=0)


def loops(first, places):
    """The numbers of the loops at these places from 1, in their order."""
    return [str(first + place - 1) for place in sorted(places)]


def others(*these):
    """The places of the other loops."""
    return [place for place in range(1, 5) if place not in these]


def tags_of(first, watched, lacking):
    """The tags of four loops, sorted by their kinds: one loop only shows its quantity, and one lacks its valve."""
    four = [(letter, int(first) + n, n + 1) for n, letter in enumerate("FTLP")]
    tags = [f"{letter}T{loop}" for letter, loop, n in four]
    tags += [f"{letter}I{loop}" for letter, loop, n in four if n == watched]
    tags += [f"{letter}IC{loop}" for letter, loop, n in four if n != watched]
    tags += [f"{letter}AH{loop}" for letter, loop, n in four if n in (watched, 3)]
    return tags + [f"{letter}V{loop}" for letter, loop, n in four if n not in (watched, lacking)]


def listed(tags, number=""):
    """The tags, or those of one loop, in a sentence."""
    return ", ".join(tag for tag in tags if tag.endswith(str(number)))


def by_number(tags, first):
    """The tags of each loop in a table."""
    rows = [f"| {n} | {listed(tags, n)} |" for n in range(int(first), int(first) + 4)]
    return "\n".join(["| loop | tags |", "|---|---|", *rows])


def having(tags, letters, none=""):
    """The loops with all these letters behind the first ones, and with none of others, as the library collects them."""
    found = {n: {part.letter for tag in loop for part in tag.parts[1:]} for n, loop in instruments.loops(tags).items()}
    return [n for n, own in found.items() if {*letters} <= own and not own & {*none}]
