"""The sources of a notebook, read from whatever is handed in."""

import contextlib
import io
import json

import nbformat
import pytest
from hypothesis import given
from hypothesis import strategies as st

from exercisegrader import GradingError, sources
from exercisegrader.events import Outcome
from exercisegrader.imprint import cells_of, what_it_is
from exercisegrader.results import JudgedAnswer, JudgedExercise, looks
from exercisegrader.sources import MOST, answered


def read(content):
    """What is read from a file of these bytes."""
    return json.loads(sources.sources(io.BytesIO(content)))


def refused(content):
    """The sentence with which a file of these bytes is refused."""
    with pytest.raises(GradingError) as raised:
        sources.sources(io.BytesIO(content))
    assert "\n" not in str(raised.value)
    return str(raised.value)


def code(source, **more):
    return {"cell_type": "code", "metadata": {}, "execution_count": 7, "source": source, **more}


def notebook(*cells, **more):
    return {"nbformat": 4, "nbformat_minor": 5, "metadata": {}, "cells": list(cells), **more}


def written(*cells, **more):
    return json.dumps(notebook(*cells, **more)).encode()


def of_code(read):
    return [cell["source"] for cell in read["cells"] if cell["cell_type"] == "code"]


def test_outputs_change_nothing():
    bare = written(code("x = 1", outputs=[]), {"cell_type": "markdown", "source": ["# A\n", "b"]})
    image = {"output_type": "display_data", "data": {"image/png": "iVBOR" * 1000, "text/plain": ['["}\\', "]"]}}
    full = written(
        code("x = 1", outputs=[image, {"text": 'a"\\'}], id="a", metadata={"execution": {"at": "noon"}}),
        {"cell_type": "markdown", "source": ["# A\n", "b"], "attachments": {"a.png": {"image/png": "AAAA" * 1000}}},
        metadata={"widgets": {"state": [{"source": "no"}]}, "kernelspec": {"language": "python", "name": "other"}},
    )
    assert sources.sources(io.BytesIO(bare)) == sources.sources(io.BytesIO(full))
    cells = read(full)["cells"]
    assert [(cell["cell_type"], cell["source"]) for cell in cells] == [("code", "x = 1"), ("markdown", "# A\nb")]


def test_what_the_grader_looks_at_is_kept_and_nothing_else():
    named = {"student": "s1", "assignment": "a", "version": "1", "released": "x", "numbers": {"1": "proof"}}
    hostile = {"other": [[]], "numbers": {"1": "proof", "2": [[]]}}
    assert read(written(metadata={"loopbook": named | hostile}))["metadata"]["loopbook"] == named
    assert "loopbook" not in read(written(metadata={"loopbook": {"student": ["s1"]}}))["metadata"]


@pytest.mark.parametrize(
    "encoding", ["utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be", "utf-32", "utf-32-le", "utf-32-be"]
)
def test_encodings(encoding):
    text = 'y = "\\ud83d\\ude00 \U0001f600 größer" # \\\\ \\/ é'
    content = json.dumps(notebook(code(text)), ensure_ascii=False)
    assert of_code(read(content.encode(encoding))) == [text]


def test_the_last_of_two_counts_as_everywhere():
    content = b'{"nbformat": 3, "nbformat": 4, "c\\u0065lls": [{"cell_type": "markdown", "source": 1, '
    content += b'"cell_type": "code", "source": ["b"], "source": "a"}]}'
    assert of_code(read(content)) == ["a"]


START = b'{"nbformat": 4, "cells": [{"cell_type": "code", "source": "1", "outputs": '


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (b"", "it is empty"),
        (b"  \n", "it is empty"),
        (b"<html></html>", "Expecting value: line 1 column 1 (char 0)"),
        (b"[1]", "it is no dictionary"),
        (b"PK\x03\x04\xff\xfe", "it is no text in UTF-8"),
        (b'{"nbformat": 4}', "it has no list of cells"),
        (b'{"nbformat": 4, "cells": {"a": 1}}', "it has no list of cells"),
        (b'{"nbformat": 3, "worksheets": [1]}', "it is of before 2015: open and save it in Jupyter"),
        (b'{"nbformat": 4, "cells": [], "metadata": []}', "its metadata are no dictionary"),
        (b'{"nbformat": "4", "cells": []}', "it has no number nbformat"),
        (b'{"nbformat": 4, "cells": []} x', "Extra data"),
        (b'{"nbformat": 4, "cells": [1]}', "it has a cell without a type"),
        (b'{"nbformat": 4, "cells": [{}]}', "it has a cell without a type"),
        (b'{"nbformat": 4, "cells": [{"cell_type": "code"}]}', "it has a code cell without a source"),
        (b'{"nbformat": 4, "cells": [{"cell_type": "code", "source": [1]}]}', "it has a code cell without a source"),
        (START + b"[1,]", "Expecting value"),
        (START + b'["', "Unterminated string"),
        (START + b"[" * 10**5, "it has too many brackets one in another"),
        (START + b'{"a":' * 10**5, "it has too many brackets one in another"),
        (START + b"1" * 10**6, "Exceeds the limit"),
        (START + b"[]," * 5 * 10**6, "it has more than 4000000 brackets"),
        (b'{"nbformat": 4, "cells": [{"cell_type": "code", "source": "' + b"x" * MOST + b'"}]}', "more than 10 MiB"),
    ],
)
def test_what_is_no_notebook(content, says):
    assert says in refused(content)
    assert refused(content).startswith("the file is not a notebook that can be read: ")


def test_another_language():
    for metadata in ({"kernelspec": {"language": "julia"}}, {"kernelspec": None, "language_info": {"name": "julia"}}):
        assert refused(written(metadata=metadata)) == "the notebook is written in julia: expected Python"


@given(st.binary(max_size=3), st.integers(0, 10**6))
def test_damage_is_a_sentence(noise, place):
    content = bytearray(written(code("a", outputs=[{"b": [1.5e3, "c\\u00e9", True, {}, [[]]]}, None, float("nan")])))
    place %= len(content)
    content[place : place + 1] = noise
    try:
        json.loads(content)
    except ValueError:
        assert refused(bytes(content))
    else:
        with contextlib.suppress(GradingError):  # as where a name is another one now
            read(bytes(content))


def test_a_file_beyond_all_is_not_read():
    assert refused(b" " * 60 * 2**20) == "the file is larger than 50 MiB: expected one without its outputs"


@pytest.mark.parametrize(
    ("source", "names"),
    [
        ('sheet.answer("2", F=-4, a=...)', {"F"}),
        ('sheet.answer("2", "-k*v", "-k*v/m")', {""}),
        ('# sheet.answer("2", F=3)', {"F"}),
        ('sheet.answer("2", F=[-1, -2], **{"a": None})', {"F"}),
        ('def later():\n    sheet.answer("2", F=3)', {"F"}),
        ('%%script false\nsheet.answer("2", F=3)', {"F"}),
        ('print("F =", 3)', set()),
        ('sheet.answer("2", F=..., a=None)', set()),
    ],
)
@pytest.mark.parametrize("kind", ["code", "markdown", "raw"])
def test_what_is_answered_in_the_text_is_seen_wherever_it_stands(source, names, kind):
    content = json.dumps({"cells": [{"cell_type": kind, "source": source}]}).encode()
    assert answered(content) == ({"2": names} if names else {})


NOTHING = JudgedExercise("2", "", 2, "", (), (JudgedAnswer("F", "open", "", None, "3"),))


@pytest.mark.parametrize(
    ("written", "outcome", "if_empty", "says"),
    [
        ({"2": {"F"}}, Outcome(), "", "exercise 2 is answered in the text of the notebook alone"),
        ({"2": {""}}, Outcome(), "", "exercise 2 is answered in the text of the notebook alone"),
        ({"2": {"F"}}, Outcome(errors=((3, "NameError"),)), "", ""),
        ({"1": {"F"}}, Outcome(), "", ""),
        ({}, Outcome(), "", ""),
        ({}, Outcome(), "is it another notebook?", "is it another notebook?"),
        ({}, Outcome(answers={"2": {"F": 1}}), "is it another notebook?", ""),
    ],
)
def test_answers_that_do_not_arrive_are_told(written, outcome, if_empty, says):
    found = looks("s1", outcome, [NOTHING], written, (), if_empty)
    assert [one.says.startswith(says) for one in found] == ([True] if says else [])


def test_a_notebook_that_answers_nothing_says_what_it_is():
    cells = [nbformat.v4.new_code_cell("print(2)")]
    notebook = nbformat.v4.new_notebook(cells=cells)

    def is_told(released):
        notebook.metadata["loopbook"] = {"assignment": "heater", "student": "s1", "released": released}
        return what_it_is(sources.sources(io.BytesIO(nbformat.writes(notebook).encode())))

    assert is_told(cells_of(notebook)) == ""
    assert is_told("as it was before") == "it answers nothing, though somebody has worked in it"
    del notebook.metadata["loopbook"]
    assert "is it another notebook" in what_it_is(sources.sources(io.BytesIO(nbformat.writes(notebook).encode())))
    assert what_it_is(b"") == ""
