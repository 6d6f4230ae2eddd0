"""Output without an end, and ends that come too early."""

from hostile.attack import GOES_ON, attack

ATTACKS = (
    attack(
        "giant output",
        "print",
        """
only_in_a_jail()
while True:
    print('x' * 10**6)
""",
    ),
    attack(
        "giant output",
        "stderr",
        """
only_in_a_jail()
while True:
    sys.stderr.write('x' * 10**6)
""",
    ),
    attack(
        "giant output",
        "file descriptors 1 and 2",
        """
only_in_a_jail()
while True:
    os.write(1, b'x' * 10**6)
    os.write(2, b'x' * 10**6)
""",
    ),
    attack(
        "giant output",
        "without a line's end, from a shell",
        """
only_in_a_jail()
subprocess.run(['sh', '-c', 'cat /dev/zero'])
""",
    ),
    attack(
        "giant output",
        "display",
        """
from IPython.display import HTML, display

only_in_a_jail()
while True:
    display(HTML('x' * 10**6))
""",
    ),
    attack("giant output", "error text", "raise ValueError('x' * 10**7)", expects=GOES_ON),
    attack(
        "giant output",
        "error without a text",
        """
class Odd(Exception):
    def __str__(self):
        while True:
            pass


raise Odd
""",
    ),
    attack("os._exit", "0", "os._exit(0)"),
    attack(
        "os._exit",
        "in a child",
        """
if os.fork() == 0:
    os._exit(0)
""",
        expects=GOES_ON,
    ),
    attack("os._exit", "the child goes on as if it were the notebook", "os.fork()"),
    attack("os._exit", "the parent ends, the child goes on", "if os.fork():\n    os._exit(0)"),
    attack("os._exit", "another program in its place", "os.execv('/bin/sh', ['sh', '-c', 'sleep 100'])"),
    attack("sys.exit", "0", "sys.exit(0)"),
    attack("sys.exit", "exit and quit", "exit()", "quit()"),
    attack("sys.exit", "with an object as code", "raise SystemExit(lambda: 1)"),
    attack(
        "sys.exit",
        "other exceptions that end programs",
        "raise KeyboardInterrupt",
        "raise GeneratorExit",
        "raise BaseException('x')",
    ),
    attack("segmentation fault", "ctypes", "ctypes.string_at(0)"),
    attack(
        "segmentation fault",
        "recursion",
        """
sys.setrecursionlimit(10**9)


def f(x):
    return f(x) + 1


f(0)
""",
    ),
    attack("segmentation fault", "abort", "os.abort()"),
    attack("segmentation fault", "signals", *(f"os.kill(os.getpid(), {number})" for number in (11, 7, 4, 6, 15, 9))),
    attack(
        "segmentation fault",
        "code object",
        r"""
def f():
    pass


f.__code__ = f.__code__.replace(co_code=b'\xff' * 100)
f()
""",
    ),
)
