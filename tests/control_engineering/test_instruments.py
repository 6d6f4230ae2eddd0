"""The letters of tags: the decoder against the textbook's own expansions, its words, and what it refuses."""

import string

import pytest
from hypothesis import given
from hypothesis import strategies as st

from loopbook.instruments import LETTERS, Tag, decode, letter_table, loops

WORDS = {
    # as the textbook expands them below its figures
    "LT": "level transmitter",
    "LC": "level controller",
    "FT": "flow transmitter",
    "FC": "flow controller",
    "TC": "temperature controller",
    "TT": "temperature transmitter",
    "QT": "quality transmitter",
    "FFC": "flow fraction controller",
    # and others
    "FC-123": "flow controller of loop 123",
    "FFC2": "flow fraction controller of loop 2",
    "TRC1": "temperature recording controller of loop 1",
    "TV1A": "temperature valve A of loop 1",
    "FCV3": "flow control valve of loop 3",
    "HV1": "hand valve of loop 1",
    "HS": "hand switch",
    "SIC": "speed indicating controller",
    "LAH": "high level alarm",
    "LAHH3": "high-high level alarm of loop 3",
    "LSHL2": "high and low level switch of loop 2",
    "TZHH": "high-high temperature secure control",
    "PSV1": "pressure safety valve of loop 1",
    "PSE1": "pressure safety sensing element of loop 1",
    "FQ": "flow totalizer",
    "FQI": "flow total indicator",
    "FY2": "flow function of loop 2",
    "GT": "position transmitter",
    "VT": "viscosity transmitter",
    "DT": "density transmitter",
    "TE": "temperature sensing element",
    "TDT5": "temperature difference transmitter of loop 5",
}


@pytest.mark.parametrize("tag", WORDS)
def test_a_tag_in_words(tag):
    assert decode(tag).words == WORDS[tag]
    assert repr(decode(tag)) == f"{tag}: {WORDS[tag]}"


def test_the_parts_of_a_tag():
    tag = decode("PDIC104B")
    assert (tag.measured, tag.modifier, tag.functions) == ("pressure", "difference", ("indicator", "controller"))
    assert (tag.loop, tag.suffix, tag.limit) == (104, "B", "")
    assert [part.letter for part in tag.parts] == list("PDIC")
    assert [part.place for part in tag.parts] == ["first letter", "modifier", "function", "function"]
    assert decode("LT").loop is None
    assert decode("FC007").loop == 7
    assert decode("HV1").measured == "hand controlled"


def test_the_same_letter_means_another_thing_at_another_place():
    assert [part.meaning for part in decode("TT").parts] == ["temperature", "transmitter (sensor)"]
    assert [part.meaning for part in decode("FFC").parts] == ["flow", "fraction (ratio)", "controller"]
    assert [part.meaning for part in decode("LALL").parts] == ["level", "alarm", "low", "low"]
    assert [part.meaning for part in decode("SS").parts] == ["speed", "switch"]


FIRST, SECOND = {"first letter"}, {"function"}
BOOK = {letter: FIRST for letter in "DFGHLPQSTV"} | {letter: SECOND for letter in "ACIYZ"}
BOOK |= {letter: FIRST | {"modifier"} for letter in "DF"} | {letter: FIRST | SECOND for letter in "TV"}


def test_the_textbook_s_table():
    """All letters that it prints, and no other, at their places; each of them can be reached by a tag."""
    of_the_book = {}
    for entry in LETTERS:
        if entry.source == "Table A.1":
            of_the_book.setdefault(entry.letter, set()).add(entry.place)
    assert of_the_book == BOOK
    rows = letter_table("Table A.1").rows
    assert [letter for letter, *_ in rows] == sorted(BOOK)
    assert ("D", "density; modifier: difference", "") in rows
    assert ("C", "", "controller") in rows
    assert ("A", "", "alarm") in rows


def test_no_letter_has_two_meanings_at_one_place():
    places = [(entry.letter, entry.place) for entry in LETTERS]
    assert len(set(places)) == len(places)
    assert {entry.source for entry in LETTERS} == {"Table A.1", "ISA-5.1", "ISO 3511", "ISA-5.1 and ISO 3511"}


def test_what_is_added_to_the_textbook_s_table_has_a_star():
    text = str(letter_table())
    assert "analysis *" in text
    assert "recorder *" in text
    assert "controller *" not in text
    assert "*" not in str(letter_table("Table A.1"))
    assert "<td" in letter_table()._repr_html_()


def test_a_tag_is_shown_with_and_without_a_number():
    assert "of the loop" in decode("FC123")._repr_html_()
    assert "of the loop" not in decode("PDIC")._repr_html_()


def test_a_loop_keeps_its_number():
    found = loops(["FT123", "TT124", "FC123", "TC124", "FV123"])
    assert {number: [tag.text for tag in tags] for number, tags in found.items()} == {
        123: ["FT123", "FC123", "FV123"],
        124: ["TT124", "TC124"],
    }
    with pytest.raises(ValueError, match="LT has no number, which would say what loop it belongs to"):
        loops(["LT", "LC1"])


@pytest.mark.parametrize(
    ("tag", "message"),
    [
        ("CF1", "CF1 begins with C, which means controller only after another letter: a tag begins with one of A, D"),
        ("BT", "BT begins with B, which has no meaning in a tag"),
        ("LXC", "LXC has X behind L, where it means nothing: expected one of A, C, E, G"),
        ("LHA", "LHA has H behind L"),
        ("HFC", "HFC has F behind H"),
        ("F1", "F1 does not say what is done with what it measures: there must follow A, C"),
        ("LCC", "LCC names the function C, controller, twice"),
        ("LVC", "LVC goes on behind V, valve, which is the last letter of a tag"),
        ("", "a tag has capital letters and then perhaps a loop number, as FC123, not ''"),
        ("fc123", "not 'fc123'"),
        ("FC 123", "not 'FC 123'"),
        ("FC123ab", "not 'FC123ab'"),
        ("FC-", "not 'FC-'"),
        ("ÄC1", "not 'ÄC1'"),
        ("FC１", "not 'FC１'"),
        (None, "not None"),
    ],
)
def test_a_wrong_tag_is_told_in_one_sentence(tag, message):
    with pytest.raises(ValueError, match=message) as caught:
        decode(tag)
    assert "\n" not in str(caught.value)


def test_an_unknown_source_is_told():
    with pytest.raises(ValueError, match=r"the letters are of ISA-5.1, ISA-5.1 and ISO 3511, .*, and not of 'ISO'"):
        letter_table("ISO")


@given(st.text(string.ascii_uppercase, max_size=6), st.text("0123456789", max_size=3))
def test_every_text_is_either_explained_letter_by_letter_or_refused(letters, number):
    try:
        tag = decode(letters + number)
    except ValueError:
        return
    assert isinstance(tag, Tag)
    assert "".join(part.letter for part in tag.parts) == letters
    assert tag.parts[0].place == "first letter"
    assert tag.functions
    assert all(word in tag.words for word in (tag.modifier, tag.limit))
    assert tag.loop == (int(number) if number else None)


@pytest.mark.parametrize("tags", [5, None, "FC1"])
def test_loops_are_sorted_of_a_list(tags):
    with pytest.raises(ValueError, match=r"the tags are .*: expected a list of them"):
        loops(tags)
