"""Attacks on other processes, and over the network."""

from hostile.attack import GOES_ON, attack

_KILLS = "killing the parent or everything"
_OUTLIVES = "background process"
_NETWORK = "network"

#: Forks twice, so that it is nobody's child.
_DAEMON = """
def daemon(work):
    if os.fork():
        return
    os.setsid()
    if os.fork():
        os._exit(0)
    call_oneself()
    for number in (1, 2, 3, 10, 12, 13, 14, 15):
        signal.signal(number, signal.SIG_IGN)
    work()
    os._exit(0)


"""

ATTACKS = (
    attack(
        _KILLS,
        "parent",
        """
only_in_a_jail()
os.kill(os.getppid(), 9)
""",
    ),
    attack(
        _KILLS,
        "parent is stopped",
        """
only_in_a_jail()
os.kill(os.getppid(), signal.SIGSTOP)
""",
    ),
    attack(
        _KILLS,
        "everything",
        """
only_in_a_jail()
os.kill(-1, 9)
""",
    ),
    attack(
        _KILLS,
        "its group",
        """
only_in_a_jail()
os.killpg(os.getpgrp(), 9)
""",
    ),
    attack(
        _KILLS,
        "from a child of its own",
        """
only_in_a_jail()
if os.fork() == 0:
    for pid in (os.getppid(), 1, 0, -1):
        try:
            os.kill(pid, 9)
        except OSError:
            pass
    os._exit(0)
time.sleep(0.1)
""",
    ),
    attack(
        _KILLS,
        "all that it sees, one by one, with all signals",
        """
only_in_a_jail()
for number in (1, 2, 3, 10, 14, 15, 19, 9):
    for pid in [pid for pid in pids() if pid != os.getpid()] + list(range(1, 50)):
        try:
            os.kill(pid, number) if pid != os.getpid() else None
        except OSError:
            pass
""",
    ),
    attack(
        _OUTLIVES,
        "daemon that answers after the cell",
        _DAEMON
        + """
def work():
    until = time.time() + 20
    while time.time() < until:
        for fd in range(256):
            try:
                os.write(fd, b'{"number": "3", "answers": {"x": 1}}\\n')
            except OSError:
                pass
        sheet.answer("3", x=1)
        time.sleep(0.2)


daemon(work)
""",
    ),
    attack(_OUTLIVES, "daemon that only stays", _DAEMON + "daemon(lambda: time.sleep(10**6))", expects=GOES_ON),
    attack(
        _OUTLIVES, "daemon that burns a core", _DAEMON + "daemon(lambda: [0 for _ in iter(int, 1)])", expects=GOES_ON
    ),
    attack(
        _OUTLIVES,
        "shell with nohup",
        "subprocess.Popen(['nohup', 'sh', '-c', 'while :; do sleep 1; done'], start_new_session=True)",
        expects=GOES_ON,
    ),
    attack(
        _OUTLIVES,
        "threads that keep answering",
        """
def keep():
    while True:
        sheet.answer("3", x=1)
        time.sleep(0.01)


for _ in range(8):
    threading.Thread(target=keep).start()
""",
    ),
    attack(
        _NETWORK,
        "loopback and outside",
        """
for family, address in ((socket.AF_INET, "127.0.0.1"), (socket.AF_INET6, "::1")):
    if GIVEN["port"]:
        attempt(f"connected to {address}", socket.create_connection, (address, GIVEN["port"]), 0.3)
for address in ("192.0.2.1", "198.51.100.1", "10.0.0.1"):
    outside = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    attempt(f"a route to {address}", outside.connect, (address, 53))
""",
        expects=GOES_ON,
    ),
    attack(
        _NETWORK,
        "Unix sockets",
        """
for name in (GIVEN["socket"], "\\0" + os.path.basename(GIVEN["socket"])):
    attempt("connected to a Unix socket", socket.socket(socket.AF_UNIX).connect, name)
""",
        expects=GOES_ON,
    ),
    attack(_NETWORK, "names", "attempt('a name was resolved', socket.getaddrinfo, 'example.org', 80)"),
    attack(
        _NETWORK,
        "urllib",
        """
import urllib.request

if GIVEN["port"]:
    attempt("urllib got through", urllib.request.urlopen, f"http://127.0.0.1:{GIVEN['port']}/", None, 0.5)
attempt("urllib got outside", urllib.request.urlopen, "http://192.0.2.1/", None, 0.5)
""",
    ),
    attack(
        _NETWORK,
        "odd families",
        """
attempt("raw packets", socket.socket, socket.AF_PACKET, socket.SOCK_RAW)
attempt("raw internet", socket.socket, socket.AF_INET, socket.SOCK_RAW, 1)
for guest in (0, 1, 2):
    try:
        other = socket.socket(40, socket.SOCK_STREAM)  # virtual machine sockets
        other.settimeout(0.2)
        attempt("connected to the host of a virtual machine", other.connect, (guest, 22))
    except OSError:
        pass
""",
        expects=GOES_ON,
    ),
)
