"""The pictures of the README, and the one that a link to the site shows, made by what they show: `make pictures`.

JupyterLab, the site and a graded course are opened in a browser as the tests do it, and what matters is cut out.
"""

import subprocess
import sys
import tempfile
from io import BytesIO
from pathlib import Path

from PIL import Image

DOCS = Path(__file__).parent
ROOT = DOCS.parent
sys.path.insert(0, str(ROOT / "tests" / "site"))

import browser  # noqa: E402 - tests/site/ has just become a place to import from
from desk import Desk, jupyterlab  # noqa: E402

CHAPTER = "10_tuning"
LESSON, ITS_CHAPTER = "predictor_at_work", "17_dead_time_compensation"
GRADED = ROOT / "examples" / "course" / "build" / "grades" / "air_heater"
STUDENT = "s1002"
PREVIEW = DOCS / "_static" / "preview.png"
SHARPNESS = 1.5  # pixels of the picture for one of the page
LARGEST = 150_000  # bytes


def save(name: str, page, parts: list, margin: int = 0) -> None:
    """Cut out the rectangle that holds all the parts, and store it with as many colours as a small file can have."""
    boxes = [part.bounding_box() for part in parts]
    x, y = (min(box[axis] for box in boxes) - margin for axis in ("x", "y"))
    right = max(box["x"] + box["width"] for box in boxes) + margin
    bottom = max(box["y"] + box["height"] for box in boxes) + margin
    clip = {"x": max(x, 0), "y": max(y, 0), "width": right - max(x, 0), "height": bottom - max(y, 0)}
    picture = Image.open(BytesIO(page.screenshot(clip=clip, animations="disabled"))).convert("RGB")
    for colours in (256, 128, 64, 32):
        picture.quantize(colours, dither=Image.Dither.NONE).save(DOCS / name, optimize=True)
        if (size := (DOCS / name).stat().st_size) < LARGEST:
            break
    print(f"docs/{name}: {picture.width} x {picture.height}, {size / 1000:.0f} kB")


def of_jupyterlab(chromium) -> None:
    """A chapter: its question and what moves. An exercise: one answer is right, one in another unit, one to come."""
    with tempfile.TemporaryDirectory() as folder, jupyterlab(Path(folder) / "desk", f"{CHAPTER}.ipynb") as lab:
        page = chromium.new_page(viewport={"width": 980, "height": 1900}, device_scale_factor=SHARPNESS)
        desk = Desk(page, lab.file)
        desk.open(lab.chapter)
        page.keyboard.press("Control+b")  # the list of files is put away
        desk.run_all()
        title = page.locator(".jp-NotebookPanel .jp-Cell").first
        bring_into_view(page, title)
        save("chapter.png", page, [title, desk.code.filter(has=page.locator(".noUi-handle")).first])

        desk.answer("10.1", "K=1.5, T=1.25, tau=...")
        statement, answer = desk.cell('exercise("10.1")'), desk.cell('exercise("10.1").check(')
        bring_into_view(page, statement)
        save("exercise.png", page, [statement, answer])
        page.close()


def bring_into_view(page, part) -> None:
    """Put a part to the top of the window, and wait until nothing moves."""
    for _ in range(2):  # the figures above it load while it comes, and push it away
        part.evaluate("part => part.scrollIntoView({block: 'start', behavior: 'instant'})")
        page.wait_for_timeout(1000)


def of_the_site(chromium) -> None:
    """A live lesson, its model wrong by what a reader has set."""
    with tempfile.TemporaryDirectory() as folder:
        site = Path(folder) / "book"
        subprocess.run([sys.executable, DOCS, site], cwd=ROOT, check=True)
        page = chromium.new_page(viewport={"width": 1280, "height": 1600}, device_scale_factor=SHARPNESS)
        page.goto((site / "chapters" / f"{ITS_CHAPTER}.html").as_uri())
        page.add_style_tag(content=".back-to-top { display: none !important }")  # it appears over what is scrolled to
        lesson = page.locator(f".lesson[data-lesson={LESSON}] .lesson-desk")
        slider = lesson.locator("input[type=range]").first
        slider.press("ArrowRight")
        slider.blur()
        bring_into_view(page, lesson)
        save("lesson.png", page, [lesson])
        page.close()
        the_preview(chromium, site)


def the_preview(chromium, site: Path) -> None:
    """What is shown where somebody shares a link to the site: its name, and the lesson of the front page."""
    page = chromium.new_page(viewport={"width": 1000, "height": 525}, device_scale_factor=1.2)
    page.goto((site / "index.html").as_uri())
    page.evaluate(
        """() => {
            const desk = document.querySelector(".lesson"), title = document.createElement("h1");
            title.textContent = "loopbook · process control, computed";
            title.style.margin = "0 0 0.6rem";
            const whole = document.createElement("div");
            whole.style.cssText = "position: fixed; inset: 0; z-index: 1000; padding: 1.2rem 2rem; background: white";
            whole.append(title, desk);
            document.body.append(whole);
            for (const part of desk.querySelectorAll(".lesson > p, .lesson > ol, .lesson-buttons")) part.remove();
        }"""
    )
    page.wait_for_timeout(1000)
    page.screenshot(path=PREVIEW)
    Image.open(PREVIEW).convert("RGB").quantize(64, dither=Image.Dither.NONE).save(PREVIEW, optimize=True)
    print(f"{PREVIEW.relative_to(ROOT)}: {PREVIEW.stat().st_size / 1000:.0f} kB")
    page.close()


def of_a_graded_course(chromium) -> None:
    """A page of feedback for a student with a mistake in every answer: the first three exercises."""
    subprocess.run(["make", "grade"], cwd=ROOT, check=True, stdout=subprocess.DEVNULL)
    page = chromium.new_page(viewport={"width": 900, "height": 1400}, device_scale_factor=SHARPNESS)
    page.goto(next((GRADED / "feedback" / STUDENT).glob("*.html")).as_uri())
    save("feedback.png", page, [page.locator("h1"), page.locator("ul.verdicts").nth(2)], margin=16)
    page.close()


if __name__ == "__main__":
    with browser.opened() as chromium:
        of_jupyterlab(chromium)
        of_the_site(chromium)
        of_a_graded_course(chromium)
