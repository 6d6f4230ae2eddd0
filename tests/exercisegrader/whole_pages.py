"""What the tests ask of a page: that it is valid, needs nothing but itself, and runs nothing."""

import html.parser
import re


class Checker(html.parser.HTMLParser):
    """Complains about what is no valid page of ours; collects tags, attributes and text."""

    VOID = ("meta", "br", "hr", "img")

    def __init__(self, text):
        super().__init__()
        self.open, self.tags, self.attributes, self.pieces = [], [], [], []
        self.feed(text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag, attributes):
        assert len({name for name, _ in attributes}) == len(attributes)
        self.tags.append(tag)
        self.attributes += attributes
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attributes):
        self.tags.append(tag)
        self.attributes += attributes

    def handle_endtag(self, tag):
        if tag not in self.VOID:
            assert self.open.pop() == tag

    def handle_data(self, data):
        self.pieces.append(data)

    @property
    def text(self):
        """All that can be read."""
        return "".join(self.pieces)


def assert_whole(text):
    """A page is valid, fetches and runs nothing, and leads to files beside it alone; returns the checker."""
    checked = Checker(text)
    assert text.startswith('<!DOCTYPE html>\n<html lang="en">')
    assert checked.tags.count("title") == checked.tags.count("h1") == checked.tags.count("main") == 1
    assert not {"script", "link", "iframe", "object", "form", "base"} & set(checked.tags)
    assert not [name for name, _ in checked.attributes if name.startswith("on")]
    pictures = [value for name, value in checked.attributes if name == "src"]
    assert all(re.fullmatch(r"data:image/png;base64,[\w+/]+=*", value) for value in pictures)
    assert len(pictures) == checked.tags.count("img") == [name for name, _ in checked.attributes].count("alt")
    addresses = [value for name, value in checked.attributes if name in ("href", "xlink:href", "action")]
    assert all(re.fullmatch(r"#[\w-]+|(?!/)[\w%@./~-]+", value) for value in addresses), addresses
    identifiers = [value for name, value in checked.attributes if name == "id"]
    assert len(set(identifiers)) == len(identifiers)
    text.encode()
    assert re.search(r"[\x00-\x09\x0b-\x1f\x7f-\x9f\u202e]", text) is None
    return checked
