"""The directive ``readme-table``: a table of README.md in a page, so that it is written once.

Its argument is the first word of the table's head.
"""

from pathlib import Path

from sphinx.util.docutils import SphinxDirective

README = Path(__file__).parents[2] / "README.md"


def table(first):
    """Return the lines of README's table whose head begins with a word.

    Raises:
        ValueError: README has no such table.
    """
    lines = README.read_text(encoding="utf-8").splitlines()
    for start, line in enumerate(lines):
        if line.startswith(f"| {first} |"):
            rows = lines[start:]
            return rows[: next((n for n, row in enumerate(rows) if not row.startswith("|")), len(rows))]
    raise ValueError(f"README.md has no table whose head begins with {first!r}")


class ReadmeTable(SphinxDirective):
    required_arguments = 1

    def run(self):
        self.env.note_dependency(str(README))
        return self.parse_text_to_nodes("\n".join(table(self.arguments[0])))


def setup(app):
    app.add_directive("readme-table", ReadmeTable)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
