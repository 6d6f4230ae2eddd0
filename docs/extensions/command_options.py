"""The directive `command-options`: arguments and options of a command of `loopbook`, from the command itself."""

import typer
from sphinx.util.docutils import SphinxDirective

from exercisegrader import __main__ as grader
from exercisegrader.reports.outputs import registered
from loopbook.__main__ import app


def described(name):
    """Return the lines of a table of what a command takes."""
    command = typer.main.get_command(app).commands[name]
    lines = [f"`loopbook {name}`: {command.help}", "", "| name | meaning |", "|---|---|"]
    for parameter in command.params:
        word = parameter.opts[0] if parameter.param_type_name == "option" else parameter.name.upper()
        if word != "--help":
            lines.append(f"| `{word}` | {parameter.help}{_default(parameter)} |")
    if name == "grade":
        lines += ["", "What is written:", "", *(f"- {output.file}: {output.what}" for output in registered())]
    return lines


def _default(parameter):
    if parameter.name == "workers":  # the cores of the machine that makes the site are nobody's default
        return " All cores if not given."
    is_number = isinstance(parameter.default, int | float) and parameter.default  # the default of a switch is False
    return f" {parameter.default:g} if not given." if is_number else ""


class CommandOptions(SphinxDirective):
    """Show what a command of `loopbook` takes."""

    required_arguments = 1

    def run(self):
        self.env.note_dependency(grader.__file__)
        return self.parse_text_to_nodes("\n".join(described(self.arguments[0])))


def setup(app):
    """Join Sphinx."""
    app.add_directive("command-options", CommandOptions)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
