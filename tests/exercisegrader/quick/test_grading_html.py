"""What anybody writes is nothing but text on a page: no markup, no script, no link."""

import base64
import html
import re

import jinja2
import pytest

from exercisebook.forms import mathml
from exercisebook.judging import WAITING
from exercisebook.response import MARKS
from exercisegrader.keeping import executed
from exercisegrader.marking import Marked, MarkedExercise, Notice
from exercisegrader.reports import pages
from exercisegrader.reports.outputs import Grades
from exercisegrader.reports.outputs.feedback import feedback
from exercisegrader.reports.outputs.summary import summary
from exercisegrader.reports.outputs.to_mark import to_mark
from exercisegrader.results import CellError, JudgedAnswer, JudgedExercise, Look, Result
from exercisegrader.roster import Student
from small_class import HOSTILE, PICTURE
from whole_pages import Checker, assert_whole

#: Texts that would be more than text in HTML or in Markdown, in a line and at its beginning.
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


def seen(text):
    """The tags of some HTML, and what is read between them."""
    checked = Checker(text)
    return set(checked.tags), words(checked.text)


def parts():
    """The blocks that several pages have."""
    return pages._TEMPLATES.get_template("parts.html").module


def shown(text):
    """How a text is shown: in one line, with what cannot be seen spelled out."""
    return words(html.unescape(pages.line(text)))


@each_attack
def test_a_text_is_shown_as_it_is(attack):
    assert seen(pages.line(attack)) == (set(), shown(attack))
    assert seen(pages.said(attack)) == ({"bdi"}, shown(attack))
    tags, text = seen(pages.code(attack))
    assert (tags - {"bdi"}, text) == ({"code"}, shown(attack))
    tags, text = seen(parts().person(attack, attack))
    assert (tags, text) == ({"bdi", "span"}, words(f"{shown(attack)} ({shown(attack)})"))


def everything(text, formulas=False):
    """Each page of a student and of a class with a text wherever one may stand, in formulas where it may be one."""
    title, status = (text if formulas else text.replace("$", "")), [*MARKS]
    answers = [JudgedAnswer(text, one, title, None if one == WAITING else text, text, 1, text) for one in status]
    judged = JudgedExercise(text, title, 4, text, ((text, text),), tuple(answers))
    looks = tuple(Look(kind, text) for kind in ("owner", "odd lines", "unasked", "no code"))
    result = Result(text, "s1", text, False, "", "stopped", text, (CellError(1, text),), looks, (judged,), text, text)
    exercise = MarkedExercise(judged, 1, (text,), (text,), (text,))
    mark = Marked(result, (exercise,), text or "late", 1, (text,), (Notice(1, text),))
    student = Student("s1", text)
    grades = Grades(title, [student], [mark], [text, "another"], [text], reveal=True, notebooks=["s1"])
    yield feedback(grades, student, mark)
    yield summary(grades)
    yield to_mark(grades, "all")
    yield executed(result, b"", [], text)


@each_attack
@pytest.mark.parametrize("formulas", [False, True])
def test_a_page_is_whole_whatever_is_said_in_it(attack, formulas):
    for text in everything(attack, formulas):
        checked = assert_whole(text)
        assert not {"b", "svg"} & {*checked.tags}
        assert formulas or shown(attack) in words(checked.text)


def test_what_a_template_is_not_told_is_an_error():
    with pytest.raises(jinja2.UndefinedError):
        pages.page("executed.html", "s1")


@pytest.mark.parametrize(
    "id", ["/etc", "//evil.example", "\\\\evil", "javascript:alert(1)", "x\" onclick='a'", "a) [b](c"]
)
def test_a_link_leads_to_a_file_beside_it(id):
    result = Result("heater", id, f"{id}.ipynb", True, "", "complete", "", (), (), ())
    page = summary(Grades("Heater", [Student(id, "Ada")], [Marked(result, (), "late")], notebooks=[id]))
    addresses = [value for name, value in assert_whole(page).attributes if name == "href"]
    assert len(addresses) == 2
    assert all(re.fullmatch(r"(feedback|notebooks)/[\w%./-]+", one) for one in addresses)


def test_a_picture_is_in_the_page():
    text = pages.picture(PICTURE, 'your "figure"')
    assert base64.b64decode(re.search(r'src="data:image/png;base64,([^"]+)"', text)[1]) == PICTURE
    assert 'width="1" height="1" alt="your &#34;figure&#34;"' in text


def test_a_status_is_said_by_a_sign_a_colour_and_a_word():
    text = parts().status("to be marked", "sketch", "marked by hand")
    assert Checker(text).text == "✎ sketch marked by hand"
    assert text.count('class="status to-be-marked"') == 2
    assert 'aria-hidden="true">✎' in text


# Statements.


@each_attack
def test_a_statement_brings_no_markup_of_its_own(attack):
    checked = Checker(pages.statement(f"{attack}\n\n- {attack}\n\n`{attack}` and {attack}"))
    allowed = {"p", "ul", "ol", "li", "code", "pre", "strong", "em", "br", "hr", "blockquote", "div", "span"}
    assert set(checked.tags) <= allowed | {"table", "thead", "tbody", "tr", "th", "td"} | mathml.TAGS
    assert {name for name, _ in checked.attributes} <= {"class", "tabindex", "start"} | mathml.ATTRIBUTES
    assert re.search(r"[\x00-\x09\x0b-\x1f\x7f-\x9f\u202e\ud800]", checked.text) is None


def test_a_number_and_its_unit_stay_in_one_line():
    assert pages.statement("the time\nis 30\N{NO-BREAK SPACE}s") == "<p>the time\nis 30\N{NO-BREAK SPACE}s</p>"
    assert pages.sentence("in 30\N{NO-BREAK SPACE}s") == "in 30\N{NO-BREAK SPACE}s"


# Colours.


def luminance(colour):
    parts = [int(colour[k : k + 2], 16) / 255 for k in (1, 3, 5)]
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


@pytest.mark.parametrize(
    ("colours", "ground"),
    [({k: c for k, (_, c) in MARKS.items()}, "#f4f4f4"), (pages.ON_DARK, "#222222")],
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
    text = pages.sentence(sentence)
    assert mathml in text
    assert "$" not in text


@pytest.mark.parametrize(
    "latex", [r"\text{<script>x</script>}", r"\text{<b onclick='x'>y</b>}", r"\left(", "x^", "{" * 2000, r"\frac{}"]
)
def test_what_is_no_formula_is_shown_as_it_is(latex):
    tags = Checker(pages.sentence(f"see ${latex}$")).tags
    assert set(tags) <= {"code", "math", "mrow", "mi", "mo", "mfrac"}


@pytest.mark.parametrize("latex", [r"\href{javascript:alert(1)}{x}", r"\style{background:url(//evil)}{x}"])
def test_formulas_bring_no_links_and_no_styles(latex):
    assert {name for name, _ in Checker(pages.sentence(f"${latex}$")).attributes} <= {"display"}


def test_a_single_dollar_sign_begins_no_formula():
    assert pages.sentence("5 $ each") == "5 $ each"
