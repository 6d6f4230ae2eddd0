"""A reader of Moodle's XML that marks an answer as Moodle does: Cloze questions by the patterns of its own parser.

Source: `question/type/multianswer/questiontype.php` and `question/type/numerical/question.php` of Moodle 4.5.
"""

import html
import re
import shutil
import subprocess
from dataclasses import dataclass
from xml.etree import ElementTree

_ALTERNATIVE = r"(=|%(-?[0-9]+(?:[.,][0-9]*)?)%)?(.+?(?<!\\|&)(?=[~#}]|$))(?:#(.*?(?<!\\)(?=[~}]|$)))?"
_BARE = re.sub(r"\((?!\?)", "(?:", _ALTERNATIVE)
_CELL = re.compile(rf"\{{([0-9]*):(NUMERICAL|MULTICHOICE):({_BARE}(?:~{_BARE})*)\}}", re.DOTALL)
_NUMBER = r"-?(?:[0-9]+[.,]?[0-9]*|[.,][0-9]+)(?:[eE][-+]?[0-9]+)?"
_WITH_TOLERANCE = re.compile(rf"({_NUMBER})(?::({_NUMBER}))?")


@dataclass
class Cell:
    """A cell, with its alternatives as (share, text, tolerance, sentence)."""

    weight: int
    type: str
    alternatives: list[tuple[float, str, float, str]]

    def mark(self, answer):
        """The share of its marks that an answer brings, and the sentence on it: the first that fits counts."""
        for share, text, tolerance, sentence in self.alternatives:
            if self.type == "MULTICHOICE" and text == answer:
                return share, sentence
            if self.type == "NUMERICAL":
                slack = 1e-14 * max(abs(float(text)), tolerance)
                if abs(float(answer) - float(text)) <= tolerance + slack:
                    return share, sentence
        return 0.0, ""


@dataclass
class Read:
    """A question of a file: its type, category and name, its text with ``{#1}`` for the first cell, and its cells."""

    type: str
    category: str
    name: str
    text: str
    cells: list[Cell]
    element: ElementTree.Element


def read(content):
    """The questions of a file; each keeps what Moodle demands of it."""
    category = ""
    for one in ElementTree.fromstring(content):
        if one.get("type") == "category":
            category = one.findtext("category/text")
            continue
        text, cells = one.findtext("questiontext/text"), []
        assert "{#" not in text
        files = {file.get("name") for file in one.findall("questiontext/file")}
        assert {*re.findall(r"@@PLUGINFILE@@/([^\"]+)", text)} == files
        while one.get("type") == "cloze" and (found := _CELL.search(text)):
            cells.append(_cell(found))
            text = text.replace(found[0], f"{{#{len(cells)}}}", 1)
        yield Read(one.get("type"), category, one.findtext("name/text"), text, cells, one)


def _cell(found):
    weight, kind, rest = found[1], found[2], found[3]
    alternatives, position = [], 0
    for one in re.finditer(f"~?{_ALTERNATIVE}", rest, re.DOTALL):
        assert one.start() == position, rest[position:]
        position = one.end()
        share = 100 if one[1] == "=" else float(one[2] or 0)
        text, tolerance = html.unescape(one[3]), 0.0
        if kind == "NUMERICAL":
            number = _WITH_TOLERANCE.fullmatch(one[3])
            assert number, one[3]
            assert "," not in one[3]
            text, tolerance = number[1], float(number[2] or 0)
        alternatives.append((share, text, tolerance, html.unescape(one[4] or "")))
    assert position == len(rest)
    assert any(share == 100 for share, *_ in alternatives)
    assert kind == "NUMERICAL" or len(alternatives) > 1
    return Cell(int(weight), kind, alternatives)


def has_maxima():
    """Whether there is a Maxima for `places`."""
    return bool(shutil.which("maxima"))


def places(element, tried):
    """What Maxima says of answers to a STACK question: for each its place among the known ones, 0 where it is none.

    Arguments:
        element: the question.
        tried: {number of a cell: answers as they are typed}.
    """
    lines = [element.findtext("questionvariables/text")]
    trees = element.findall("prt")
    for cell, answers in tried.items():
        code = trees[cell - 1].findtext("feedbackvariables/text")
        for typed in answers:
            lines += [f"ans{cell}: {typed};", code, f'print("is", place{cell});']
    program = "\n".join(["display2d: false;", *lines])
    said = subprocess.run(["maxima", "--very-quiet"], input=program, capture_output=True, text=True, check=True).stdout
    found = iter([int(one) for one in re.findall(r"^is (\d+)", said, re.MULTILINE)])
    return {cell: [next(found) for _ in answers] for cell, answers in tried.items()}
