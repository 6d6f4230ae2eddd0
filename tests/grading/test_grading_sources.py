"""The sources of a notebook, read from a file of any size: the same that `json.loads` would have given, and no harm."""

import io
import json
import tracemalloc

import pytest
from hypothesis import given
from hypothesis import strategies as st

from exercisegrader import GradingError, sources
from exercisegrader.sources import DEEPEST, MOST


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


def test_what_the_grader_looks_at_is_kept():
    named = {"student": "s1", "numbers": {"K": ["1/3", 2.5e-3, None, True]}}
    assert read(written(metadata={"loopbook": named}))["metadata"]["loopbook"] == named


@pytest.mark.parametrize(
    "encoding", ["utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be", "utf-32", "utf-32-le", "utf-32-be"]
)
@pytest.mark.parametrize("piece", [1, 2, 3, 5, 7, 64, 10**6])
def test_encodings_in_pieces_of_any_size(monkeypatch, encoding, piece):
    monkeypatch.setattr(sources, "_PIECE", piece)
    text = 'y = "\\ud83d\\ude00 \U0001f600 größer" # \\\\ \\/ é'
    content = json.dumps(notebook(code(text, outputs=[text, -1.5e-7, [], {}, {"a": [None]}])), ensure_ascii=False)
    assert of_code(read(content.encode(encoding))) == [text]


def test_the_last_of_two_counts_as_everywhere():
    content = b'{"nbformat": 3, "cells": 5, "nbformat": 4, "c\\u0065lls": [{"cell_type": "markdown", "source": 1, '
    content += b'"cell_type": "code", "source": ["b"], "source": "a"}], "metadata": []}'
    says = refused(content)
    assert says == "the file is not a notebook that can be read: its metadata are no dictionary"
    assert of_code(read(content.replace(b"[]}", b"{}}"))) == ["a"]


def test_notebooks_of_before_2015():
    old = {"nbformat": 3, "metadata": {"name": "x"}, "worksheets": []}
    old["worksheets"] = [
        {"cells": [{"cell_type": "code", "input": ["x = 1\n", "y"], "outputs": [1], "language": "python"}]},
        {"cells": [{"cell_type": "heading", "level": 2, "source": "A"}, {"cell_type": "code", "input": "z"}]},
    ]
    assert of_code(read(json.dumps(old).encode())) == ["x = 1\ny", "z"]


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (b"", "it is empty"),
        (b"  \n", "it is empty"),
        (b"<html></html>", "at character 1: expected {, found '<'"),
        (b"[1]", "expected {, found '['"),
        (b"PK\x03\x04\xff\xfe", "it is no text in UTF-8"),
        (b'{"nbformat": 4}', "it has no list of cells"),
        (b'{"nbformat": 4, "cells": {"a": 1}}', "it has no list of cells"),
        (b'{"cells": []}', "it has no number nbformat"),
        (b'{"nbformat": "4", "cells": []}', "it has no number nbformat"),
        (b'{"nbformat": 4, "cells": []} x', "something after its end"),
        (b'{"nbformat": 4, "cells": [1]}', "a cell that is no dictionary"),
        (b'{"nbformat": 4, "cells": [{}]}', "a cell has no type"),
        (b'{"nbformat": 4, "cells": [{"cell_type": "code"}]}', "a cell has no source"),
        (b'{"nbformat": 4, "cells": [{"cell_type": "code", "source": [1]}]}', "a cell has no source"),
        (b'{"nbformat": 4, "cells": [{"cell_type": "code", "outputs": [}', "expected a value"),
        (b'{"nbformat": 4, "cells": [{"cell_type": "code", "outputs": [1,]', "expected a value"),
        (b'{"nbformat": 4, "cells": [{"cell_type": "code", "outputs": ["\n"]', "a sign that no text has"),
        (b'{"nbformat": 4, "cells": [{"cell_type": "code", "outputs": ["\\x"]', "a sign that no text has"),
        (b'{"nbformat": 4, "cells": [{"cell_type": "code", "outputs": ["', "it ends before it should"),
        (b'{"nbformat": 4, "cells": [{"cell_type": "code", "outputs": [nul', "expected a value"),
        (b'{"nbformat": 4, "cells": [', "at character 27: it ends before it should"),
        (b'{"nbformat": 4, "cells": [{"cell_type": "code", "outputs": [01]', "expected , or ], found '1'"),
    ],
)
def test_what_is_no_notebook(content, says):
    assert says in refused(content)
    assert refused(content).startswith("the file is not a notebook that can be read: ")


def test_another_language():
    for metadata in ({"kernelspec": {"language": "julia"}}, {"kernelspec": None, "language_info": {"name": "julia"}}):
        assert refused(written(metadata=metadata)) == "the notebook is written in julia: expected Python"


# What json.loads takes is taken, with the same result; and nothing else.

VALUES = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(), lambda one: st.lists(one) | st.dictionaries(
        st.text() | st.sampled_from(["cells", "source", "outputs"]), one), max_leaves=20,
)  # fmt: skip


@given(
    st.lists(
        st.fixed_dictionaries({"source": st.text() | st.lists(st.text())}, optional={"outputs": VALUES, "x": VALUES})
    ),
    VALUES,
    st.sampled_from([(None, None), (1, None), ("\t", (" , ", " :\r\n"))]),
    st.booleans(),
    st.integers(1, 40),
)
def test_the_same_sources_as_with_everything_in_memory(cells, more, form, ascii_only, piece):
    indent, separators = form
    whole = notebook(*({"cell_type": "code"} | cell for cell in cells), more=more)
    try:
        content = json.dumps(whole, indent=indent, separators=separators, ensure_ascii=ascii_only).encode()
    except UnicodeEncodeError:
        return
    before, sources._PIECE = sources._PIECE, piece
    try:
        assert of_code(read(content)) == ["".join(cell["source"]) for cell in json.loads(content)["cells"]]
    finally:
        sources._PIECE = before


@given(st.data(), st.integers(1, 40))
def test_damage_is_found_wherever_json_loads_finds_it(data, piece):
    content = bytearray(
        written(code("a", outputs=[{"b": [1.5e3, -2, "c\\u00e9", True, {}, [[]]]}, None, float("nan")]))
    )
    place = data.draw(st.integers(0, len(content) - 1))
    noise = data.draw(
        st.sampled_from([b"", b"}", b"]", b",", b'"', b"\\", b"1", b".", b"e", b"\x01", b" ", b"[", b":"])
    )
    content[place : place + 1] = noise
    try:
        json.loads(content)
        broken = False
    except ValueError:
        broken = True
    before, sources._PIECE = sources._PIECE, piece
    try:
        try:
            read(bytes(content))
            says = ""
        except GradingError as problem:
            says = str(problem)
    finally:
        sources._PIECE = before
    assert "\n" not in says
    if broken:
        assert says


# Hostile files.


def memory(content):
    """The most memory (bytes) that reading takes, and the sentence with which it ends."""
    stream = io.BytesIO(content)
    tracemalloc.start()
    try:
        sources.sources(stream)
        says = ""
    except GradingError as problem:
        says = str(problem)
    finally:
        _, most = tracemalloc.get_traced_memory()
        tracemalloc.stop()
    return most, says


START = b'{"nbformat": 4, "cells": [{"cell_type": "code", "source": "1", '


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (START + b'"outputs": ["' + b"A" * 30_000_000 + b'"]}]}', ""),
        (START + b'"outputs": ["' + b"\\n" * 5_000_000 + b'"]}]}', ""),
        (START + b'"' + b"k" * 10_000_000 + b'": 1}]}', ""),
        (START + b'"outputs": ' + b"[" * 10**7, f"more than {DEEPEST} brackets one in another"),
        (START + b'"source": ' + b'{"a":' * 10**6, f"more than {DEEPEST} brackets one in another"),
        (START + b'"outputs": [' + b"1" * 10**7, "a number without an end"),
        (START + b'"source": "' + b"x" * 2 * MOST + b'"}]}', "more than 10 MiB without its outputs"),
        (START + b'"metadata": {}}]' + b"}" * 10**6, "something after its end"),
        (b'{"nbformat": 4, "cells": [' + b"{}," * 200_000, "more than 10 MiB without its outputs"),
        (b'{"nbformat": 4, "metadata": {"loopbook": "' + b"x" * 2 * MOST + b'"}}', "more than 10 MiB"),
    ],
)
def test_no_file_takes_much_memory(content, says):
    most, said = memory(content)
    assert most < 60 * 2**20
    assert says in said
    assert bool(says) == bool(said)


def test_values_one_by_one_have_an_end(monkeypatch):
    monkeypatch.setattr(sources, "MOST_VALUES", 1000)
    assert of_code(read(START + b'"outputs": [' + b"[1, 2], " * 10_000 + b"{}]}]}")) == ["1"]
    assert "more than 1000 values" in refused(START + b'"outputs": [' + b"[[[1]]], " * 10_000 + b"{}]}]}")
