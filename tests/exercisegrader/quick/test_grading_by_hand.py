"""What a person marks, as it comes off the student's process and onto the sheet."""

import pytest
from matplotlib import pyplot

from drawings import Drawing, png
from exercisebook.png import as_data
from exercisegrader.inside import answer_sheet
from exercisegrader.inside.plain import LONGEST_TEXT, plain, unreadable


@pytest.fixture
def axes():
    drawn, axes = pyplot.subplots()
    axes.plot([0, 1], [0, 1])
    yield axes
    pyplot.close(drawn)


def test_a_figure_becomes_plain_data_once(axes):
    for value in (axes, pyplot, Drawing(), png()):
        data = plain(value)
        assert list(data) == ["png"]
        assert plain(data) == data


def test_what_is_damaged_or_too_long_is_unreadable():
    assert unreadable(plain(as_data(png()[:-5])))
    assert "5001 characters" in unreadable(plain("x" * (LONGEST_TEXT + 1)))


def test_the_sheet_shows_what_was_taken_down(axes):
    sheet = answer_sheet.AnswerSheet("T", student="s1")
    sheet.asks("1", sketch=answer_sheet.figure(), why=answer_sheet.text(5))
    box = sheet.answer("1", sketch=axes, why="one two three four five six")
    assert "· why: one two three four five six, 6 words, where at most 5 are asked for" in repr(box)
    assert "· sketch: a figure of " in repr(box)
    data = sheet.taken("1")["sketch"]["png"]
    assert f'src="data:image/png;base64,{data}"' in box._repr_html_()
    assert data not in sheet._repr_html_()
    wrong = sheet.answer("1", why=axes, sketch="plot.png")
    assert "? sketch: this is not a figure" in repr(wrong)
    assert "? why: this is not a text" in repr(wrong)
