"""What notebooks can do besides Python: magics, shells, widgets, input, loops of events, figures."""

from hostile.attack import GOES_ON, attack

_MAGICS = "magics and shells"
_WIDGETS = "widgets"
_ASKS = "input"
_LOOPS = "loops of events"
_FIGURES = "figures"

ATTACKS = (
    attack(_MAGICS, "a shell of its own", "%%bash\ncat /etc/shadow\nenv", expects=GOES_ON),
    attack(_MAGICS, "a line for the shell", "!env; id; cat /etc/shadow", expects=GOES_ON),
    attack(
        _MAGICS,
        "what a shell has found",
        """
found = !cat /etc/shadow {" ".join(GIVEN["reads"])} 2>/dev/null
hunt("\\n".join(found).encode(), "a shell")
if any(line.startswith("root:") for line in found):
    escaped("a shell read /etc/shadow")
""",
        expects=GOES_ON,
    ),
    attack(
        _MAGICS,
        "%run and %load",
        *("%run " + name for name in ("/etc/passwd", "nothing.py", "-i /etc/hostname")),
        "%load /etc/passwd",
        expects=GOES_ON,
    ),
    attack(
        _MAGICS,
        "%run of the assignment",
        """
get_ipython().run_line_magic('run', GIVEN['reads'][0])
escaped('ran the assignment')
""",
        expects=GOES_ON,
    ),
    attack(
        _MAGICS,
        "%%javascript and %%html",
        """
%%javascript
alert(1)
""",
        """
%%html
<script>alert(1)</script>
""",
        expects=GOES_ON,
    ),
    attack(
        _MAGICS,
        "%%time around an answer",
        """
%%time
sheet.answer('3', x=1)
""",
        "%timeit -n1 -r1 pass",
        "%matplotlib inline",
        "%matplotlib widget",
        "%matplotlib qt",
        expects=GOES_ON,
    ),
    attack(
        _MAGICS,
        "%%capture, %reset, %autosave",
        """
%%capture
print(1)
""",
        "%autosave 1",
        "%who",
        "%history",
        "%reset -f",
    ),
    attack(
        _MAGICS,
        "none that there is",
        "%nothing",
        """
%%nothing
x
""",
        "?sheet",
        "sheet.answer?",
        "sheet.answer??",
        expects=GOES_ON,
    ),
    attack(
        _MAGICS,
        "a script that stays",
        """
%%bash --bg
sleep 1000
""",
        """
%%script sh --no-raise-error
sleep 1000 &
""",
    ),
    attack(
        _MAGICS, "%pip and %conda", "%pip install nothing-of-this-name", "!pip install --quiet nothing-of-this-name"
    ),
    attack(
        _MAGICS,
        "a language that is none",
        """
library(ggplot2)
x <- c(1, 2, 3)
""",
        "SELECT * FROM students;",
        "\x00",
        """
    if x:
  y
""",
        "'" * 3 + "never ends",
        expects=GOES_ON,
    ),
    attack(_MAGICS, "the debugger", "%pdb on", "1 / 0", "%debug", "breakpoint()"),
    attack(
        _MAGICS,
        "the kernel",
        "get_ipython().kernel.do_shutdown(True)",
        "get_ipython().kernel.session.send(None, 'x')",
        "get_ipython().ask_exit()",
    ),
    attack(
        _MAGICS,
        "the parent's messages",
        "get_ipython().set_parent({})",
        "get_ipython().payload_manager.write_payload({'source': 'set_next_input', 'text': 'x', 'replace': True})",
    ),
    attack(
        _MAGICS,
        "the history of others",
        """
for line in get_ipython().history_manager.get_tail(100, raw=True, include_latest=True):
    hunt(repr(line).encode(), 'the history')
""",
        expects=GOES_ON,
    ),
    attack(
        _WIDGETS,
        "interact",
        """
from ipywidgets import interact


@interact(K=(0, 5.0))
def show(K=1.0):
    sheet.answer("3", x=K)
""",
    ),
    attack(
        _WIDGETS,
        "buttons, and waiting for one",
        """
import ipywidgets

button = ipywidgets.Button(description='x')
button.on_click(print)
button
""",
        """
while not getattr(button, 'pressed', False):
    time.sleep(0.1)
""",
    ),
    attack(
        _WIDGETS,
        "an answer out of a widget",
        """
import ipywidgets

give(ipywidgets.FloatSlider(1.0))
give(ipywidgets.FloatSlider(1.0).value)
""",
    ),
    attack(_ASKS, "input", "x = float(input('K = '))", expects=GOES_ON),
    attack(
        _ASKS,
        "in a loop that accepts no error",
        """
while True:
    try:
        x = input()
        break
    except Exception:
        pass
""",
    ),
    attack(
        _ASKS,
        "getpass",
        """
import getpass

getpass.getpass()
""",
    ),
    attack(
        _ASKS,
        "stdin and the terminal",
        "sys.stdin.read()",
        "os.read(0, 1)",
        "open('/dev/tty').read()",
        expects=GOES_ON,
    ),
    attack(
        _LOOPS,
        "await at the top",
        """
import asyncio

await asyncio.sleep(0.01)
""",
        expects=GOES_ON,
    ),
    attack(
        _LOOPS,
        "await without an end",
        """
import asyncio

await asyncio.Event().wait()
""",
    ),
    attack(
        _LOOPS,
        "one within another",
        """
import asyncio

asyncio.run(asyncio.sleep(0.01))
""",
        "asyncio.get_event_loop().run_until_complete(asyncio.sleep(0.01))",
    ),
    attack(
        _LOOPS,
        "tasks that go on answering",
        """
import asyncio


async def keep():
    while True:
        sheet.answer("3", x=1)
        await asyncio.sleep(0)


tasks = [asyncio.ensure_future(keep()) for _ in range(100)]
""",
        "await asyncio.sleep(0.5)",
    ),
    attack(
        _LOOPS,
        "the loop is closed",
        """
import asyncio

asyncio.get_event_loop().close()
""",
        "asyncio.get_event_loop().stop()",
    ),
    attack(
        _FIGURES,
        "200 of them",
        """
import matplotlib.pyplot as plt

for _ in range(200):
    plt.figure(figsize=(20, 20))
    plt.plot(range(100))
""",
    ),
    attack(
        _FIGURES,
        "one of a million pixels a side",
        """
import matplotlib.pyplot as plt

plt.figure(figsize=(10**4, 10**4), dpi=100)
plt.plot([1])
plt.show()
""",
    ),
    attack(
        _FIGURES,
        "a window, and its loop",
        """
import matplotlib

matplotlib.use('TkAgg')
import matplotlib.pyplot as plt

plt.plot([1])
plt.show(block=True)
""",
    ),
    attack(
        _FIGURES,
        "formulas without an end",
        """
import matplotlib.pyplot as plt

plt.title('$' + '{' * 2000 + 'x' + '}' * 2000 + '$')
plt.gcf().canvas.draw()
""",
    ),
    attack(
        _FIGURES,
        "millions of points",
        """
import matplotlib.pyplot as plt
import numpy as np

plt.scatter(*np.random.rand(2, 10**7))
plt.savefig('x.svg')
""",
    ),
)
