"""What a person marks: figures and texts, taken down and not judged; and quantities that count more than others."""

import base64
import io

import matplotlib.figure
import numpy as np
import pytest
from matplotlib import pyplot
from PIL import Image
from PIL.PngImagePlugin import PngInfo

from drawings import BEGIN, HEADER, Drawing, chunk
from drawings import png as stored
from draws import THOROUGH
from exercisebook import authoring, png
from exercisebook.authoring import answers, between, exercise, figure, number, text
from exercisebook.grammar import Unreadable
from exercisebook.judging import OPEN, UNJUDGED, WAITING
from exercisebook.kinds.by_hand import LONGEST
from judged import assert_judged

SKETCH = figure("the path", key="it is a parabola")
WHY = text("why the ball bounces", words=5, key="elastic")


@pytest.fixture
def axes():
    drawn, axes = pyplot.subplots()
    axes.plot([0, 1], [0, 1])
    yield axes
    pyplot.close(drawn)


def noise(side):
    return Image.fromarray(np.random.default_rng(1).integers(0, 255, (side, side, 3), dtype=np.uint8))


# Figures.


@pytest.mark.parametrize(
    "given",
    [
        lambda axes: axes,
        lambda axes: axes.figure,
        lambda axes: (axes.figure, axes),
        lambda axes: axes.plot([1, 2]),
        lambda axes: np.array([[axes, axes]]),
        lambda axes: axes.get_lines()[0],
        lambda axes: pyplot,
        lambda axes: axes.figure.subfigures(1, 2)[0].subplots(),
        lambda axes: axes.bar([1, 2], [3, 4]),
        lambda axes: stored(),
        lambda axes: bytearray(stored()),
        lambda axes: Image.new("L", (5, 5)),
        lambda axes: Drawing("the path"),
    ],
    ids=range(13),
)
def test_what_stands_for_a_figure_is_taken_down_as_a_picture(axes, given):
    value = given(axes)
    assert_judged(SKETCH, value, WAITING, "a person marks this")
    data = png.as_data(png.of_figure(value))
    assert_judged(SKETCH, data, WAITING, "a person marks this")
    with Image.open(io.BytesIO(png.checked(data)), formats=["PNG"]) as image:
        assert image.size == png.size(png.checked(data))
        image.verify()


@pytest.mark.parametrize("given", [..., None])
def test_no_figure_yet(given):
    assert_judged(SKETCH, given, OPEN, "not answered yet")


@pytest.mark.parametrize("given", ["plot.png", 3, [1, 2], {"K": 2}, b"PNG", object(), np.zeros((4, 4)), ()])
def test_what_is_no_figure_is_said(given):
    assert_judged(SKETCH, given, UNJUDGED, "this is not a figure: expected a figure of Matplotlib")


def test_a_figure_is_the_same_picture_each_time(axes):
    assert png.of_figure(axes) == png.of_figure(axes.figure)


def test_a_large_figure_is_made_smaller():
    huge = matplotlib.figure.Figure(figsize=(300, 20))
    huge.subplots().plot([0, 1])
    for value in (huge, noise(1500 if THOROUGH else 700), stored(5000, 10)):
        content = png.of_figure(value)
        assert len(content) <= png.LARGEST
        assert max(png.size(content)) <= png.LONGEST_SIDE


def test_a_figure_with_something_far_away_is_drawn(axes):
    axes.text(1e3, 0.5, "far", clip_on=False)
    assert max(png.size(png.of_figure(axes))) <= png.LONGEST_SIDE


def test_only_the_picture_is_kept():
    info = PngInfo()
    info.add_text("note", "<script>")
    content = stored(pnginfo=info, dpi=(100, 100))
    assert b"script" in content
    assert b"script" not in png.checked(png.as_data(content))
    assert b"script" not in png.checked(png.as_data(content + b"<script>"))


DAMAGED = {
    "no signature": stored()[1:],
    "cut off": stored()[:-5],
    "changed": stored()[:20] + b"!" + stored()[21:],
    "nothing in it": BEGIN,
    "no header": BEGIN + chunk(b"IEND"),
    "two headers": BEGIN + chunk(b"IHDR", HEADER) * 2 + chunk(b"IEND"),
    "short header": BEGIN + chunk(b"IHDR", b"short") + chunk(b"IEND"),
    "of another kind": BEGIN + chunk(b"IHDR", HEADER) + chunk(b"ABCD") + chunk(b"IEND"),
    "length": BEGIN + chunk(b"IHDR", HEADER) + b"\xff\xff\xff\xffIDAT",
}


@pytest.mark.parametrize("what", DAMAGED)
def test_what_claims_to_be_a_picture_and_is_none_is_not_judged(what):
    assert_judged(SKETCH, png.as_data(DAMAGED[what]), UNJUDGED, "this picture is damaged")


@pytest.mark.parametrize(
    ("data", "says"),
    [
        ("%%", "damaged"),
        ("A" * 500_000, "more than 300 kB"),
        (base64.b64encode(stored(2001, 2)).decode(), "2001 × 2 pixels"),
    ],
)
def test_a_picture_that_comes_from_outside_is_bounded(data, says):
    assert_judged(SKETCH, {"png": data}, UNJUDGED, says)
    with pytest.raises(Unreadable, match=says):
        png.checked({"png": data})


# Texts.


@pytest.mark.parametrize(
    ("given", "status", "says"),
    [
        ("because it is elastic", WAITING, "a person marks this"),
        ("one two three four five six", WAITING, "6 words, where at most 5 are asked for"),
        ("  ", OPEN, "not answered yet"),
        (..., OPEN, "not answered yet"),
        (5, UNJUDGED, "this is not a text: expected a text, in quotes"),
        (["a"], UNJUDGED, "this is not a text"),
    ],
)
def test_a_text(given, status, says):
    assert_judged(WHY, given, status, says)


def test_a_text_is_bounded():
    assert_judged(WHY, "x" * (LONGEST + 1), UNJUDGED, "5001 characters: expected at most 5000")


# In an exercise.


@exercise("1", title="A ball", points=6, weights={"K": 2})
def ball(T=between(2, 9, "s", reference=4)):
    """It flies for {T}."""
    return answers(K=number(T), sketch=SKETCH, why=WHY)


def test_the_response_takes_down_what_a_person_marks_and_judges_the_rest(axes):
    question = ball.question()
    response = question.check(K=4, sketch=axes, why="it is late")
    assert (response.is_right, response.earned) == (False, 3)
    assert repr(response).splitlines()[0] == "✎ Exercise 1 · A ball: 1 of 3 right, 2 to be marked"
    assert "✎ sketch: a person marks this" in repr(response)
    assert question.check(K=3, why="it is late").earned == 0
    alone = exercise("2", title="A")(only_a_text)
    assert "taken down" in repr(alone.question().check(why="late"))


def only_a_text(T=between(2, 9)):
    """It is {T}."""
    return answers(why=WHY)


def test_the_statement_says_what_counts_more_and_what_a_person_marks():
    statement = str(ball.question().statement)
    assert "- `K`: the value (counts double)" in statement
    assert "- `sketch`: the path, as a figure, which a person marks\n" in statement
    assert "- `why`: why the ball bounces, in at most 5 words, which a person marks" in statement
    assert "elastic" not in statement
    assert "*Accuracy: 1\N{NO-BREAK SPACE}%*" in statement


@pytest.mark.parametrize(
    ("weights", "says"),
    [
        ({"k": 2}, "exercise 1 weighs 'k': did you mean 'K'?"),
        ({"K": 0}, "the weight of K in exercise 1 is 0: expected a positive number"),
        ({"K": "2"}, "the weight of K in exercise 1 is '2': expected a positive number"),
        ({"K": float("inf")}, "expected a positive number"),
    ],
)
def test_what_is_wrong_with_weights_is_said(weights, says):
    with pytest.raises(ValueError, match=says):
        _ = exercise("1", title="A", weights=weights)(ball.key).question().key


@pytest.mark.parametrize(("weight", "words"), [(2, "double"), (0.5, "half"), (1.5, "1.5 times"), (3, "3 times")])
def test_weights_in_words(weight, words):
    question = exercise("1", title="A", weights={"K": weight})(ball.key).question()
    assert question.statement.asked[0].endswith(f" (counts {words})")


@pytest.mark.parametrize("kind", [SKETCH, WHY])
def test_its_form_says_nothing_of_its_key(kind):
    assert eval(kind.asking, vars(authoring)).by_hand
    assert kind.asking in ("figure()", "text(5)")
    assert kind.making == ""
    with pytest.raises(ValueError, match="expected no mistake of it"):
        kind.like("x")
    assert kind.maker in authoring.__all__


@pytest.mark.parametrize("make", [lambda: figure("a", key=3), lambda: text("a", words=-1), lambda: text("a", 2.5)])
def test_what_an_author_gives_wrongly_is_said(make):
    with pytest.raises(ValueError, match="expected a"):
        make()
