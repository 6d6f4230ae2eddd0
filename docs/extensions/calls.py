"""The directive `calls`: a table of functions for authors, each as it is called and with the first line about it."""

import inspect

from sphinx.util.docutils import SphinxDirective

from loopbook.exercises import authoring
from loopbook.exercises.kinds import MAKERS


def called(name):
    """Return the call of a function for authors, with what it takes if nothing else is said; a method has a dot before.

    >>> called("pi_controller"), called(".mistake")
    ('pi_controller()', '.mistake(sentence)')
    """
    parameters = inspect.signature(_function(name)).parameters.values()
    return f"{name}({', '.join(_parameter(one) for one in parameters if one.name != 'self')})"


def _function(name):
    return getattr(authoring.Exercise, name[1:]) if name.startswith(".") else getattr(authoring, name)


def _parameter(one):
    stars = {one.VAR_POSITIONAL: "*", one.VAR_KEYWORD: "**"}.get(one.kind, "")
    if one.default is one.empty:
        return f"{stars}{one.name}"
    default = "..." if callable(one.default) else repr(one.default).replace("'", '"')
    return f"{one.name}={default}"


class Calls(SphinxDirective):
    """Show the functions whose names are its arguments, or all kinds of answers where it has none."""

    optional_arguments = 1
    final_argument_whitespace = True

    def run(self):
        names = self.arguments[0].split() if self.arguments else MAKERS
        rows = [f"| `{called(name)}` | {inspect.getdoc(_function(name)).splitlines()[0]} |" for name in names]
        return self.parse_text_to_nodes("\n".join(["| call | what it does |", "|---|---|", *rows]))


def setup(app):
    """Join Sphinx."""
    app.add_directive("calls", Calls)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
