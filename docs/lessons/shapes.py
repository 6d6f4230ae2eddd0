"""Shapes as letters: lines and areas of a picture, with as few corners as the eye needs, a letter or two for each.

A picture is `WIDE` steps wide and `TALL` steps high, counted from its upper left corner, as a browser counts; what the
axes mean is nobody's business here. Each corner is the way from the one before it: one letter for a short way, two for
a longer one, three for any other.
"""

from itertools import pairwise

import numpy as np

WIDE, TALL = 1000, 800  # steps of a picture, from left to right and from top to bottom
ALPHABET = "".join(chr(code) for code in range(35, 127) if chr(code) != "\\")  # what JSON writes as one character
NEAR = 40  # steps that one letter can go, forwards and backwards
FAR = 2 * NEAR + 1  # the first of eight letters after which another one says how far
FARTHEST = FAR + 8  # the letter after which two others say how far
LIFT = FARTHEST + 1  # the letter that lifts the pen: what follows is another piece
BASE = len(ALPHABET)
ROOM = 0.08  # beyond the frame, in shares of it: as much of a line as its width may need
STEP = np.array([0.65, 0.26])  # pixels of a step, of a picture as a page shows it
CLOSE = 0.5  # pixels by which a line may be elsewhere
UPRIGHT = 0.001  # of a way up or down, so that an upright part of a line has a beginning and an end


def encoded(pieces, close=CLOSE):
    """Return pieces of a line as letters.

    Arguments:
        pieces: of corners, as arrays of (share of the width from the left, share of the height from the bottom).
        close: pixels by which the line may be elsewhere.
    """
    steps = (few(np.column_stack([piece[:, 0] * WIDE, (1 - piece[:, 1]) * TALL]), close) for piece in pieces)
    return in_letters(steps)


def in_letters(pieces):
    """Return pieces in steps as letters."""
    written, place = [], np.zeros(2, dtype=int)
    for corners in pieces:
        corners = np.rint(corners).astype(int)
        keep = np.r_[True, (np.diff(corners, axis=0) != 0).any(axis=1)]
        corners = corners[keep] if keep.sum() > 1 else corners[:1]
        ways = np.diff(np.vstack([place, corners]), axis=0)
        written.append("".join(map(letters, ways.ravel().tolist())))
        place = corners[-1]
    return ALPHABET[LIFT].join(written)


def letters(way):
    """A number of steps as one letter, two or three.

    >>> letters(0), letters(-40), letters(300), letters(-4000)
    ('K', '#', '|>', '}$T')
    """
    if abs(way) <= NEAR:
        return ALPHABET[way + NEAR]
    if -4 * BASE <= way < 4 * BASE:
        high, low = divmod(way + 4 * BASE, BASE)
        return ALPHABET[FAR + high] + ALPHABET[low]
    high, low = divmod(way + BASE**2 // 2, BASE)
    return ALPHABET[FARTHEST] + ALPHABET[high] + ALPHABET[low]


def decoded(text):
    """Return the pieces of a line as lists of (x, y) in steps, as the page reads them.

    >>> decoded(encoded([np.array([[0, 0], [1, 1]])]))
    [[(0, 800), (1000, 0)]]
    """
    pieces, way, place, letter = [[]], [], [0, 0], iter(map(ALPHABET.index, text))
    for value in letter:
        if value == LIFT:
            pieces.append([])
            continue
        if value < FAR:
            value -= NEAR
        elif value < FARTHEST:
            value = (value - FAR) * BASE + next(letter) - 4 * BASE
        else:
            value = next(letter) * BASE + next(letter) - BASE**2 // 2
        way.append(value)
        if len(way) == 2:
            place = [place[0] + way[0], place[1] + way[1]]
            pieces[-1].append(tuple(place))
            way = []
    return pieces


def between(one, other, share):
    """Return the pieces of a shape between two others, as arrays in steps; None where they have not as many pieces.

    Corners belong together that are as far along the shape, mainly from left to right; lessons.js does the same.

    Arguments:
        one, other: letters.
        share: of the way from one to the other.
    """
    pairs = decoded(one), decoded(other)
    if len(pairs[0]) != len(pairs[1]):
        return None
    found = []
    for first, last in zip(*pairs, strict=True):
        ways = along(first), along(last)
        places = np.unique(np.concatenate(ways))
        ends = (
            np.column_stack([np.interp(places, way, np.array(piece)[:, k]) for k in (0, 1)])
            for way, piece in zip(ways, (first, last), strict=True)
        )
        found.append((1 - share) * next(ends) + share * next(ends))
    return found


def along(piece):
    """How far each corner of a piece is along it, from 0 to 1."""
    ways = np.abs(np.diff(piece, axis=0)) @ (1, UPRIGHT)
    return np.r_[0, np.cumsum(ways)] / (ways.sum() or 1)


def apart(one, other):
    """The largest distance of two shapes, in pixels: of the corners of each from the lines of the other.

    Arguments:
        one, other: pieces, in steps.
    """
    return max(distance(one, other), distance(other, one))


def distance(corners, lines):
    """The largest distance of the corners of a shape from the lines of another one."""
    points = np.vstack(corners)[:, None] * STEP
    starts = np.vstack([piece if len(piece) == 1 else piece[:-1] for piece in map(np.asarray, lines)]) * STEP
    ways = np.vstack([[[0, 0]] if len(piece) == 1 else np.diff(piece, axis=0) for piece in lines]) * STEP
    lengths = (ways**2).sum(axis=1)
    shares = ((points - starts) * ways).sum(axis=2) / np.where(lengths, lengths, 1)
    far = points - starts - np.clip(shares, 0, 1)[..., None] * ways
    return float(np.sqrt((far**2).sum(axis=2).min(axis=1).max()))


def drawn(text, closed=False):
    """Return the letters of a shape as the path of an SVG picture, as lessons.js makes it."""
    parts = []
    for piece in decoded(text) if text else []:
        if len(piece) == 1:  # a point; a browser draws a line without length as a dot
            piece = piece * 2
        parts.append("M" + "L".join(f"{x} {y}" for x, y in piece) + ("Z" if closed else ""))
    return "".join(parts)


def few(corners, close=CLOSE):
    """Return the corners of a line without those that lie on the way between others (Douglas and Peucker).

    >>> few(np.array([[0, 0], [5, 0.1], [10, 0], [10, 50]])).tolist()
    [[0.0, 0.0], [10.0, 0.0], [10.0, 50.0]]
    """
    if len(corners) < 3:
        return corners
    points = corners * STEP
    keep = np.zeros(len(points), dtype=bool)
    keep[[0, -1]] = True
    waiting = [(0, len(points) - 1)]
    while waiting:
        first, last = waiting.pop()
        if last - first < 2:
            continue
        between, start = points[first + 1 : last], points[first]
        way = points[last] - start
        length = way @ way
        share = np.clip((between - start) @ way / length, 0, 1) if length else np.zeros(len(between))
        far = ((between - start - share[:, None] * way) ** 2).sum(axis=1)
        worst = int(far.argmax())
        if far[worst] > close**2:
            middle = first + 1 + worst
            keep[middle] = True
            waiting += [(first, middle), (middle, last)]
    return corners[keep]


def inside(points, room=ROOM):
    """Return what of a line is in the frame, or just beyond it, as pieces.

    Arguments:
        points: corners, as an array of (share of the width, share of the height); the line is broken at a NaN.
        room: beyond the frame, in shares of it.

    >>> [piece.tolist() for piece in inside(np.array([[0, 0.5], [1, 10.5]]), room=0)]
    [[[0.0, 0.5], [0.05, 1.0]]]
    """
    points = np.asarray(points, dtype=float)
    low, high = -room, 1 + room
    if np.isfinite(points).all() and (points >= low).all() and (points <= high).all():
        return [points]
    pieces, piece = [], []
    for start, end in pairwise(points):
        part = clipped(start, end, low, high)
        if part is None:
            pieces.append(piece)
            piece = []
            continue
        begin, until = part
        if not piece or not np.allclose(piece[-1], begin, atol=1e-9):
            pieces.append(piece)
            piece = [begin]
        piece.append(until)
    return [np.array(one) for one in [*pieces, piece] if len(one) > 1]


def clipped(start, end, low, high):
    """The part of a straight line between two limits, in both directions; None where there is none."""
    way = end - start
    if not np.isfinite(way).all():
        return None
    first, last = 0.0, 1.0
    for at, along in zip(start, way, strict=True):
        if along == 0:
            if not low <= at <= high:
                return None
            continue
        one, other = sorted(((low - at) / along, (high - at) / along))
        first, last = max(first, one), min(last, other)
    if first > last:
        return None
    # what comes from very far away is known to some digits only, and would miss the edge
    return np.clip(start + first * way, low, high), np.clip(start + last * way, low, high)
