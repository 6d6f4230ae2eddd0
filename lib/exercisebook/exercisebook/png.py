"""Figures as PNG: drawn where the figure is, looked at with suspicion wherever the bytes arrive.

Where the figure is, in the reader's own process, Pillow makes a large picture smaller. Where bytes of somebody else
arrive they are not decoded: `checked` reads the parts of the file alone, and keeps what a picture needs and nothing
else, no texts, times and whatever else a file may carry.
"""

from __future__ import annotations

import base64
import binascii
import contextlib
import io
import struct
import sys
import zlib
from typing import Any

from exercisebook.grammar import Unreadable

#: Bytes of a picture, and pixels along a side.
LARGEST, LONGEST_SIDE = 300_000, 2000
_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_NEEDED = (b"IHDR", b"PLTE", b"tRNS", b"IDAT", b"IEND")
#: With so many pixels to an inch a figure is drawn, and with so few colours where it would be too large.
_PIXELS, _COLOURS = 110.0, 64
_FEWER, _TRIES = 0.7, 8
#: What is so many times as far away as the figure is large is left out.
_NEAR = 3
_EXPECTED = "a figure of Matplotlib, as plt.gcf(), or the bytes of a PNG file"


def of_figure(value: object) -> bytes | None:
    """Return a figure as the bytes of a PNG file that `checked` accepts; None for a value that is no figure.

    A figure is one of Matplotlib, or has ``png()`` and ``alt``; axes, lines, and other things in a figure stand for it;
    so do pyplot, images of Pillow, and bytes of a PNG file. Raises Unreadable for one that cannot be made small enough.

    >>> from PIL import Image
    >>> size(of_figure(Image.new("L", (5, 3)))), of_figure("plot.png")
    ((5, 3), None)
    """
    if value is None or isinstance(value, str | int | float | complex | dict):
        return None
    content = _content(value)
    return None if content is None else _small(content)


def _content(value):
    """A PNG file of a figure; None for what is no figure."""
    if isinstance(value, bytes | bytearray | memoryview):
        return bytes(value) if bytes(value).startswith(_SIGNATURE) else None
    if callable(getattr(type(value), "png", None)) and hasattr(value, "alt"):
        return value.png()
    if (image := sys.modules.get("PIL.Image")) and isinstance(value, image.Image):
        return _stored(value)
    figure = _figure(value)
    return None if figure is None else _drawn(figure)


def as_data(content: bytes) -> dict[str, str]:
    """Return a PNG file as plain data, which `checked` reads."""
    return {"png": base64.b64encode(content).decode()}


def is_data(data: object) -> bool:
    """Whether plain data claims to be a picture.

    >>> is_data({"png": "iVBO"}), is_data({"K": 2})
    (True, False)
    """
    return isinstance(data, dict) and data.keys() == {"png"} and isinstance(data["png"], str)


def checked(data: Any) -> bytes:
    """Return the PNG file that plain data holds, without whatever is not the picture.

    Raises Unreadable for data that is none, is damaged, or is larger than allowed.

    >>> checked({"png": "iVBORw0KGgo="})
    Traceback (most recent call last):
    ...
    exercisebook.grammar.Unreadable: this picture is damaged: expected a PNG file
    """
    if not is_data(data):
        raise Unreadable(f"this is not a picture: expected {_EXPECTED}")
    if len(data["png"]) > LARGEST * 4 // 3 + 4:
        raise Unreadable(f"this picture has more than {LARGEST // 1000} kB: expected a smaller one")
    try:
        content = base64.b64decode(data["png"], validate=True)
        parts = list(_parts(content))
        width, height = struct.unpack(">II", parts[0][1][:8])
    except (binascii.Error, ValueError, struct.error, IndexError):
        raise Unreadable("this picture is damaged: expected a PNG file") from None
    if not (0 < width <= LONGEST_SIDE and 0 < height <= LONGEST_SIDE) or len(content) > LARGEST:
        raise Unreadable(
            f"this picture has {width} × {height} pixels and {len(content) / 1000:.0f} kB: expected at most "
            f"{LONGEST_SIDE} pixels along a side and {LARGEST // 1000} kB"
        )
    return _SIGNATURE + b"".join(map(_chunk, *zip(*parts, strict=True)))


def size(content: bytes) -> tuple[int, int]:
    """Return the width and the height of a PNG file in pixels."""
    return struct.unpack(">II", content[16:24])


def _parts(content):
    """The parts of a PNG file that its picture needs: pairs of a name and bytes. Raises ValueError for no whole one."""
    if not content.startswith(_SIGNATURE):
        raise ValueError("no signature")
    place, name = len(_SIGNATURE), b""
    while name != b"IEND":
        length, name = struct.unpack(">I4s", content[place : place + 8])
        data, check = content[place + 8 : place + 8 + length], content[place + 8 + length : place + 12 + length]
        if len(check) != 4 or zlib.crc32(name + data) != struct.unpack(">I", check)[0]:
            raise ValueError("damaged")
        is_first = place == len(_SIGNATURE)
        if is_first != (name == b"IHDR") or (is_first and length != 13):
            raise ValueError("no header")
        if name in _NEEDED:
            yield name, data
        elif name[:1].isupper():  # without it, another picture
            raise ValueError("unknown")
        place += 12 + length


def _chunk(name, data):
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))


def _figure(value):
    """The figure of Matplotlib that a value is, or that it is in."""
    figures = sys.modules.get("matplotlib.figure")
    if figures is None:  # then nothing is a figure yet
        return None
    if value is sys.modules.get("matplotlib.pyplot"):
        return value.gcf()
    for _ in range(3):  # of an array of axes the first, of a container its lines
        if isinstance(value, list | tuple) and value:
            value = value[0]
        elif getattr(getattr(value, "dtype", None), "kind", "") == "O" and getattr(value, "size", 0):
            value = value.flat[0]
    inside = getattr(value, "figure", None)
    whole = getattr(inside, "figure", None)  # of a subfigure
    return next((one for one in (value, inside, whole) if isinstance(one, figures.Figure)), None)


def _drawn(figure):
    """A figure of Matplotlib as PNG."""
    own = max(*figure.get_size_inches(), 0.01)
    around = figure.get_tightbbox()
    is_near = around is not None and max(around.width, around.height) < _NEAR * own  # nothing in it is very far away
    side = max(own, around.width, around.height) if is_near else own
    file, how = io.BytesIO(), {"bbox_inches": "tight"} if is_near else {}
    pixels = min(_PIXELS, (LONGEST_SIDE - 100) / side)
    figure.savefig(file, format="png", dpi=pixels, metadata={"Software": None}, **how)
    return file.getvalue()


def _small(content):
    """A PNG file that `checked` accepts, from one that may be too large: with fewer colours, then with fewer pixels."""
    with contextlib.suppress(Unreadable):
        return checked(as_data(content))
    from PIL import Image

    try:
        with Image.open(io.BytesIO(content), formats=["PNG"]) as image:
            image.load()
    except Exception:  # its errors have no common class
        raise Unreadable("this picture is damaged: expected a PNG file") from None
    for _ in range(_TRIES):
        image.thumbnail((LONGEST_SIDE, LONGEST_SIDE))
        for one in (image, image.convert("RGB").quantize(_COLOURS, dither=Image.Dither.NONE)):
            with contextlib.suppress(Unreadable):
                return checked(as_data(_stored(one)))
        image = image.resize([max(1, round(_FEWER * side)) for side in image.size])
    raise Unreadable("this picture cannot be made small enough: expected one with less in it")


def _stored(image):
    file = io.BytesIO()
    image.save(file, "PNG", optimize=True)
    return file.getvalue()
