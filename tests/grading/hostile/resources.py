"""Attacks on what a machine has: time, memory, processes, disk."""

from hostile.attack import attack

ATTACKS = (
    attack("endless loop", "nothing in it", "while True:\n    pass"),
    attack("endless loop", "in a compiled function", "sum(range(10**18))"),
    attack("endless loop", "power of integers", "len(str(9 ** 9 ** 9))"),
    attack("endless loop", "asleep", "time.sleep(10**6)"),
    attack("endless loop", "regular expression", 're.match(r"(a+)+$", "a" * 64 + "b")'),
    attack("endless loop", "ten cells of them", *["while True:\n    pass"] * 10),
    attack(
        "endless loop",
        "that catches everything",
        """
while True:
    try:
        while True:
            pass
    except BaseException:
        pass
""",
    ),
    attack(
        "endless loop",
        "that ignores and blocks all signals",
        """
for number in range(1, 65):
    try:
        signal.signal(number, signal.SIG_IGN)
    except (OSError, ValueError):
        pass
signal.pthread_sigmask(signal.SIG_BLOCK, range(1, 65))
signal.setitimer(signal.ITIMER_REAL, 0)
while True:
    pass
""",
    ),
    attack("endless loop", "stopped by itself", "os.kill(os.getpid(), signal.SIGSTOP)"),
    attack("endless loop", "waits for a pipe", "os.read(os.pipe()[0], 1)"),
    attack(
        "endless loop",
        "in a thread that nobody waits for",
        "threading.Thread(target=lambda: [0 for _ in iter(int, 1)]).start()",
    ),
    attack(
        "endless loop",
        "in a destructor and at the end",
        """
import atexit


class Late:
    def __del__(self):
        while True:
            pass


late = Late()
atexit.register(lambda: time.sleep(10**6))
""",
    ),
    attack(
        "memory bomb",
        "bytearray",
        """
only_in_a_jail()
kept = []
while len(kept) * 64 < GIVEN["megabytes"]:
    kept.append(bytearray(os.urandom(1) * 2**26))
escaped("so much memory was there")
""",
    ),
    attack(
        "memory bomb",
        "numpy at once",
        """
import numpy as np

only_in_a_jail()
kept = np.ones(GIVEN["megabytes"] * 2**17)
escaped("so much memory was there")
""",
    ),
    attack(
        "memory bomb",
        "text doubled",
        """
only_in_a_jail()
text = "x"
while len(text) < GIVEN["megabytes"] * 2**20:
    text += text
escaped("so much memory was there")
""",
    ),
    attack(
        "memory bomb",
        "list that holds itself",
        """
only_in_a_jail()
row = [0]
while sys.getsizeof(row) < GIVEN["megabytes"] * 2**20:
    row.extend(row)
escaped("so much memory was there")
""",
    ),
    attack(
        "memory bomb",
        "swallowed again and again",
        """
only_in_a_jail()
kept = []
while True:
    try:
        kept.append(bytearray(b"x" * 2**26))
    except MemoryError:
        pass
    if len(kept) * 64 > GIVEN["megabytes"]:
        escaped("so much memory was there")
        break
""",
    ),
    attack(
        "memory bomb",
        "many processes with a part each",
        """
only_in_a_jail()
part, (done, tell) = 100, os.pipe()
os.set_blocking(done, False)
for _ in range(GIVEN["megabytes"] // part + 1):
    try:
        if os.fork() == 0:
            call_oneself()
            kept = bytearray(b"x" * part * 2**20)
            os.write(tell, b".")
            time.sleep(10**6)
    except OSError:
        break
until, held = time.time() + 1.5, 0
while time.time() < until:
    try:
        held += len(os.read(done, 10**4))
    except BlockingIOError:
        time.sleep(0.05)
if held * part >= GIVEN["megabytes"]:
    escaped("so much memory was there, in parts")
""",
    ),
    attack(
        "memory bomb",
        "shared and in files of memory",
        """
only_in_a_jail()
held, step = 0, 2**26
while held < GIVEN["megabytes"] * 2**20:
    memory = os.memfd_create("x")
    held += os.write(memory, b"x" * step)
escaped("so much memory was there, in memfd")
""",
    ),
    attack(
        "fork bomb",
        "plain",
        """
only_in_a_jail()
import mmap

call_oneself()
started = mmap.mmap(-1, 8)  # shared with the children: no machine shall suffer from a jail that is none
count = lambda: int.from_bytes(started[:8], "little")
while count() < GIVEN["processes"]:
    try:
        if os.fork() == 0:
            started[:8] = (count() + 1).to_bytes(8, "little")
    except OSError:
        pass
escaped("so many processes were there")
time.sleep(10**6)
""",
    ),
    attack(
        "fork bomb",
        "programs",
        """
only_in_a_jail()
kept = []
while len(kept) < GIVEN["processes"]:
    kept.append(subprocess.Popen([sys.executable, "-c", "import time; time.sleep(10**6)"]))
escaped("so many processes were there")
""",
    ),
    attack(
        "fork bomb",
        "shell",
        """
only_in_a_jail()
bomb = 'f() { [ $1 -lt 11 ] && { f $(($1 + 1)) & f $(($1 + 1)) & }; sleep 1000; }; f 0'
subprocess.run(["sh", "-c", bomb])
""",
    ),
    attack(
        "thread bomb",
        "threading",
        """
only_in_a_jail()
threads = 0
while threads < 10 * GIVEN["processes"]:
    threading.Thread(target=time.sleep, args=(10**6,)).start()
    threads += 1
escaped("so many threads were there")
""",
    ),
    attack(
        "disk filling",
        "every writable place",
        """
only_in_a_jail()
written, block = 0, b"x" * 2**24
for folder, folders, names in os.walk("/"):
    folders[:] = [name for name in folders if os.path.join(folder, name) not in ("/proc", "/sys")]
    try:
        with open(os.path.join(folder, "full"), "wb") as file:
            while written < GIVEN["megabytes"] * 2**20:
                written += file.write(block)
    except OSError:
        continue
if written >= GIVEN["megabytes"] * 2**20:
    escaped("so much disk was there")
""",
    ),
    attack(
        "disk filling",
        "small files without end",
        """
only_in_a_jail()
for number in range(10**6):
    open(f"{number % 100}-{number}", "wb").close()
escaped("a million files")
""",
    ),
    attack(
        "disk filling",
        "a sparse file and a deep folder",
        """
only_in_a_jail()
with open('sparse', 'wb') as file:
    file.truncate(2**50)
while True:
    os.mkdir('d')
    os.chdir('d')
""",
    ),
)
