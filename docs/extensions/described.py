"""What a page says of itself to catalogues of courses and to search engines: JSON-LD in the words of schema.org."""

import json
import re

import launch
import reading
import single_figures
import stored

import repository
from loopbook.ledger import sources

LICENCE = "https://creativecommons.org/licenses/by/4.0/"
COMMON = {
    "inLanguage": "en",
    "license": LICENCE,
    "author": {"@type": "Organization", "name": repository.AUTHORS},
    "version": repository.VERSION,
    "isAccessibleForFree": True,
    "educationalLevel": "undergraduate, third year",
    "about": ["process control", "control engineering"],
    "accessibilityFeature": ["alternativeText", "MathML", "structuralNavigation"],
}
BOOK = {"@type": "Book", "name": "loopbook"}
REFERENCE = re.compile(
    r"\s*\([^()]*\b(?:Sections?|Examples?|Exercises?|Tables?|Equations?|Figures?|chapters?)\b[^()]*\)"
)


def of_page(name, site=""):
    """Return what is said of a page, as a dictionary; nothing of pages that teach nothing by themselves.

    Arguments:
        name: of the page, as "chapters/10_tuning", or "index" for all of it.
        site: the address of the site, as "https://control.example.edu/book/"; empty where it is not known.

    >>> of_page("chapters/10_tuning")["timeRequired"][:2]
    'PT'
    """
    folder, _, chapter = name.partition("/")
    if name == "index":
        said = BOOK | {
            "@type": ["Book", "LearningResource"],
            "learningResourceType": ["textbook", "exercises", "interactive lessons"],
            "description": repository.PROJECT["description"],
            "teaches": re.findall(
                r"(?m)^\| \[.+\]\(chapters/.+\) \| (.+) \| .+ \|$", (stored.ROOT / "README.md").read_text("utf-8")
            ),
            "isBasedOn": [work(one) for one in sources().values()],
        }
        said |= {"codeRepository": repository.ADDRESS} if repository.ADDRESS else {}
    elif folder in stored.FOLDERS and chapter and f"{name}.ipynb" != launch.FIRST:
        cells = single_figures.cells_of(chapter)
        text = "\n".join(cell["source"] for cell in cells)
        names = re.findall(r"(?m)^from loopbook\.ledger import (.+)$", text)
        said = {
            "@type": ["Chapter", "LearningResource"] if folder == "chapters" else "LearningResource",
            "name": text.partition("\n")[0].removeprefix("# "),
            "learningResourceType": "chapter with exercises" if folder == "chapters" else "solutions of exercises",
            "timeRequired": f"PT{reading.minutes(cells)}M",
            "teaches": teaches(text),
            "isPartOf": BOOK,
            "isBasedOn": [work(sources()[one.strip()]) for line in names for one in line.split(",")],
        }
    else:
        return {}
    said |= {"url": f"{site}{name}.html"} if site else {}
    return {"@context": "https://schema.org"} | said | COMMON


def work(source):
    """A source of the ledger."""
    return {"@type": "CreativeWork", "name": source.title, "citation": source.citation}


def teaches(text):
    """The lines of "What you can do now", without the places where each thing was learned.

    >>> teaches("## What you can do now" + 2 * chr(10) + "- Tune a [loop](10_tuning.ipynb) by $K$ (Section 10.2).")
    ['Tune a loop by K.']
    """
    part = text.partition("## What you can do now\n")[2].partition("\n## ")[0]
    lines = [REFERENCE.sub("", line) for line in re.findall(r"(?m)^- (.+)$", part)]
    return [re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", line).translate(dict.fromkeys(map(ord, "$*`"))) for line in lines]


def add(app, pagename, templatename, context, doctree):
    """Give it to the template, as text that no page mistakes for its own."""
    said = json.dumps(of_page(pagename, app.config.html_baseurl), ensure_ascii=False)
    context["described"] = "" if said == "{}" else said.replace("<", r"\u003c").replace("&", r"\u0026")


def setup(app):
    """Join Sphinx."""
    app.connect("html-page-context", add)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
