"""The search's index: which words are in which section of the site, and what an equation's number leads to.

The index is a script that a page loads at the first search: a page opened from a disk may load that, and fetch nothing.
Beside it is a script for each page with the text of its sections, of which only those are loaded that a result shows.
_static/search.js reads them; words are cut out of a text the same way there.

An entry of a word is a list of pairs (section, weight), the sections by their distances, five bits a character as in
`packed`, the weight in one character. That takes two or three bytes for each; libraries that keep the same in JSON take
three times as much, a megabyte, which is too much for a phone.
"""

import html
import json
import re
import unicodedata
from collections import Counter
from pathlib import Path

import permanent
from docutils import nodes
from sphinx import addnodes

WORDS = Path(__file__).parents[1] / "search_words.txt"
ALPHABET = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_"
GREEK = {
    "α": "alpha", "β": "beta", "γ": "gamma", "δ": "delta", "Δ": "delta", "ε": "epsilon", "ζ": "zeta", "η": "eta",
    "θ": "theta", "κ": "kappa", "λ": "lambda", "μ": "mu", "π": "pi", "ρ": "rho", "σ": "sigma", "τ": "tau", "φ": "phi",
    "ω": "omega", "Ω": "omega",
}  # fmt: skip
LETTERS = {name: letter for letter, name in reversed(GREEK.items())} | {"Delta": "Δ", "Omega": "Ω"}
LEFT_OUT = {"figures", "ledger"}  # the gallery repeats the chapters, and the ledger has a search of its own
UNSAID = "math|svg|script|style|noscript|canvas|button|select|template"  # elements of a page that hold no sentences
UNREAD = (
    nodes.section, nodes.title, nodes.literal_block, nodes.math_block, nodes.comment, nodes.image,
    nodes.substitution_definition, addnodes.desc, addnodes.desc_signature, addnodes.toctree, addnodes.index,
)  # fmt: skip
ASKED = 0.8  # what those of an exercise count to those of a section that explains
IN_TITLE, IN_PAGE_TITLE = 5.0, 1.0  # what a word in a title is worth, to one in the text
SATURATION, LENGTH = 1.2, 0.5  # of BM25
KINDS = (*permanent.KINDS, "exercise")
PLACE = re.compile(rf'id="((?:{"|".join(KINDS)})-[\w-]*\d[\w-]*)"')


def words(text):
    """Return the words of a text: small letters without accents, Greek by name, without the s of a plural.

    >>> words("Anti wind-up: θ and the PI controllers, K_p = 2.5")
    ['anti', 'wind', 'up', 'theta', 'and', 'the', 'pi', 'controller', 'k', 'p', '2.5']
    """
    text = "".join(f" {GREEK[letter]} " if letter in GREEK else letter for letter in text)
    plain = unicodedata.normalize("NFKD", text).encode("ascii", "ignore").decode().lower()
    plain = re.sub(r"(?<=\d)-(?=\d)", ".", plain)  # Seborg writes 12-5
    return [singular(word) for word in re.findall(r"\d+(?:\.\d+)+[a-z]?|[a-z0-9]+", plain)]


def singular(word):
    return word[:-1] if len(word) > 3 and word.endswith("s") and word[-2] not in "sui0123456789" else word


#: What says nothing of what is asked: the words on lines of search_words.txt that end in "=".
COMMON = {word for line in WORDS.read_text("utf-8").splitlines() if line.endswith("=") for word in words(line)}


def spoken(latex):
    r"""Return a formula within a sentence as plain text.

    >>> spoken(r"\theta/T_C \le \frac{1}{2}"), spoken(r"K_{\mathrm{p}}")
    ('θ/T_C ≤ 1/2', 'K_p')
    """
    text = re.sub(r"\\(mathrm|text|mathit|operatorname|left|right|displaystyle)\b", "", latex)
    text = re.sub(r"\\d?frac\{([^{}]*)\}\{([^{}]*)\}", r"\1/\2", text)
    signs = {"le": "≤", "ge": "≥", "cdot": "·", "times": "×", "infty": "∞", "to": "→", "approx": "≈", "pm": "±"}
    text = re.sub(r"\\([A-Za-z]+)", lambda m: signs.get(m[1]) or LETTERS.get(m[1]) or m[1], text)
    return re.sub(r"\s+", " ", re.sub(r"\\.|[{}]", "", text)).strip()


def plain(markup):
    """Return a piece of HTML as text, without its formulas and pictures."""
    markup = re.sub(rf"<({UNSAID})\b.*?</\1>", " ", markup, flags=re.DOTALL)
    return html.unescape(re.sub(r"<[^>]+>", " ", markup))


def text_of(node):
    """Return the text of a part of a page, without code and without what has an entry of its own."""
    if isinstance(node, nodes.Text):
        return node.astext()
    if isinstance(node, nodes.math):
        return spoken(node.astext())
    if isinstance(node, nodes.raw):
        return plain(node.astext()) if node.get("format") == "html" else ""
    if isinstance(node, UNREAD):
        return ""
    inner = "".join(map(text_of, node.children))
    return inner if isinstance(node, nodes.Inline) else f" {inner} "


def places_of(node):
    """The names of a book's places in a part of a page that are not those of its sections."""
    found = []
    for part in node.children:
        if isinstance(part, nodes.section):
            continue
        for raw in part.findall(nodes.raw):
            found += PLACE.findall(raw.astext())
        for cell in part.findall(nodes.container):
            found += [name for name in permanent.of_cell(cell).get("names", ()) if re.search(r"\d", name)]
    return found


def title_of(section):
    """The title of a section as plain text."""
    return re.sub(r"\s+", " ", "".join(map(text_of, section[0].children))).strip()


def sections_of(doctree):
    """Return the sections of a page: [(place, title, title of what it is in, text, places of the book), ...]."""
    found = []
    for node in doctree.findall(lambda part: isinstance(part, nodes.section | addnodes.desc)):
        inside = node.parent
        while inside is not None and not isinstance(inside, nodes.section):
            inside = inside.parent
        above = title_of(inside) if inside is not None else ""
        if isinstance(node, nodes.section):
            named = [name for name in node["ids"] if re.match(rf"({'|'.join(KINDS)})-.*\d", name)]
            own = [
                name for name in named if name in permanent.names_of(node[0].astext()) or name.startswith("exercise-")
            ]
            place, title, body = node["ids"][0], title_of(node), node.children
        else:
            signature = node[0]
            if not signature.get("ids"):
                continue
            own, place, title = [], signature["ids"][0], signature["ids"][0].removeprefix("loopbook.")
            body = node.children
        text = re.sub(r"\s+", " ", "".join(map(text_of, body))).strip()
        found.append((place, title, above, text, own + places_of(node)))
    return found


def collect(app, doctree):
    """Keep the sections of a page that has been read."""
    if app.env.docname not in LEFT_OUT:
        kept(app.env)[app.env.docname] = sections_of(doctree)


def kept(env):
    if not hasattr(env, "loopbook_sections"):
        env.loopbook_sections = {}
    return env.loopbook_sections


def forget(app, env, docname):
    kept(env).pop(docname, None)


def merge(app, env, docnames, other):
    kept(env).update({name: kept(other)[name] for name in docnames if name in kept(other)})


def packed(numbers):
    """Return numbers from 0 on as letters, five bits each, the sixth says that more come.

    >>> packed([1, 40])
    'BoB'
    """
    text = ""
    for number in numbers:
        while number > 31:
            text += ALPHABET[32 + number % 32]
            number //= 32
        text += ALPHABET[number]
    return text


def aliases(text):
    """Return what is typed, what the book says, and what a reader must know: [[typed, [said, ...], note], ...].

    What is typed is cut into words, without those of a question; the note is a sentence, often empty.

    Raises:
        ValueError: a line has no "=".

    >>> aliases("ZN = Ziegler Nichols\\nroot locus = poles ! The books have none.")
    [['zn', ['ziegler nichol'], ''], ['root locus', ['pole'], 'The books have none.']]
    """
    found = []
    for line in text.splitlines():
        if not line.strip() or line.startswith("#") or line.endswith("="):
            continue
        line, _, note = line.partition(" ! ")
        typed, sign, said = line.partition("=")
        if not sign:
            raise ValueError(f"search_words.txt has the line {line!r}: expected 'what one types = what the book says'")
        meant = [" ".join(words(part)) for part in said.split(",")]
        for part in typed.split(","):
            one = " ".join(word for word in words(part) if word not in COMMON)
            found.append([one, [other for other in meant if other != one], note.strip()])
    return found


def index(pages, titles):
    """Return the index, as data.

    Arguments:
        pages: {name of the page: its sections}, as `sections_of` returns them.
        titles: {name of the page: its title}.
    """
    names = sorted(pages, key=order)
    whole = [(number, *section) for number, name in enumerate(names) for section in pages[name]]
    lengths = [1 + len(text) / 6 for *_, text, _ in whole]  # about as many words
    average = sum(lengths) / len(lengths)
    entries, places = {}, {}
    for number, (page, place, title, above, text, named) in enumerate(whole):
        factor = ASKED if place.startswith("exercise-") else 1
        counts = Counter(word for word in words(text) if word not in COMMON and not word[0].isdigit())
        weights = {
            word: count * (SATURATION + 1) / (count + SATURATION * (1 - LENGTH + LENGTH * lengths[number] / average))
            for word, count in counts.items()
        }
        for titled, worth in ((title, IN_TITLE), (f"{above} {titles[names[page]]}", IN_PAGE_TITLE)):
            for word in set(words(titled)) - COMMON:
                weights[word] = weights.get(word, 0) + worth
        for word, weight in weights.items():
            entries.setdefault(word, []).append((number, max(1, min(63, round(8 * factor * weight)))))
        for name in named:
            places.setdefault(name, []).append(number)
    ordered = sorted(entries)
    postings = []
    for word in ordered:
        before, text = 0, ""
        for number, weight in entries[word]:
            text += packed([number - before]) + ALPHABET[weight]
            before = number
        postings.append(text)
    return {
        "pages": [[name, titles[name]] for name in names],
        "sections": [
            [page, place, title, above if above != titles[names[page]] else ""]
            for page, place, title, above, *_ in whole
        ],
        "common": " ".join(sorted(COMMON)),
        "words": " ".join(ordered),
        "entries": " ".join(postings),
        "places": places,
        "aliases": aliases(WORDS.read_text(encoding="utf-8")),
    }


def order(name):
    """The chapters first, then what else there is."""
    kinds = ("chapters/", "solutions/", "reference/")
    return next((rank for rank, kind in enumerate(kinds) if name.startswith(kind)), len(kinds)), name


def script(call):
    return f"(window.loopbookSearch ||= {{ texts: {{}} }}){call};\n"


def as_json(data):
    return json.dumps(data, ensure_ascii=False, separators=(",", ":"))


def write(app, problem):
    """Write the index, and the texts of each page, when all pages are there."""
    if problem or app.builder.format != "html":
        return
    pages = {name: sections for name, sections in kept(app.env).items() if name in app.env.found_docs}
    titles = {name: app.env.titles[name].astext() for name in pages}
    folder = Path(app.outdir, "_static", "search")
    folder.mkdir(parents=True, exist_ok=True)
    data = index(pages, titles)
    (folder / "index.js").write_text(script(f".index = {as_json(data)}"), encoding="utf-8")
    for number, (name, _) in enumerate(data["pages"]):
        texts = [text for *_, text, _ in pages[name]]
        (folder / f"{number}.js").write_text(script(f".texts[{number}] = {as_json(texts)}"), encoding="utf-8")


def page(app):
    """The page that the search leads to without its dialog."""
    body = (
        '<h1>Search</h1>\n<div class="search-page"></div>\n'
        "<noscript><p>The search needs JavaScript. The chapters and their sections are in the list at the side, the "
        'functions in the <a href="genindex.html">index</a>.</p></noscript>'
    )
    yield "search", {"title": "Search", "body": body, "parents": []}, "page.html"


def no_other(app):
    """Sphinx's own search is not made."""
    app.builder.search = False


def setup(app):
    """Join Sphinx; sections have their names by then."""
    app.connect("builder-inited", no_other)
    app.connect("doctree-read", collect, priority=600)
    app.connect("env-purge-doc", forget)
    app.connect("env-merge-info", merge)
    app.connect("html-collect-pages", page)
    app.connect("build-finished", write)
    app.add_css_file("search.css")
    app.add_js_file("search.js", loading_method="defer")
    return {"version": "1", "env_version": 1, "parallel_read_safe": True, "parallel_write_safe": True}
