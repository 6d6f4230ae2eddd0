"""The directive `exercise-list`: all exercises of the bank, with what they ask for and where they can be used."""

import exercise_forms
import slugs
from sphinx.util.docutils import SphinxDirective

from exercisebook.export.cells import CannotHoldError
from exercisebook.export.moodle import cloze
from exercisebook.export.stack import stack
from exercisegrader.paper.sheets import is_too_long
from loopbook.exercises import bank


def places(question):
    """Where an exercise can be used beside a notebook, as a list of words.

    >>> places(bank.exercise("3.1")), places(bank.exercise("11.2"))
    (['paper', 'Moodle'], ['paper'])
    """
    found = [] if is_too_long(question) else ["paper"]
    for form, word in ((cloze, "Moodle"), (stack, "STACK")):
        try:
            form(question)
        except CannotHoldError:
            continue
        return [*found, word]
    return found


def listed():
    """Yield the lines of the list, in Markdown: a table for each chapter."""
    pages = exercise_forms.pages()
    for chapter in bank.chapters():
        yield from ["", f"## {bank.title(chapter)}", "", "| exercise | asks for | points | also for |"]
        yield "|---|---|---|---|"
        for number, one in bank.exercises(chapter).items():
            question = exercise_forms.sheet(number).question
            asked = dict.fromkeys(kind.maker.replace("_", " ") for kind in question.key.values())
            link = f"[{number} {one.title}](chapters/{pages[number]}.ipynb#exercise-{slugs.slug(number)})"
            yield f"| {link} | {', '.join(asked)} | {one.points:g} | {', '.join(places(question)) or '–'} |"


class ExerciseList(SphinxDirective):
    """Show the list."""

    def run(self):
        return self.parse_text_to_nodes("\n".join(listed()), allow_section_headings=True)


def setup(app):
    """Join Sphinx."""
    app.add_directive("exercise-list", ExerciseList)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
