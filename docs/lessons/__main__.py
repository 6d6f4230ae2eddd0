"""Records the lessons: ``python docs/lessons``, from the cells with sliders of the chapters.

A lesson is recorded again if the code of its cell has changed, or if the library no longer shows the same at some of
its positions. With names, only those lessons; with ``--all``, whatever has changed or not.
"""

import argparse
import json
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from lessons import recorded
from lessons.proof import difference, is_stale
from lessons.recording import POSITIONS, recording


def main():
    """Record what is asked for, and say what has become of each."""
    parser = argparse.ArgumentParser(prog="python docs/lessons", description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", help="of lessons; all when none is named")
    parser.add_argument("--all", action="store_true", help="record also what has not changed")
    parser.add_argument("--positions", type=int, default=POSITIONS, help="of all sliders together (%(default)s)")
    asked = parser.parse_args()
    lessons = recorded()
    names = asked.names or [*lessons]
    for number, name in enumerate(names, start=1):
        if name not in lessons:
            sys.exit(f"there is no recorded lesson {name!r}: docs/lessons/words.toml has their names")
        lesson, begin = lessons[name], time.perf_counter()
        why = reason(lesson, asked.all)
        if why:
            text = as_text(recording(lesson, asked.positions))
            lesson.file.parent.mkdir(exist_ok=True)
            lesson.file.write_text(text, encoding="utf-8", newline="\n")
            why = f"recorded, {len(text) / 1000:.0f} kB, because {why}"
        took = f"{time.perf_counter() - begin:.0f} s; {number} of {len(names)}"
        print(f"{lesson.chapter}, {name}: {why or 'unchanged'} ({took})", flush=True)


def reason(lesson, whatever):
    """Why a lesson is to be recorded; an empty text where it is not."""
    if whatever:
        return "all are"
    if not lesson.file.exists():
        return "it was not"
    if is_stale(lesson):
        return "the code of its cell has changed"
    return difference(lesson, seed=0)


def as_text(record):
    """A recording as it is stored: one line of the file for each of its parts."""
    data = record.pop("data")
    lines = [f'"{key}":{compact(value)}' for key, value in record.items()]
    inner = [f'"{key}":{compact(value)}' for key, value in data.items()]
    return "{" + ",\n".join([*lines, '"data":{' + ",\n".join(inner) + "}"]) + "}\n"


def compact(value):
    """JSON without spaces."""
    return json.dumps(value, ensure_ascii=False, separators=(",", ":"))


if __name__ == "__main__":
    main()
