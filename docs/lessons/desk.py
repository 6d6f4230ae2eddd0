"""The desk of a lesson as HTML: sliders, pictures as they are at the start, and the result; whole without a script."""

import html
import json

from lessons import moving
from lessons.shapes import TALL, WIDE, drawn
from lessons.wording import plain

WAIT = "The sliders need JavaScript; this is how it looks at the start. In JupyterLab, the chapter's own sliders move."


def desk(name, record):
    """Return the desk of a lesson as HTML.

    Arguments:
        name: of the lesson, for the ids of its sliders.
        record: as the lesson's ``record()`` returns it.
    """
    data = record["data"]
    seen = moving.view(data)
    sliders = "\n".join(control(name, slider) for slider in record["sliders"])
    said = result(seen.verdict, data["labels"], seen.results)
    told = ", ".join(filter(None, [plain(seen.verdict), *map(spoken, data["labels"], seen.results)]))
    pictures = "\n".join(picture(number, data, seen, told) for number in range(len(data["panels"])))
    if seen.image:
        source = f'alt="{html.escape(told)}" src="data:image/png;base64,{seen.image}"'
        pictures += f'<div class="lesson-image"><img class="lesson-drawing" {source}></div>'
    keep = '<button type="button" class="lesson-keep" aria-pressed="false">Keep these curves in grey</button>'
    keep = keep if data["panels"] else ""
    words = (
        '<p class="lesson-words" aria-live="polite" title="Settled: it stays within 5 % of its change"></p>'
        if data["panels"]
        else ""
    )
    silent = "" if said or any(data["verdicts"]) else " hidden"
    lines = any(data["verdicts"]) + (len(data["labels"]) + 1) // 2
    return f"""<div class="lesson-desk">
<div class="lesson-controls">
{sliders}
<div class="lesson-buttons">
{keep}
<button type="button" class="lesson-reset">Back to the start</button>
</div>
</div>
<noscript><p>{WAIT}</p></noscript>
<p class="lesson-result" aria-live="polite" style="--lines: {lines}"{silent}>{said}</p>
{pictures}
{words}
</div>"""


def spoken(label, text):
    """A result in words."""
    return f"{plain(label)} {plain(text)}"


def result(verdict, labels, results):
    """The line of results; lessons.js writes the same."""
    pairs = (f"<span>{label} <b>{text}</b></span>" for label, text in zip(labels, results, strict=True))
    return " ".join([*([f"<strong>{verdict}</strong>"] if verdict else []), *pairs])


def control(lesson, slider):
    """A slider with its label and value, or a list to choose from where the values are words."""
    name, shown, first = f"lesson-{lesson}-{slider['name']}", slider["shown"], slider["first"]
    label = f'<label for="{name}">{slider["label"]}</label>'
    if slider["list"]:
        chosen = (" selected" if number == first else "" for number in range(len(shown)))
        options = "".join(
            f'<option value="{number}"{mark}>{html.escape(plain(text))}</option>'
            for number, (text, mark) in enumerate(zip(shown, chosen, strict=True))
        )
        return f'<div class="lesson-slider">{label}<select id="{name}" autocomplete="off">{options}</select></div>'
    texts = html.escape(json.dumps(shown, ensure_ascii=False))
    return (
        f'<div class="lesson-slider">{label}<output for="{name}">{html.escape(shown[first])}</output>'
        f'<input type="range" id="{name}" min="0" max="{len(shown) - 1}" step="1" value="{first}" '
        f'autocomplete="off" aria-valuetext="{html.escape(shown[first])}" data-texts="{texts}"></div>'
    )


def picture(number, data, seen, told):
    """One panel: its legend, with the lines as they are drawn, and the panel itself."""
    panel, (across, up), shapes = data["panels"][number], seen.axes[number], seen.shapes
    items = [(k, item) for k, item in enumerate(data["items"]) if item["panel"] == number]
    legend = "".join(explained(k, item, shapes[k]) for k, item in items if item["label"])
    title = f'<p class="lesson-panel-title">{panel["title"]}</p>\n' if panel["title"] else ""
    longest = max(len(plain(text)) for axes in data["axes"] for _, rows in axes for _, text in [*rows, (0, "")])
    grid = f'<path class="lesson-grid" d="{lines_of_grid(across, up)}"/>' if panel["grid"] else ""
    kept = "".join(f'<path data-kept="{k}"/>' for k, item in items if item["kind"] == "line")
    paths = "".join(path(k, item, shapes[k]) for k, item in items)
    names = ", ".join(plain(item["label"]) for _, item in items if item["label"])
    clock = next(one["clock"] for one in data["panels"][number:] if one["clock"])
    spoken = f"{plain(panel['axis'])} against {plain(clock)}{': ' if names else ''}{names}. {told}"
    many = " lesson-many" if len(across) > 6 else ""
    up_texts = "".join(f'<span style="bottom: {100 * share:.2f}%">{text}</span>' for share, text in up)
    across_texts = "".join(f'<span style="left: {100 * share:.2f}%">{text}</span>' for share, text in across)
    words = "".join(word(one) for one in seen.words if one[0] == number)
    return (
        f'<div class="lesson-picture" style="--height: {panel["height"]}px; --digits: {longest}">{title}'
        + (f'<ul class="lesson-legend">{legend}</ul>\n' if legend else "")
        + f'<div class="lesson-plot" role="img" aria-label="{html.escape(spoken)}">'
        f'<span class="lesson-axis">{panel["axis"]}</span>'
        f'<div class="lesson-frame{many}"><svg viewBox="0 0 {WIDE} {TALL}" preserveAspectRatio="none" '
        f'aria-hidden="true">{grid}<g class="lesson-kept">{kept}</g>{paths}</svg><div class="lesson-y">{up_texts}</div>'
        + (f'<div class="lesson-x">{across_texts}</div>' if panel["clock"] else "")
        + f"{words}</div>"
        + (f'<span class="lesson-clock">{panel["clock"]}</span>' if panel["clock"] else "")
        + "</div></div>"
    )


def lines_of_grid(across, up):
    """The path of the lines behind a picture."""
    upright = "".join(f"M{round(share * WIDE)} 0V{TALL}" for share, _ in across)
    return upright + "".join(f"M0 {round((1 - share) * TALL)}H{WIDE}" for share, _ in up)


def ink(item):
    """The colours of an item, for a light and for a dark page, and its line."""
    style = f"--light: {item['light']}; --dark: {item['dark']}"
    if "edge" in item:
        style += f"; --edge: {item['edge']}; --dark-edge: {item['darkEdge']}"
    if "width" in item:
        style += f"; stroke-width: {item['width']}px"
    if item.get("dash"):
        style += f"; stroke-dasharray: {' '.join(map(str, item['dash']))}"
    return style


def path(number, item, shape):
    """A line, an area or points of a picture."""
    kind = item["kind"] + (" lesson-crisp" if item.get("crisp") else "") + (" lesson-edged" if "edge" in item else "")
    d = drawn(shape, closed=item["kind"] == "area")
    return f'<path class="lesson-{kind}" data-item="{number}" style="{ink(item)}" d="{d}"/>'


def explained(number, item, shape):
    """An entry of a legend."""
    if item["kind"] == "line":
        sign = '<path class="lesson-line" d="M0 6H40"'
    elif item["kind"] == "area":
        edged = " lesson-edged" if "edge" in item else ""
        sign = f'<path class="lesson-area{edged}" d="M8 1H32V11H8Z"'
    else:
        sign = '<path class="lesson-dots" d="M20 6L20 6"'
    hidden = "" if shape else " hidden"
    svg = f'<svg width="40" height="12" aria-hidden="true">{sign} style="{ink(item)}"/></svg>'
    return f'<li data-item="{number}"{hidden}>{svg} {item["label"]}</li>'


def word(one):
    """Words in a picture."""
    _, left, top, right, down, side, level, text = one
    moved = f"translate(calc({side}% + {right}px), calc({level}% + {down}px))"
    return f'<span class="lesson-word" style="left: {left}%; top: {top}%; transform: {moved}">{text}</span>'
