"""Exercises of chapter 1, motion: cars and balls."""

from drawings import Drawing
from exercisebook.authoring import answers, between, criterion, design, exercise, number, time_function, word, words
from plainmath.expressions import t


@exercise("1.1", "A car brakes", points=4, where=lambda v, way: way > v, insight="Twice as fast, four times as far.")
def car(v=between(5, 30, "m/s", reference=20), way=between(10, 90, "m", reference=40)):
    """A car that drives at {v} stops within {way}, with a constant acceleration."""
    return answers(
        t=number(2 * way / v, "s", "the time until it stands"),
        a=number(v**2 / (2 * way), "m/s²", "the size of its acceleration"),
    )


@car.mistake("The car does not go on at {v}: half of that is its mean velocity.")
def _(v, way):
    return {"t": way / v}


car.hints("The velocity falls evenly.", "Its mean is $v/2$.", "$t = \\frac{ {way} }{ {v}/2}$")


@car.solution
def _(v, way):
    """The mean velocity is {mean}.

    ***

    So it takes {t}, and $a = \\frac{v}{t} =$ {a}.
    """
    return {"mean": (v / 2, "m/s")}


@exercise("1.2", title="A ball is thrown")
def ball(v=between(5, 30, "m/s", step=1, reference=10)):
    """A ball is thrown upward at {v}; $g = 10$ m/s²."""
    way = word("down", ["up", "down", "nowhere"], "the way in which gravity acts")
    acts = ["gravity", "drag", "the hand", "a spring"]
    return answers(
        way=way,
        on=words([], acts, "what acts on it in a vacuum, far from everything"),
        flying=words(["gravity", "drag"], acts, "what acts while it flies"),
        order=words(["thrown", "at rest", "caught"], ["at rest", "caught", "thrown"], "what happens", ordered=True),
        h=time_function(v * t - 5 * t**2, v / 5, "m", "its height"),
        slow=design(
            number(v / 2, "m/s", "a velocity at which it stays lower"),
            criterion("its height", lambda slow: slow**2 / 20, below=v**2 / 40, unit="m"),
            draws=lambda slow: Drawing(f"The path for {slow:g} m/s."),
        ),
    )
