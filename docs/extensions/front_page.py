"""The directive ``lesson-links``: the live lessons by their titles, each with the way to its place in its chapter."""

from docutils import nodes
from lessons import PLACES, load
from sphinx.util.docutils import SphinxDirective


class LessonLinks(SphinxDirective):
    """A list of links; a lesson is a place in the page of its chapter."""

    def run(self):
        links = nodes.bullet_list(classes=["lesson-links"])
        for name, place in PLACES.items():
            title = load(name).title.removeprefix("Live: ")
            link = nodes.reference(
                "", title[0].upper() + title[1:], refuri=f"chapters/{place.chapter}.html#lesson-{name}"
            )
            links += nodes.list_item("", nodes.paragraph("", "", link))
        return [links]


def setup(app):
    app.add_directive("lesson-links", LessonLinks)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
