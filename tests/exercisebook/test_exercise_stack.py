"""Exercises as STACK questions: what the file holds, and what Maxima says of answers where it is installed."""

import pytest

from exercisebook.authoring import answers, between, exercise, expression, number, poles, time_function, word, words
from exercisebook.export import moodle
from exercisebook.export.stack import stack
from moodle_reader import has_maxima, places, read


@exercise("1.1", title="All kinds")
def asked(k=between(2, 9, reference=2)):
    "A spring of {k}."
    return answers(
        F=number(10 * k, "N", "the force"), G=expression(f"{k}*exp(-3*w)/(10*w + 1)", "the response"),
        E=expression("k*x**2/2", "the energy"), y=time_function(f"{k} - {k}*exp(-t/5)", 25, what="the way"),
        p=poles([-1 + 2j, -1 - 2j, -k]), to=word("left", ["left", "right"]), on=words(["a", "c"], "abc"),
    )  # fmt: skip


asked.mistake("Is [k] a {gain}?")(lambda k: {"G": f"{k}*exp(-3*w)/(5*w + 1)", "E": "k*x**2", "p": [-1, -k], "F": k})
#: By the name of what is asked, pairs of an answer as it is typed and its place among the known ones.
TRIED = {
    "F": [("20", 1), ("20.1", 1), ("20.3", 0), ("2", 2), ("x", 0)],
    "G": [("0.2*exp(-3*w)/(w + 0.1)", 1), ("2*exp(-3.02*w)/(10.05*w + 1)", 1), ("2*exp(-3*w)/(10.3*w + 1)", 0),
          ("2*exp(-3*w)/(5.01*w + 1)", 2), ("2*exp(-3*u)/(10*w + 1)", 0), ("1/0", 0)],
    "E": [("0.5*k*x*x", 1), ("k*x^2/2.001", 1), ("x^2*k", 2), ("-k*x^2/2", 3)],
    "y": [("2*(1 - %e^(-0.2*t))", 1), ("2.01 - 2*exp(-t/5.02)", 1), ("2 - 2*exp(-t/5.2)", 0)],
    "p": [("[-2, -1 - 2*j, -1 + 2*%i]", 1), ("[-2.01, -1 + 2*%i, -1 - 2*%i]", 1), ("[-2, -1]", 2)],
    "to": [("1", None), ("2", None)],
    "on": [("[3, 1]", 1), ("[1]", 0)],
}  # fmt: skip


@pytest.fixture(scope="module")
def found():
    (file,) = moodle.exported([[asked.question()]], "Springs", forms=[stack]).files
    return next(read(file)).element


def test_each_cell_has_an_input_a_tree_and_a_place(found):
    text = found.findtext("questiontext/text")
    for place in range(1, 8):
        assert f"[[input:ans{place}]] [[validation:ans{place}]] [[feedback:prt{place}]]" in text
    assert [one.findtext("name") for one in found.findall("input")] == [f"ans{k}" for k in range(1, 8)]
    assert [one.findtext("type") for one in found.findall("input")] == [
        "numerical", *["algebraic"] * 4, "dropdown", "checkbox"
    ]  # fmt: skip
    assert all(len(one.findtext("tans")) < 255 for one in found.findall("input"))
    for tree in found.findall("prt"):
        nodes = tree.findall("node")
        assert [node.findtext("truescore") for node in nodes] == ["1", *["0"] * (len(nodes) - 1)]
        assert [node.findtext("falsenextnode") for node in nodes] == [*map(str, range(1, len(nodes))), "-1"]
        assert [node.findtext("tans") for node in nodes] == [str(k + 1) for k in range(len(nodes))]
    assert "Is &#91;k&#93; a &#123;gain&#125;?" in [one.findtext("text") for one in found.iter("truefeedback")]


@pytest.mark.skipif(not has_maxima(), reason="Maxima is not installed")
def test_maxima_finds_an_answer_among_the_known_ones(found):
    order = asked.question().key["to"].among
    tried = [[typed for typed, _ in pairs] for pairs in TRIED.values()]
    expected = [[place for _, place in pairs] for pairs in TRIED.values()]
    expected[5] = [1 if word == "left" else 2 for word in order]
    assert places(found, dict(enumerate(tried, start=1))) == dict(enumerate(expected, start=1))


def test_what_is_exact_or_has_pieces_is_left_out():
    @exercise("2", title="Steps")
    def steps(k=between(2, 9, reference=2)):
        "For {k}."
        return answers(y=time_function("Heaviside(t - 1)", 9))

    @exercise("3", title="Exact")
    def exact(k=between(2, 9, reference=2)):
        "For {k}."
        return answers(y=expression("k*x", within=0))

    left_out = moodle.exported([[steps.question()], [exact.question()]], "Springs", forms=[stack]).left_out
    assert left_out == {"2": "a formula with steps or pieces", "3": "an exact formula"}
