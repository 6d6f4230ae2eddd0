"""A figure in a notebook: shown once, as a picture with a description."""

import nbclient
import nbformat


def test_a_notebook_shows_a_figure_exactly_once():
    cells = [
        "import matplotlib.pyplot as plt\nfrom loopbook import s, t\nfrom loopbook.diagrams import block_diagram\n"
        "from loopbook.figures import time_plot",
        'time_plot({"$y(t)$": t}, [0, 1, 2], title="Figure 6.1")',
        'block_diagram("u", 1 / s, "y", title="Figure 5.2")',
    ]
    notebook = nbformat.v4.new_notebook(cells=[*map(nbformat.v4.new_code_cell, cells)])
    nbclient.NotebookClient(notebook, timeout=60, kernel_name="python3").execute()
    assert notebook.cells[0].outputs == []
    expected = ["Figure 6.1: y(t) against t [s]", "Figure 5.2: block diagram: u → [1/s] → y"]
    for cell, words in zip(notebook.cells[1:], expected, strict=True):
        (output,) = cell.outputs
        assert set(output.data) == {"image/png", "text/plain"}
        assert output.data["text/plain"] == f"<{words}>"
        assert output.metadata["image/png"]["alt"] == words
