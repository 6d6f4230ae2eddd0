"""A page of exercises as a SCORM 1.2 package, a zip that a learning management system shows and that needs no server.

It consists of parts of the site: the exercises as they are in the pages of the chapters, and the Python that answers
them in the browser. `scorm.js` tells the system how many are right. The keys are in that Python, so it is for practice.
"""

from __future__ import annotations

import html
import io
import json
import re
import zipfile
from collections.abc import Sequence
from pathlib import Path
from xml.sax.saxutils import quoteattr

from exercisebook.errors import ExerciseError

#: What of the site a page of exercises needs, beside what the exercises name.
PARTS = ("_static/exercises.js", "_static/judge*.js", "_static/fonts/*", "_static/**/*.css", "wheels/*", "runtime/*")
STYLES = ("styles/furo.css", "exercises.css", "styles/furo-extensions.css", "loopbook.css")
#: A fixed time, so that the same content is the same file.
_EPOCH = (1980, 1, 1, 0, 0, 0)
_PAGE = """<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>{title}</title>
{styles}
<script src="exercises.js"></script>
<script src="scorm.js"></script>
<script src="_static/exercises.js" defer></script>
</head>
<body>
<main style="max-width: 46em; margin: 0 auto; padding: 1em">
<h1>{title}</h1>
<p>For practice: Python in this page answers, so whoever looks for the keys finds them.
<span class="lms" role="status"></span></p>
{exercises}
</main>
</body>
</html>
"""
_MANIFEST = """<?xml version="1.0" encoding="UTF-8"?>
<manifest identifier="loopbook" version="1.0" xmlns="http://www.imsproject.org/xsd/imscp_rootv1p1p2"
 xmlns:adlcp="http://www.adlnet.org/xsd/adlcp_rootv1p2">
<metadata><schema>ADL SCORM</schema><schemaversion>1.2</schemaversion></metadata>
<organizations default="all"><organization identifier="all"><title>{title}</title>
<item identifier="page" identifierref="index"><title>{title}</title></item></organization></organizations>
<resources><resource identifier="index" type="webcontent" adlcp:scormtype="sco" href="index.html">
{files}
</resource></resources>
</manifest>
"""


def package(numbers: Sequence[str], title: str, site: Path) -> bytes:
    """Return the package of some exercises, a zip.

    Arguments:
        numbers: of the exercises, in their order.
        title: of the page.
        site: the folder of the site, as ``make book`` makes it.
    Raises:
        ExerciseError: where there is no site, or an exercise is not in it.
    """
    try:
        listed = (site / "_static/exercises/table.js").read_text(encoding="utf-8")
    except OSError:
        raise ExerciseError(f"{site} is not the site: expected the folder that `make book` makes") from None
    table = json.loads(listed[listed.index("{") : listed.rindex("}") + 1])
    known = {one["number"]: one for chapter in table["chapters"] for one in chapter["exercises"]}
    if missing := [number for number in numbers if number not in known]:
        raise ExerciseError(f"exercise {missing[0]} is not in {site}: expected those of its chapters")
    blocks = [_block(site / known[number]["page"], number) for number in numbers]
    heads = [f"<h2>{number} · {html.escape(known[number]['title'])}</h2>" for number in numbers]
    styles = re.search(r"<style>.*?</style>", _text(site / known[numbers[0]]["page"]), re.DOTALL)[0]
    links = "\n".join(f'<link rel="stylesheet" href="_static/{name}">' for name in STYLES)
    table["chapters"] = [{"chapter": "", "title": title, "exercises": [known[number] for number in numbers]}]
    page = "\n".join(f"<section>\n{head}\n{block}\n</section>" for head, block in zip(heads, blocks, strict=True))
    files = {
        "index.html": _PAGE.format(title=html.escape(title), styles=f"{links}\n{styles}", exercises=page),
        "exercises.js": f"window.loopbookExercises = {json.dumps(table, ensure_ascii=False)};\n",
        "scorm.js": _text(Path(__file__).with_name("scorm.js")),
    }
    chapters = {number.partition(".")[0].lower() for number in numbers}
    named = {*re.findall(r'(?:src|href)="((?:_images|_static)/[^"]+)"', page)}
    named |= {f"_static/exercises/help-{chapter}.json" for chapter in chapters}
    paths = [path for part in PARTS for path in site.glob(part)] + [site / name for name in sorted(named)]
    content = {name: text.encode() for name, text in files.items()}
    content |= {path.relative_to(site).as_posix(): path.read_bytes() for path in paths if path.is_file()}
    entries = "\n".join(f"<file href={quoteattr(name)}/>" for name in sorted(content))
    content["imsmanifest.xml"] = _MANIFEST.format(title=html.escape(title), files=entries).encode()
    zipped = io.BytesIO()
    with zipfile.ZipFile(zipped, "w") as archive:
        for name, one in sorted(content.items()):
            archive.writestr(zipfile.ZipInfo(name, _EPOCH), one, zipfile.ZIP_DEFLATED)
    return zipped.getvalue()


def _text(path):
    return path.read_text(encoding="utf-8")


def _block(path, number):
    """The form of an exercise as it is in a page of the site, without links to other pages."""
    begin = rf'<div class="exercise docutils" data-exercise="{re.escape(number)}"'
    found = re.search(rf'({begin}.*?)<p class="exercise-links">.*?</p>\n</div>', _text(path), re.DOTALL)
    return re.sub(r'<a href="[^"]*solutions/[^"]*">(.*?)</a>', r"\1", found[1] + "</div>").replace('="../', '="')
