"""English as an engineer writes it: no text has the worst words of the list in docs/contributors.md."""

import io
import re
import tokenize
import tomllib
from pathlib import Path

import nbformat
import pytest

ROOT = Path(__file__).parents[2]
FOLDERS = ("chapters", "solutions", "lib", "docs", "examples")

#: What nobody writes here, each with what is written instead.
INSTEAD = {
    r"(time|response|delay|rise|settling)-(constant|time)s?": "time constant, response time: two words",
    r"(?<!-)dead-times?(?=[.,;:)]| (is|are|of|and|in|from)\b)": "dead time; dead-time only before a noun",
    r"left away": "omitted, neglected",
    r"pass(es|ed|ing)? over": "skipped",
    r"(is|are|be) had|to be had": "can be found, is available",
    r"a (notebook|page) an? (student|reader)|an? (line|row|cell|column|name) each": "one notebook per student",
    r"(stands?|stood) (above|below|beside|before|behind|between)": "is above, is shown beside",
    r"(loop|level|output|response|temperature|pressure|it|that) swings": "oscillates, overshoots",
    r"in the mean(?=[.,;:?)]| (as|it|and)\b)|on the average": "on average",
    r"infinitely often|for ever": "infinitely many, forever",
    r"that there is not|that there are not": "that does not exist, unknown",
    r"shall": "should, must, will",
}


def said(code):
    """The strings and comments of a module or of a cell."""
    kinds = {tokenize.STRING, tokenize.COMMENT, getattr(tokenize, "FSTRING_MIDDLE", tokenize.STRING)}
    return "\n".join(
        token.string for token in tokenize.generate_tokens(io.StringIO(code).readline) if token.type in kinds
    )


def notebook(text):
    cells = nbformat.reads(text, as_version=4).cells
    return "\n".join(cell.source if cell.cell_type == "markdown" else said(cell.source) for cell in cells)


def ledger(text):
    """What a ledger says in our words: not what a book prints."""

    def ours(entry):
        for key, value in entry.items():
            if isinstance(value, str) and key not in {"printed", "correct", "citation"}:
                yield value
            for inner in [value] if isinstance(value, dict) else value if isinstance(value, list) else []:
                yield from ours(inner) if isinstance(inner, dict) else ()

    return "\n".join(ours(tomllib.loads(text)))


def guide(text):
    """A page without the list of words."""
    return re.sub(r"\n## Words\n.*?(?=\n## )", "", text, flags=re.DOTALL)


READ = {".ipynb": notebook, ".py": said, ".toml": ledger, ".md": guide}
TEXTS = [
    *ROOT.glob("*.md"),
    *(path for folder in FOLDERS for path in ROOT.glob(f"{folder}/**/*") if path.suffix in READ),
]
TEXTS = [path for path in TEXTS if not {"_build", ".ipynb_checkpoints", "__pycache__"} & {*path.parts}]


def complaints(text):
    text = " ".join(text.split())
    return [
        f"{found[0]!r}: better {better} (in: {text[max(found.start() - 40, 0) : found.end() + 40]})"
        for words, better in INSTEAD.items()
        for found in re.finditer(rf"\b(?:{words})(?!\w)", text, re.IGNORECASE)
    ]


def test_no_text_uses_one_of_the_worst_words():
    found = [
        f"{path.relative_to(ROOT)}: {complaint}"
        for path in TEXTS
        for complaint in complaints(READ[path.suffix](path.read_text(encoding="utf-8")))
    ]
    assert not found, "\n".join(found)


@pytest.mark.parametrize(
    "sentence",
    [
        "A larger time-constant makes it slower.",
        "It has two lags and a dead-time.",
        "The small lag is left away.",
        "Such a step is passed over.",
        "A limit can be had for each of them, and is had here.",
        "They write a notebook a student.",
        "The rules are a line each.",
        "The gain stands\nbefore the fraction bar.",
        "With this gain the loop swings.",
        "Are they equal in the mean?",
        "It happens infinitely often.",
        "An error for a number that there is not.",
        "The loop shall be fast.",
    ],
)
def test_each_of_the_worst_words_is_found(sentence):
    assert complaints(sentence)


@pytest.mark.parametrize(
    "sentence",
    [
        "A second-order-plus-dead-time model, and a dead-time compensator.",
        "A scale stands on a spring. The pump stands still. $s$ stands for the derivative.",
        "How large is the second swing of the ship? A rise in the mean temperature.",
        "We had two of them.",
    ],
)
def test_what_an_engineer_writes_is_left_alone(sentence):
    assert not complaints(sentence)


def test_only_our_own_words_are_looked_at():
    assert complaints(ledger('["Example 1"]\nresult = [{ name = "x", claim = "The loop swings." }]'))
    assert not complaints(ledger('["Example 1"]\nmisprint = [{ printed = "time-constant" }]'))
    assert said("shall = 1  # a wish\nmust = 'a word'").split("\n") == ["# a wish", "'a word'"]
