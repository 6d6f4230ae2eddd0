"""The reports of grading in a browser: on a phone, in the dark, on paper, and for those who cannot see them."""

import pytest

from browser import DESKTOP, PATIENCE, PHONE, Complaints, serious
from exercisegrader.lateness import Lateness
from exercisegrader.marking import Marked
from exercisegrader.overrides import Mark
from exercisegrader.reports import write_all
from exercisegrader.results import OWNER, Look
from small_class import CLASS, HOSTILE, MISSING, NAMED, STOPPED, TITLE, by_hand, changed

PAGES = ("summary.html", "to_mark/A.html", *(f"feedback/{student.id}/feedback.html" for student in CLASS))


@pytest.fixture(scope="class")
def folder(tmp_path_factory):
    """The reports of a class of which everything is to be said that can be."""
    folder = tmp_path_factory.mktemp("grades")
    (folder / "notebooks").mkdir()
    (folder / "notebooks" / "s1002.html").write_text("<title>kept</title>")
    somebody_elses = changed(NAMED, owner="s1001", looks=(Look(OWNER, "it names another student: s1001"),))
    late = Marked.of(
        somebody_elses.result, {("2", ""): Mark(0.5, HOSTILE)}, Lateness(0.2, "handed in 2 days late", "it is late")
    )
    marks = [by_hand({("3", "why"): Mark(1)}), late, STOPPED, MISSING]
    write_all(folder, TITLE, CLASS, marks, [f"{HOSTILE[:30]}: belongs to nobody", "x" * 300], ["the numbers differ"])
    return folder


class TestReports:
    @pytest.mark.parametrize("scheme", ["light", "dark"])
    @pytest.mark.parametrize("file", PAGES)
    def test_a_page_fits_a_phone_and_can_be_read_by_everybody(self, chromium, folder, file, scheme):
        page = chromium.new_page(viewport=PHONE, color_scheme=scheme)
        page.set_default_timeout(PATIENCE)
        complaints = Complaints(page)
        page.goto((folder / file).as_uri())
        page.evaluate("document.querySelectorAll('details').forEach(one => one.open = true)")
        assert page.evaluate("document.documentElement.scrollWidth") <= PHONE["width"]
        assert serious(page) == []
        assert complaints == []
        assert page.evaluate("[...document.images].every(one => one.naturalWidth > 0)")
        page.close()

    def test_what_is_folded_is_printed(self, chromium, folder):
        page = chromium.new_page(viewport=DESKTOP)
        page.goto((folder / "feedback" / "s1002" / "feedback.html").as_uri())
        question = page.locator("details p").first
        assert not question.is_visible()
        page.emulate_media(media="print")
        assert question.is_visible()
        assert question.bounding_box()["height"] > 0
        page.close()

    def test_the_summary_leads_to_the_page_and_the_page_to_the_notebook(self, chromium, folder):
        page = chromium.new_page(viewport=DESKTOP)
        page.goto((folder / "summary.html").as_uri())
        page.get_by_role("link", name="Bob Bode").first.click()
        page.get_by_role("link", name="notebook as it ran").click()
        page.wait_for_url("**/notebooks/s1002.html")
        assert page.title() == "kept"
        page.close()
