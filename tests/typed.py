"""What readers type in the fields of a form, and what the HTML of a page holds."""

import html.parser

from exercisebook.kinds.kind import ORDER, PARTS, SEVERAL

EMPTY = {"img", "input", "br"}


class Read(html.parser.HTMLParser):
    """What HTML holds: its elements, its text, and whether each one is closed as it was opened."""

    def __init__(self, text):
        super().__init__()
        self.elements, self.text, self.open, self.torn = [], "", [], []
        self.feed(text)
        self.torn += self.open

    def handle_starttag(self, tag, attrs):
        self.elements.append((tag, dict(attrs)))
        if tag not in EMPTY:
            self.open.append(tag)

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            self.torn.append(tag)

    def handle_data(self, data):
        self.text += data

    def all(self, *tags):
        return [attributes for tag, attributes in self.elements if tag in tags]


def typed(kind):
    """The key of a quantity as somebody would type it in its field, or choose it."""
    given = kind.as_given
    control = kind.field["control"]
    if control == PARTS:
        return {name: one if isinstance(one, str) else f"{one:.8g}" for name, one in given.items()}
    if control == SEVERAL:
        return list(given) or ["none"]
    if control == ORDER:
        return ", ".join(given)
    return given if isinstance(given, str) else kind.as_code()


def assert_is_whole(sheet):
    """The texts of a form are HTML that is closed as it is opened, MathML and no LaTeX; each quantity has a field."""
    parts = {"text": sheet.text, "asked": sheet.asked, "accuracy": sheet.accuracy, "controls": sheet.controls}
    parts |= {f"hint {rung}": sheet.hint(rung) for rung in range(1, sheet.rungs + 1)}
    parts["solution"] = sheet.solution_text
    for name, text in parts.items():
        read = Read(text)
        assert not read.torn, name
        assert "$" not in read.text, name
        assert "\\" not in read.text.replace("\\n", ""), name
    controls = Read(parts["controls"])
    ids = [one["id"] for _, one in controls.elements if "id" in one]
    assert len(set(ids)) == len(ids)
    names = [one["data-name"] for one in controls.all("div", "fieldset") if "data-name" in one]
    assert names == list(sheet.question.key)
    assert {one["for"] for one in controls.all("label") if "for" in one} <= set(ids)
    fields = controls.all("input", "select", "textarea")
    assert {name for one in fields for name in one.get("aria-describedby", "").split()} <= set(ids)
    assert len(Read(sheet.asked).all("li")) == len(sheet.question.key)


def assert_tells_nothing(name, kind, field_of):
    """The field of a kind is the same without its key."""
    blank = object.__new__(type(kind))
    shape = kind.key if kind.maker == "numbers" else None  # whether a table is asked for is said
    blank.__dict__ |= kind.__dict__ | {"key": shape, "expr": None}
    if example := getattr(kind, "example", None):
        blank.example = example.keyless
        blank.example.what = example.what
    assert field_of(name, blank) == field_of(name, kind)
