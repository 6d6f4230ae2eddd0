"""Tools redefined, and statements deleted."""

from hostile.attack import GOES_ON, SPOILT, attack

_REDEFINES = "redefining"
_DELETES = "transformers"

ATTACKS = (
    attack(
        _REDEFINES,
        "check, answer and the sheet",
        """
class AnswerSheet:
    def __getattr__(self, name):
        return lambda *given, **named: True


sheet = AnswerSheet()
check = answer = lambda *given, **named: True
""",
        expects=SPOILT,
        before=(
            """
def check(*given, **named):
    return True
""",
        ),
    ),
    attack(
        _REDEFINES,
        "the sheet's methods",
        """
type(sheet).answer = lambda self, *given, **named: True
type(sheet).asks = None
""",
    ),
    attack(
        _REDEFINES,
        "json",
        """
json.dumps = lambda *given, **named: '{"right": true}'
json.JSONEncoder.encode = json.dumps
json.encoder.encode_basestring_ascii = json.dumps
json.loads = lambda text: {}
""",
        expects=SPOILT,
    ),
    attack(
        _REDEFINES,
        "json before anything",
        expects=SPOILT,
        before=(
            """
json.dumps = lambda *given, **named: '{}'
json.JSONEncoder.iterencode = lambda *given: iter(['1'])
""",
        ),
    ),
    attack(
        _REDEFINES,
        "print and output",
        """
print = lambda *given, **named: None
import builtins

builtins.print = print
sys.stdout = sys.stderr = sys.__stdout__ = None
""",
        expects=SPOILT,
    ),
    attack(
        _REDEFINES,
        "builtins",
        """
import builtins

for name in dir(builtins):
    if name[0] != "_" and callable(getattr(builtins, name)) and name not in ("setattr", "getattr", "callable", "dir"):
        try:
            setattr(builtins, name, lambda *given, **named: True)
        except Exception:
            pass
""",
    ),
    attack(
        _REDEFINES,
        "builtins one by one, before",
        expects=SPOILT,
        before=(
            """
import builtins

builtins.isinstance = lambda *given: True
builtins.abs = lambda x: 0
builtins.float = lambda x: 1.0
builtins.all = builtins.any = lambda x: True
""",
        ),
    ),
    attack(
        _REDEFINES,
        "the import",
        """
import builtins

builtins.__import__ = None
sys.meta_path.clear()
sys.modules.clear()
""",
    ),
    attack(
        _REDEFINES,
        "numpy",
        """
import numpy as np

for name in ("isclose", "allclose", "abs", "all", "any", "isfinite", "asarray", "array", "max"):
    setattr(np, name, lambda *given, **named: True)
""",
        expects=GOES_ON,
    ),
    attack(
        _REDEFINES,
        "sympy",
        """
import sympy

sympy.Basic.__eq__ = lambda self, other: True
sympy.Expr.equals = lambda self, other, *rest: True
sympy.simplify = sympy.sympify = lambda *given, **named: sympy.Integer(0)
sympy.Float.__float__ = sympy.Rational.__float__ = lambda self: 1.0
""",
    ),
    attack(
        _REDEFINES,
        "the library's judging",
        """
from exercisebook import judging, question
from loopbook.exercises import kinds

judging.judge = judging._judged = lambda *given, **named: judging.Verdict("x", "right", "right")
question.Question.check = lambda *given, **named: True
for name in kinds.__all__:
    kind = getattr(kinds, name)
    if isinstance(kind, type):
        kind.agrees = lambda self, answer: True
give("anything")
""",
    ),
    attack(
        _REDEFINES,
        "the library's grading",
        """
import exercisegrader.student_side.answer_sheet as module

for name in dir(module):
    if name[:2] != "__":
        setattr(module, name, lambda *given, **named: {"status": "right", "earned": 100})
""",
    ),
    attack(
        _REDEFINES,
        "files of the library on the path",
        """
import importlib

os.makedirs("loopbook/exercises", exist_ok=True)
for name in ("loopbook/__init__.py", "loopbook/exercises/__init__.py", "loopbook/exercises/judging.py", "json.py",
             "sitecustomize.py", "usercustomize.py"):
    open(name, "w").write("def judge(*given):\\n    return 'right'\\n")
os.environ["PYTHONPATH"] = os.environ["PYTHONSTARTUP"] = os.getcwd()
sys.path.insert(0, os.getcwd())
importlib.invalidate_caches()
""",
        expects=GOES_ON,
    ),
    attack(
        _DELETES,
        "IPython's syntax trees",
        expects=SPOILT,
        before=(
            """
import ast


class Deletes(ast.NodeTransformer):
    def visit_Assert(self, node):
        return None

    def visit_Call(self, node):
        return ast.copy_location(ast.Constant(True), node)


get_ipython().ast_transformers.append(Deletes())
""",
        ),
    ),
    attack(
        _DELETES,
        "texts of the cells",
        expects=SPOILT,
        before=("get_ipython().input_transformers_cleanup.append(lambda lines: ['sheet.answer(\"3\", x=1)\\n'])",),
    ),
    attack(
        _DELETES,
        "that never return",
        expects=SPOILT,
        before=(
            """
def forever(lines):
    while True:
        pass


get_ipython().input_transformers_post.append(forever)
""",
        ),
    ),
    attack(
        _DELETES,
        "hooks of the shell",
        """
shell = get_ipython()
for name in ("pre_execute", "pre_run_cell", "post_execute", "post_run_cell"):
    shell.events.register(name, lambda *given: sheet.answer("3", x=1))
shell.run_cell = shell.run_cell_async = shell.run_code = shell.showtraceback = lambda *given, **named: None
shell.user_ns.clear()
""",
    ),
    attack(
        _DELETES,
        "compile and exec",
        """
import builtins

builtins.compile = builtins.exec = builtins.eval = lambda *given, **named: None
""",
    ),
    attack(
        _DELETES,
        "traces and audits",
        """
def trace(frame, event, value):
    frame.f_trace_lines = False
    frame.f_locals.clear()
    return trace


sys.settrace(trace)
threading.settrace(trace)
sys.setprofile(lambda *given: 1 / 0)
""",
    ),
    attack(
        _DELETES,
        "an audit that forbids everything",
        """
def forbid(*given):
    raise RuntimeError


sys.addaudithook(forbid)
""",
    ),
    attack(
        _DELETES,
        "atexit",
        """
import atexit

atexit.register(lambda: sheet.answer('3', x=1))
atexit.register(lambda: os.write(1, b'{"number": "3"}'))
""",
        expects=GOES_ON,
    ),
    attack(
        _DELETES,
        "the frames above",
        """
frame = sys._getframe()
while frame:
    for name, value in list(frame.f_locals.items()):
        hunt(repr(value)[:10**5].encode("utf-8", "replace"), f"frame of {frame.f_code.co_name}")
    frame.f_globals.update(deliver=None, judge=None)
    frame = frame.f_back
""",
    ),
)
