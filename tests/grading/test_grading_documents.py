"""Documents and their two writers: nothing that anybody writes becomes more than text, in HTML and in Markdown."""

import base64
import dataclasses
import html
import itertools
import re

import markdown_it
import pytest

from exercisebook.response import MARKS
from exercisegrader.reports import document as of
from exercisegrader.reports import markdown, page, statement
from loopbook.exercises.bank import chapters, exercises
from small_class import HOSTILE, PICTURE
from whole_pages import Checker, assert_whole

#: Texts that would be more than text in HTML, in Markdown, or in both, in a line and at its beginning.
ATTACKS = (
    HOSTILE,
    "<script>alert(1)</script>",
    "</bdi></code></summary></title><svg onload=alert(1)>",
    "\"><img src=x onerror='alert(1)'>",
    "&lt;b&gt; &amp; &#60;b&#62;",
    "<!-- a --> <?php ?> <![CDATA[ b ]]>",
    "*a* _b_ **c** __d__ ~~e~~ `f` ``g``",
    "[a](javascript:alert(1)) ![b](http://c.de/f.png) [d]: http://e.fg",
    "<http://a.bc> http://a.bc www.a.bc a@b.cd",
    "# a",
    "- a",
    "+ a",
    "* a",
    "> a",
    "1. a",
    "12) a",
    "123456789. a",
    "===",
    "---",
    "***",
    "```\na\n```",
    "~~~",
    "    a",
    "\ta",
    "| a | b |\n|---|---|",
    "a\n\n# b\n\n- c",
    "a\\",
    "\\*a\\*",
    "a  \nb",
    "$x$ $$y$$ \\(z\\)",
    "^1 [^1]: a",
    ": a",
    "\u2028\u2029\x85\x0b a",
    "\u202eabc\u202c \u2066x",
    "\ud800",
    "",
    " ",
)
each_attack = pytest.mark.parametrize("attack", ATTACKS, ids=range(len(ATTACKS)))


def words(text):
    """A text as a reader sees it, where any white space is one space."""
    return " ".join(text.split())


def rendered(text):
    """Markdown as HTML, with all that people switch on: HTML, tables, lines through."""
    return markdown_it.MarkdownIt("commonmark", {"html": True}).enable(["table", "strikethrough"]).render(text)


def seen(text):
    """The tags of some HTML, and what is read between them; a line that is broken is read as one."""
    checked = Checker(re.sub(r"<(br|hr)\s*/?>", " ", text))
    return set(checked.tags), words(checked.text)


def shown(text):
    """How a text is shown: in one line, with what cannot be seen spelled out."""
    return words(html.unescape(re.sub(r"</?bdi>", "", page.inline(of.Said(text)))))


@each_attack
@pytest.mark.parametrize("kind", [str, of.Said], ids=["plain", "said"])
def test_a_text_is_shown_as_it_is_on_a_page_and_in_markdown(kind, attack):
    assert seen(page.inline(kind(attack))) == ({"bdi"} if kind is of.Said else set(), shown(attack))
    (line, _) = markdown.block(of.Paragraph(kind(attack)))
    assert seen(rendered(line)) == ({"p"} if shown(attack) else set(), shown(attack))


@each_attack
def test_code_is_shown_letter_by_letter(attack):
    tags, text = seen(page.inline(of.Code(attack)))
    assert (tags - {"bdi"}, text) == ({"code"}, shown(attack))
    tags, text = seen(rendered(markdown.block(of.Paragraph(of.Code(attack)))[0]))
    assert (tags, text) == ({"p", "code"} if shown(attack) else set(), shown(attack))


def test_no_two_texts_side_by_side_make_more_than_themselves():
    pieces = [
        "1",
        ".",
        " a",
        "-",
        "http:",
        "//a.bc",
        "www",
        ".a.bc",
        "<",
        "b>",
        "*",
        "a",
        "`",
        "$",
        "!",
        "[c]",
        "(d)",
        " ",
    ]
    for some in itertools.product(pieces, repeat=3):
        texts = tuple(kind(one) for kind, one in zip((of.Said, str, of.Said), some, strict=True))
        (line, _) = markdown.block(of.Paragraph(texts))
        tags, text = seen(rendered(line))
        assert tags <= {"p"}, some
        assert text.replace(" ", "") == "".join(some).replace(" ", ""), some


def everywhere(text, formula="K"):
    """A document with a text wherever one may stand, and an author's formula."""
    said, both = of.Said(text), (of.Strong(of.Said(text)), " ", of.Quiet(text), of.Emphasis(text))
    return of.Document(
        title=said,
        name=text,
        blocks=(
            of.Heading(both),
            of.Heading(said, level=3),
            of.Paragraph(
                (text, said, of.Code(text), of.Sentence(text), of.Formula(formula), of.Formula(formula, True))
            ),
            of.Caution((said, of.Picture(PICTURE, text))),
            of.Listing((said, both)),
            of.Listing((said,), is_numbered=True),
            of.Table(text, [said, text], [[said, of.Code(text)], [of.Lines((said, text)), of.Link(said, f"x{text}")]]),
            of.Verdicts((of.Judged("wrong", text, said, (said, text)), of.Judged("right", text))),
            of.Histogram(((0, 1, 2), (1, 2, 3))),
            of.Details(said, (of.Paragraph(said), of.Listing((said,)))),
        ),
    )


@each_attack
def test_a_page_is_whole_whatever_is_said_in_it(attack):
    attack = attack.replace("\ud800", "")  # no address has one: ids are letters and digits
    checked = assert_whole(page.written(everywhere(attack, formula=attack)))
    assert {"bdi", "table", "details"} <= set(checked.tags)
    assert checked.tags.count("img") == 1
    assert words(shown(attack)) in words(checked.text)


@each_attack
def test_markdown_is_what_the_document_is_whatever_is_said_in_it(attack):
    attack = attack.replace("\ud800", "").replace("$", "")  # of formulas there are tests below
    text = markdown.written(everywhere(attack))
    text.encode()
    allowed = {"h1", "h2", "h3", "p", "strong", "em", "code", "pre", "ul", "ol", "li", "table", "thead", "tbody", "tr"}
    assert seen(rendered(text))[0] <= allowed | {"th", "td", "a", "blockquote"}
    for block in re.findall(r"(?:^\|.*\n)+", text, re.MULTILINE):
        assert len({len(re.findall(r"(?<!\\)\|", line)) for line in block.splitlines()}) == 1


def kinds(parent):
    return [
        kind for kind in vars(of).values() if isinstance(kind, type) and issubclass(kind, parent) and kind != parent
    ]


def test_both_writers_know_every_kind():
    for kind in kinds(of.Block):
        assert page.block.dispatch(kind) != page.block.dispatch(object), kind
        assert markdown.block.dispatch(kind) != markdown.block.dispatch(object), kind
    for kind in [*kinds(of.Inline), str, tuple]:
        assert page.inline.dispatch(kind) != page.inline.dispatch(object), kind
        assert markdown.inline.dispatch(kind) != markdown.inline.dispatch(object), kind
    used = everywhere("a")
    assert {type(one) for one in used.blocks} == {*kinds(of.Block)}


@pytest.mark.parametrize("write", [page.block, page.inline, markdown.block, markdown.inline])
def test_what_is_none_of_a_document_is_an_error(write):
    with pytest.raises(TypeError, match=r"3 is no (block|text) of a document"):
        write(3)


def test_what_a_document_says_cannot_be_changed():
    for kind in [of.Document, of.Judged, *kinds(of.Block), *kinds(of.Inline)]:
        assert kind.__dataclass_params__.frozen, kind
    with pytest.raises(dataclasses.FrozenInstanceError):
        of.Said("a").text = "b"


def test_a_row_has_a_cell_for_each_column():
    with pytest.raises(ValueError, match="a row of the table 'Grades' has 1 cells: expected 2"):
        of.Table("Grades", ["a", "b"], [["1", "2"], ["3"]])


@pytest.mark.parametrize("to", ["", "/etc", "//evil.example", "\\\\evil"])
def test_a_link_leads_to_a_file_beside_it(to):
    with pytest.raises(ValueError, match="expected the path from one file to another"):
        of.Link("a", to)


@pytest.mark.parametrize("to", ["javascript:alert(1)", "https://evil.example", "x\" onclick='a'", "a) [b](c"])
def test_no_path_is_another_address(to):
    ((_, address),) = Checker(page.inline(of.Link("a", to))).attributes
    assert re.fullmatch(r"[\w%./-]+", address)
    assert f"[a]({address})" == markdown.inline(of.Link("a", to))


def test_a_document_as_markdown():
    document = of.Document(
        ("Tuning of ", of.Sentence("$K_c$")),
        "Tuning",
        (
            of.Heading(("1 · ", of.Sentence("Gain"), " ", of.Quiet("(2 of 4 points)"))),
            of.Caution("Mind the gap."),
            of.Verdicts(
                (of.Judged("mistake", "K", of.Sentence("that is $1/K$"), (("Your answer: ", of.Code("a`b")),)),)
            ),
            of.Details("The question", (of.Paragraph(("Find ", of.Formula("K < 4"))), of.Listing(("a", "b"), True))),
            of.Table("Gains", ["x", of.Status("right")], [[of.Code("a|b"), of.Formula("|x|")]], counts=frozenset({1})),
        ),
    )
    assert markdown.written(document) == (
        "# Tuning of $K_c$\n\n"
        "## 1 · Gain (2 of 4 points)\n\n"
        "**Mind the gap.**\n\n"
        "- ≈ `K` **mistake**: that is $1/K$\n  - Your answer: ``a`b``\n\n"
        "> **The question**\n>\n> Find $K \\lt 4$\n>\n> 1. a\n> 2. b\n\n"
        "| x | right |\n| --- | --- |\n| `a\\|b` | $\\vert x\\vert $ |\n"
    )


def test_a_picture_is_in_the_page_and_named_in_a_text():
    picture = of.Picture(PICTURE, 'your "figure"')
    text = page.inline(picture)
    assert base64.b64decode(re.search(r'src="data:image/png;base64,([^"]+)"', text)[1]) == PICTURE
    assert 'width="1" height="1" alt="your &quot;figure&quot;"' in text
    assert markdown.inline(picture) == 'your "figure" (a picture, on the page)'


def test_a_status_may_have_another_word():
    verdicts = of.Verdicts((of.Judged("to be marked", "sketch", word="marked by hand"),))
    assert markdown.block(verdicts)[0] == "- ✎ `sketch` **marked by hand**"
    assert Checker("".join(page.block(verdicts))).text == "✎ sketch marked by hand"


def test_a_document_as_a_page():
    blocks = (
        of.Heading(("1 ", of.Quiet("(2)"))),
        of.Verdicts((of.Judged("right", "K", "", ("Your answer: 2",)),)),
        of.Details("The question", (of.Listing(("a",)),)),
        of.Table("Gains", ["x", "y"], [["1", of.Lines(("2", "3"))]], counts=frozenset({1})),
    )
    text = page.written(of.Document("A < B", "A < B", blocks))
    for line in (
        "<title>A &lt; B</title>",
        "<h1>A &lt; B</h1>",
        '<h2>1 <span class="quiet">(2)</span></h2>',
        '<li class="right"><span class="status right" aria-hidden="true">✓</span> <code>K</code> '
        '<span class="status right">right</span><div class="answer">Your answer: 2</div></li>',
        "<details><summary>The question</summary>\n<ul>\n<li>a</li>\n</ul>\n</details>",
        '<tr><th scope="row" class="quiet">1</th><td class="count">2<br>3</td></tr>',
    ):
        assert line in text


# Statements.


def test_a_statement_is_paragraphs_lists_tables_and_formulas():
    source = (
        "**Exercise 1** (3 points)\n\nA lag of\n30 s, and\n2. of them.\n- `K`: the *gain*, in\n  K/%\n- more\n\n"
        "$$\\frac{1}{s}$$\n\n1. one\n2) two\n\n| a | `b\\|c` |\n|---|:-:|\n| $x$ |\n"
    )
    text = markdown.written(of.Document("T", "T", statement.blocks(source))).removeprefix("# T\n\n")
    assert text == (
        "**Exercise 1** (3 points)\n\nA lag of 30 s, and 2. of them.\n\n- `K`: the *gain*, in K/%\n- more\n\n"
        "$$\\frac{1}{s}$$\n\n1. one\n2. two\n\n| a | `b\\|c` |\n| --- | --- |\n| $x$ |  |\n"
    )


def test_a_number_and_its_unit_stay_in_one_line():
    (paragraph,) = statement.blocks("the time\nis 30\N{NO-BREAK SPACE}s")
    assert page.block(paragraph) == ["<p>the time is 30\N{NO-BREAK SPACE}s</p>"]
    assert markdown.block(paragraph)[0] == "the time is 30\N{NO-BREAK SPACE}s"
    assert page.sentence("in 30\N{NO-BREAK SPACE}s") == "in 30\N{NO-BREAK SPACE}s"


@each_attack
def test_a_statement_brings_no_markup_of_its_own(attack):
    blocks = statement.blocks(f"{attack}\n\n- {attack}\n\n`{attack}` and {attack}")
    checked = assert_whole(page.written(of.Document("T", "T", blocks)))
    allowed = {"html", "head", "meta", "title", "style", "body", "main", "h1", "p", "ul", "ol", "li", "code", "bdi"}
    allowed |= {"strong", "em", "div", "table", "thead", "tbody", "tr", "th", "td", *page._TAGS, "math"}
    assert set(checked.tags) <= allowed
    assert not [name for name, _ in checked.attributes if name in ("href", "src")]


def test_every_statement_of_the_bank_is_shown_whole():
    """All words are there, all formulas are formulas, and no sign of Markdown is left."""
    count = 0
    for number in chapters():
        for one in exercises(number).values():
            asked = str(one.question().statement)
            text = page.written(of.Document("T", "T", statement.blocks(asked)))
            checked = assert_whole(text)
            outside = re.sub(r"<code>.*?</code>|<math.*?</math>|<style>.*?</style>", " ", text, flags=re.DOTALL)
            assert not re.search(r"[$*`\\]", outside), (one.number, re.search(r".{40}[$*`\\].{9}", outside))
            assert "\\" not in re.sub(r"<code>.*?</code>", "", re.sub(r"<style>.*?</style>", "", text)), one.number
            bare = re.sub(r"\$+[^$]*\$+|`[^`]*`|^\|?[-| :]+$|[*|]|^\s*(-|\d+[.)])\s", " ", asked, flags=re.MULTILINE)
            assert set(bare.split()) <= set(re.sub("<[^>]*>", " ", html.unescape(text)).split()), one.number
            assert "table" in checked.tags or "|---" not in asked
            count += 1
    assert count > 100


def luminance(colour):
    parts = [int(colour[k : k + 2], 16) / 255 for k in (1, 3, 5)]
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


@pytest.mark.parametrize(
    ("colours", "ground"),
    [({k: c for k, (_, c) in MARKS.items()}, "#f4f4f4"), (page.ON_DARK, "#222222")],
    ids=["light", "dark"],
)
def test_the_words_of_the_statuses_can_be_read(colours, ground):
    assert colours.keys() == MARKS.keys()
    for colour in colours.values():
        low, high = sorted([luminance(colour), luminance(ground)])
        assert (high + 0.05) / (low + 0.05) >= 4.5


# Formulas.


@pytest.mark.parametrize(
    ("sentence", "mathml"),
    [
        (r"here $T_c = \tau$", "<msub><mi>T</mi><mi>c</mi></msub>"),
        (r"$\frac{K}{T s + 1}$", "<mfrac>"),
        ("from $-1$ on", "−"),
    ],
)
def test_formulas_are_mathml(sentence, mathml):
    text = page.sentence(sentence)
    assert mathml in text
    assert "$" not in text


@pytest.mark.parametrize(
    "latex", [r"\text{<script>x</script>}", r"\text{<b onclick='x'>y</b>}", r"\left(", "x^", "{" * 2000, r"\frac{}"]
)
def test_what_is_no_formula_is_shown_as_it_is(latex):
    tags = Checker(page.sentence(f"see ${latex}$")).tags
    assert set(tags) <= {"code", "math", "mrow", "mi", "mo", "mfrac"}


@pytest.mark.parametrize("latex", [r"\href{javascript:alert(1)}{x}", r"\style{background:url(//evil)}{x}"])
def test_formulas_bring_no_links_and_no_styles(latex):
    assert {name for name, _ in Checker(page.sentence(f"${latex}$")).attributes} <= {"display"}


def test_every_formula_in_the_banks_sentences_is_mathml():
    sentences = {
        s for chapter in ("4", "5", "10", "18") for one in exercises(chapter).values() for s, _ in one.mistakes
    }
    formulas = {
        f"${f}$" for s in sentences for f in re.findall(r"\$([^$]+)\$", s.replace("{{", "{").replace("}}", "}"))
    }
    assert len(formulas) > 20
    for formula in formulas:
        assert page.sentence(formula).startswith("<math"), formula
        assert "\\" not in page.sentence(formula), formula


def test_a_single_dollar_sign_begins_no_formula():
    assert page.sentence("5 $ each") == "5 $ each"


def test_formulas_stay_formulas_in_markdown():
    assert markdown.inline(of.Sentence("*so* $K_c < 4$")) == r"\*so\* $K_c \lt 4$"
