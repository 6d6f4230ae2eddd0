"""Answers that are sent past the sheet, or are none."""

from hostile.attack import COMPLETE, NOT_RUN, STOPPED, Expects, attack

_FORGES = "forging the stream"

#: Every way out of the process that an answer might take: the sheet's function, and all open descriptors.
_SEND = r"""
from exercisegrader.student_side import answer_sheet


def send(*lines):
    for fd in [fd for fd in range(1, 256) if fd != 2]:
        for line in lines:
            try:
                fcntl.fcntl(fd, fcntl.F_SETFL, fcntl.fcntl(fd, fcntl.F_GETFL) | os.O_NONBLOCK)
                os.write(fd, line)
            except OSError:
                break


def deliver(*arguments):
    try:
        answer_sheet.deliver(*arguments)
    except BaseException:
        pass


def message(student="", number="3", answers='{"x": 1}'):
    found = [f'{{"answer": {{"student": "{student}", "exercise": "{number}", "given": {answers}}}}}\n']
    found.append(f'{{"student": "{student}", "number": "{number}", "answers": {answers}}}\n')
    found.append(f'["{student}", "{number}", {answers}]\n')
    return [one.encode() for one in found]


"""

ATTACKS = (
    attack(
        _FORGES,
        "another student, another exercise, more answers",
        _SEND
        + """
for student in (GIVEN["other"], "", "nobody", "../../etc", "s1001/../s1002"):
    send(*message(student), *message(student, "99"))
    for number in ("3", "99", "", None, 3, ["3"], "../3"):
        deliver(student, number, {"x": 1, "earned": 100, "status": "right"})
send(b'{"student": "", "status": "complete", "earned": 100, "points": 100, "exercises": []}\\n')
""",
    ),
    attack(
        _FORGES,
        "huge numbers",
        _SEND
        + """
for text in ("1e999999", "-1e999999", "9" * 5000, "NaN", "Infinity", "-Infinity", "0." + "0" * 5000 + "1", "1" * 10**6):
    send(*message(answers='{"x": ' + text + "}"))
for value in (10**5000, -(10**100000), float("nan"), float("inf"), 1e308 * 10j, True, 2**63, b"x", {1: 2}, {None: 1}):
    deliver("", "3", {"x": value})
    sheet.answer("3", x=value)
""",
    ),
    attack(
        _FORGES,
        "nests",
        _SEND
        + """
deep = "[" * 100000 + "]" * 100000
send(*message(answers='{"x": ' + deep + "}"), ('{"a":' * 100000).encode(), deep.encode() + b"\\n")
nest = []
for _ in range(100000):
    nest = [nest]
deliver("", "3", {"x": nest})
sheet.answer("3", x=nest)
ring = []
ring.append(ring)
deliver("", "3", {"x": ring})
sheet.answer("3", x=ring)
while nest:
    nest = nest.pop()  # or its end would be one of the process
""",
    ),
    attack(
        _FORGES,
        "bytes that are no text",
        _SEND
        + """
send(b"\\xff\\xfe\\x80" * 1000 + b"\\n", b"\\x00" * 5000 + b"\\n")
send(b'{"number": "\\xc3\\x28"}\\n', b'"\\\\ud800"\\n', b"\\r\\r\\n\\n\\n")
send(*(part + b"\\n" for part in (b"null", b"1", b'"x"', b"[]", b"{}", b"{{", b"not json", b'{"a": 1, "a": 2}')))
signs = ("\\ud800", "\\x00", "\\u202e\\u2066", "a\\nb\\r\\n{}", "\\x1b[2J")
for text in (*signs, "</script><script>alert(1)</script>", "$" * 4999):
    deliver("", "3", {"x": text, text: 1})
    sheet.answer("3", x=text)
""",
    ),
    attack(
        _FORGES,
        "a line of 100 MB",
        _SEND
        + """
only_in_a_jail()
for fd in range(3, 256):
    try:
        os.set_blocking(fd, True)
        for _ in range(100):
            os.write(fd, b"x" * 2**20)
    except OSError:
        pass
""",
    ),
    attack(
        _FORGES,
        "the end, and answers after it",
        _SEND
        + """
send(b'{"end": true}\\n', *message(), b'{"end": false}\\n')
os._exit(0)
""",
    ),
    attack(
        _FORGES,
        "it refuses itself, again and again",
        _SEND
        + """
send(b'{"refused": "all is right"}\\n' * 3)
""",
        expects=Expects(frozenset(), frozenset({"1", "2"}), frozenset({COMPLETE, STOPPED, NOT_RUN})),
    ),
    attack(
        _FORGES,
        "cells that begin again and again",
        _SEND
        + """
while True:
    send(b'{"cell": 1}\\n')
    time.sleep(0.01)
""",
    ),
    attack(
        _FORGES,
        "cells with long numbers, and errors without an end",
        _SEND
        + """
send(b'{"cell": ' + b"9" * 4000 + b"}\\n", b'{"cell": -1}\\n', *[b'{"error": {"cell": 9, "says": "x"}}\\n'] * 1000)
os._exit(0)
""",
    ),
    attack(
        _FORGES,
        "a million answers",
        """
while True:
    sheet.answer('3', x='y' * 4000)
""",
    ),
    attack(
        _FORGES,
        "a thousand names",
        """
sheet.answer('3', **{f'n{k}': k for k in range(1000)})
sheet.answer('4' * 10**6, x=1)
sheet.answer(None, x=1)
sheet.answer()
""",
    ),
    attack(
        _FORGES,
        "half a line",
        _SEND
        + """
send(b'{"student": "", "number": "3", "answers": {"x": ')
os._exit(0)
""",
    ),
    attack(
        _FORGES,
        "lengths that lie",
        _SEND
        + """
import struct

for length in (0, -1, 2**31 - 1, 2**32 - 1):
    for order in "<>":
        send(struct.pack(order + "I", length & 0xFFFFFFFF) + b"{}")
        send(struct.pack(order + "Q", length & (2**64 - 1)) + b"{}")
send(b"Content-Length: 99999999999\\r\\n\\r\\n{}", b"\\x80\\x04K\\x01.")
""",
    ),
    attack(
        _FORGES,
        "what is no answer at all",
        _SEND
        + """
for line in ('{"end": 1, "cell": 1}', '{"made for": "s1002"}', '{"cell": "x"}', '{"cell": 1e999}', '{"__class__": 1}'):
    send(line.encode() + b"\\n")
for line in ('{"done": true}', '{"end": true}', '{"status": "complete"}', '{"cell": 99}', '{"error": "x"}', "done"):
    send(line.encode() + b"\\n")
""",
    ),
    attack(_FORGES, "all descriptors closed", "os.closerange(0, 256)"),
    attack(
        _FORGES,
        "all descriptors exchanged",
        """
null = os.open('/dev/null', os.O_RDWR)
for fd in range(256):
    if fd != null:
        os.dup2(null, fd)
""",
    ),
    attack(
        _FORGES,
        "a pickle",
        """
class Evil:
    def __reduce__(self):
        return os.system, ("touch " + GIVEN["outside"] + ".pickled",)


import pickle

give(Evil())
give(pickle.dumps(Evil()))
for fd in range(3, 256):
    try:
        os.set_blocking(fd, False)
        os.write(fd, pickle.dumps(Evil()) + b"\\n")
    except OSError:
        pass
""",
    ),
)
