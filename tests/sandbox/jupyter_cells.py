"""Cells as students write them, in notebooks that Jupyter's kernel and the sandbox run alike: see test_as_in_jupyter.py."""

# What a student hands in besides the notebooks, {path: content}
HANDED_IN = {
    "helper.py": b"answer = 42\ndef fail():\n    raise ValueError('in a helper')\ndef recurse(n):\n    return recurse(n + 1)\n",
    "helper_with_error.py": b"1 / 0\n",
    "helper_with_syntax_error.py": b"def f(:\n",
    "data/points.csv": b"1,2,3\n",
}

# {name: a notebook}. Cells begin below lines "# %%". A line "# %% differs: …" says why a cell does not show what it does in
# Jupyter; this is the list of all that the sandbox is known not to do as Jupyter does.
NOTEBOOKS = {
    "values": r'''
1 + 1
# %%
1 + 1;
# %%
_
# %%
_ + 5
# %%
_, __, ___
# %%
Out
# %%
In
# %%
_1, _i1, _i, _ii
# %%
x = 5
# %%
x
# %%
None
# %%
x; x + 1
# %%
"a string"
# %%
"a\nstring"
# %%
b"bytes"
# %%
[[1, 2], [3, 4]]
# %%
{"a": list(range(50)), "b": {1, 2, 3}, "c": (1,)}
# %%
list(range(300))
# %%
"x" * 2000
# %%
import numpy as np
np.eye(3)
# %%
np.arange(2000.0)
# %%
np.set_printoptions(precision=3, suppress=True)
np.array([1 / 3, 1e-9])
# %%
%precision 2
# %%
1 / 3
# %%
%precision
# %%
1e-20, 1.0, 1e300, float("nan"), float("inf"), -0.0
# %%
3 + 4j, True, ..., NotImplemented
# %%
int, np.ndarray, len, np.sin
# %%
lambda x: x
# %%
def f(x: int = 3) -> int:
    """A docstring."""
    return x
f
# %%
f.__module__, f.__qualname__, f.__doc__, f.__annotations__
# %%
class Pose:
    def __init__(self, x): self.x = x
Pose
# %%
Pose(3)
# %%
Pose(3).__class__.__module__
# %%
from dataclasses import dataclass
@dataclass
class Point:
    x: float
    y: float = 2.0
Point(1)
# %%
import collections, datetime, decimal, fractions, pathlib, uuid, enum
collections.OrderedDict(a=1), collections.Counter("aab"), collections.defaultdict(list, {1: [2]}), collections.deque([1, 2])
# %%
datetime.date(2020, 1, 2), decimal.Decimal("1.5"), fractions.Fraction(1, 3), pathlib.Path("a/b")
# %%
enum.Enum("Axis", "x y z").x
# %%
range(5), slice(1, 2), frozenset([1]), bytearray(b"x"), memoryview(b"x").tolist()
# %%
(n for n in range(3)).__class__
# %%
import re; re.match("a", "ab")
# %%
del _
# %%
_
# %%
Out[2]
# %%
Out.keys()
# %%
_ = 7
# %%
8
# %%
_
# %%
a = b = 3
(a,
 b)
# %%
if a == 3:
    a
# %%
for i in range(3):
    i
# %%
"é ü 漢字 😀"
# %%
"\ud800"
# %%
print("\x1b[31mred\x1b[0m", "\x07bell", "tab\there", "cr\rover", "bs\bx")
# %%
import sys
sys.version_info[:2], sys.executable != "", sys.argv[0].endswith(".py"), len(sys.argv) > 0, sys.path[0]
# %% differs: Python is started without what lies around it
sys.flags.isolated, sys.flags.utf8_mode
# %%
__name__, __doc__, __package__, __builtins__.__name__, sys.modules["__main__"].__name__
# %%
sys.modules["__main__"].x is x
# %%
__file__
# %%
sorted(n for n in globals() if not n.startswith("_i") and not n[1:].isdigit())
# %%
sorted(vars(sys.modules["__main__"])) == sorted(globals())
# %%
sys.ps1, sys.getrecursionlimit(), sys.displayhook.__class__.__name__, sys.excepthook.__class__.__name__
# %%
sys.stdin.__class__, sys.stdin.read()
# %%
sys.stdin.isatty(), sys.stdin.closed
# %%
eval("1 + 1"), exec("y = 3"), y
# %%
globals() is locals(), globals()["x"]
# %%
open("data/points.csv").read()
# %%
import helper; helper.answer, helper.__file__.endswith("transforms/helper.py")
# %%
import os
os.getcwd().endswith("/transforms"), os.path.basename(os.path.abspath("."))
# %%
sorted(os.listdir())
''',
    "streams": r"""
print("a"); print("b")
# %%
import sys; print("oh", file=sys.stderr)
# %%
print("out"); print("err", file=sys.stderr); print("out again")
# %%
print("no newline", end="")
# %%
print(); print(1, 2, sep="-", flush=True)
# %%
sys.stdout.write("written")
# %%
_ = sys.stdout.write("written")
# %%
sys.stdout.writelines(["a\n", "b\n"])
# %%
sys.stdout.write(3)
# %%
sys.stdout.write(b"x")
# %%
sys.stdout
# %%
sys.stdout.name, sys.stderr.name, sys.stdout.encoding, sys.stdout.errors, sys.stdout.newlines, sys.stdout.closed
# %%
sys.stdout.isatty(), sys.stdout.writable(), sys.stdout.readable(), sys.stdout.seekable()
# %%
sys.stdout.line_buffering
# %%
sys.stdout.buffer
# %%
sys.stdout.reconfigure(encoding="utf-8")
# %%
sys.stdout.mode
# %%
sys.stdout.read()
# %%
sys.stdout.readline()
# %%
sys.stdout.readlines()
# %%
sys.stdout.seek(0)
# %%
sys.stdout.tell()
# %%
sys.stdout.truncate()
# %%
sys.stdout.detach()
# %%
next(sys.stdout)
# %%
iter(sys.stdout) is sys.stdout
# %%
with sys.stderr: pass
# %%
print("after", file=sys.stderr)
# %% differs: Jupyter loses what it has not sent yet
print("closing"); sys.stdout.close()
# %%
sys.stdout.closed
# %%
print("closed")
# %%
1 + 1
""",
    "stream attributes": r'''
import io, sys
isinstance(sys.stdout, io.TextIOBase), isinstance(sys.stdout, io.IOBase), type(sys.stdout).__name__
# %%
isinstance(sys.stdout.fileno(), int), sys.stdout.fileno() == sys.stderr.fileno()
# %%
sorted(n for n in dir(io.TextIOBase) if not hasattr(sys.stdout, n))
# %%
sys.__stdout__ is sys.stdout, sys.__stdout__.name, sys.__stderr__.name
# %%
import contextlib
with contextlib.redirect_stdout(io.StringIO()) as kept:
    print("inside")
print(repr(kept.getvalue()))
# %%
with contextlib.redirect_stdout(sys.stderr):
    print("to the other")
# %%
old = sys.stdout
sys.stdout = io.StringIO()
print("lost")
sys.stdout = old
print("shown")
# %%
class Tee:
    def __init__(self, *files): self.files = files
    def write(self, text):
        for file in self.files: file.write(text)
    def flush(self): pass
kept = io.StringIO()
sys.stdout = Tee(old, kept)
print("both")
sys.stdout = old
kept.getvalue()
# %%
with contextlib.suppress(ZeroDivisionError): 1 / 0
# %%
import pprint
pprint.pprint({"a": [1] * 40, "b": "x" * 50})
# %%
import logging
logging.warning("careful")
# %%
logging.getLogger("mine").error("bad %s", 3)
# %%
logging.info("not seen")
# %%
logging.basicConfig(level=logging.INFO, format="%(levelname)s:%(message)s", force=True)
logging.info("seen")
# %%
logging.getLogger().handlers[0].stream is sys.stderr
# %%
logger = logging.getLogger("new"); logger.addHandler(logging.StreamHandler(sys.stdout)); logger.propagate = False
logger.warning("to stdout")
# %%
try:
    1 / 0
except ZeroDivisionError:
    logging.exception("failed")
# %%
import traceback
try:
    1 / 0
except ZeroDivisionError:
    traceback.print_exc()
# %%
traceback.print_stack(limit=1)
# %%
import warnings
warnings.warn("look")
# %%
warnings.warn("look")
# %%
def f():
    warnings.warn("deep", RuntimeWarning, stacklevel=2)
f()
f()
# %%
warnings.simplefilter("always")
for n in range(2): warnings.warn("always", DeprecationWarning)
# %%
with warnings.catch_warnings(record=True) as seen:
    warnings.warn("caught")
len(seen), seen[0].category
# %%
warnings.filterwarnings("error")
warnings.warn("now an error")
# %%
warnings.resetwarnings()
import numpy as np
np.array([1.0]) / 0
# %%
np.sqrt(-1)
# %%
np.float64(1) / np.float64(0)
# %% differs: Jupyter compiles the cell three times, and warns three times
1 is 1
# %% differs: Jupyter compiles the cell three times, and warns three times
"\d"
# %% differs: Jupyter compiles the cell three times, and warns three times
assert (1, "always")
# %%
def g():
    import warnings as w
    w.warn_explicit("explicit", UserWarning, "file.py", 3)
g()
# %%
warnings.warn(DeprecationWarning("mine"))
# %%
print(*range(3000))
# %%
print("x" * 100_000)
# %%
for n in range(1000): print(n, end=" ")
# %%
print("a" + "\n" * 5 + "b")
# %%
print("é ü 漢字 😀 \N{DEGREE SIGN}")
# %% differs: Jupyter cannot send it, and loses it
print("half \ud800")
# %%
print("\x00nul")
# %%
print(None, True, [1], {"a": 1}, sep="\n", end="!\n")
# %%
print("x", file=None)
# %%
help(len)
# %%
class Documented:
    """Says what it is."""
    def method(self):
        """What it does."""
help(Documented)
# %%
print(input.__doc__ is not None)
# %%
import time
print("one", flush=True); time.sleep(0.01); print("two", file=sys.stderr, flush=True); time.sleep(0.01); print("three")
# %%
print("a"); sys.stdout.flush(); print("b", file=sys.stderr); sys.stderr.flush(); display(1); print("c")
''',
    "displays": r"""
display(3)
# %%
display(3); 4
# %%
display(1, 2, "three")
# %%
display()
# %%
from IPython.display import *
# %%
HTML("<b>bold</b>")
# %%
display(HTML("<b>bold</b>"))
# %%
Markdown("*x*"), Latex("$x$")
# %%
Markdown("*x*")
# %%
Latex(r"$\frac{1}{2}$")
# %%
Math(r"\frac{1}{2}")
# %%
Javascript("1")
# %%
JSON({"a": [1, 2]})
# %%
JSON({"a": [1, 2]}, expanded=True)
# %%
GeoJSON({"type": "Point", "coordinates": [1, 2]})
# %%
SVG("<svg xmlns='http://www.w3.org/2000/svg'></svg>")
# %%
Pretty("pretty")
# %%
PNG = bytes.fromhex(
    "89504e470d0a1a0a0000000d4948445200000001000000010804000000b51c0c020000000b494441"
    "5478da6364f80f00010501012718e3660000000049454e44ae426082"
)
Image(PNG)
# %%
Image(PNG, width=100, height=50, alt="a dot")
# %%
Image(data=PNG, format="png", retina=True)
# %%
display(Image(PNG), metadata={"image/png": {"width": 3}})
# %%
open("dot.png", "wb").write(PNG)
Image("dot.png")
# %%
Image(filename="dot.png", embed=True)
# %%
Image(url="https://example.org/x.png")
# %%
Image("absent.png")
# %%
IFrame("https://example.org", 300, 200)
# %%
YouTubeVideo("abc")
# %%
Audio([0.0, 0.5], rate=8)
# %%
Video("x.mp4")
# %%
Code("x = 1", language="python")
# %%
FileLink("dot.png")
# %%
FileLink("absent.png")
# %%
FileLinks("data")
# %%
ProgressBar(4)
# %%
for _n in ProgressBar(2): pass
# %%
TextDisplayObject("x")
# %%
DisplayObject(b"x")
# %%
display({"text/plain": "plain", "text/html": "<i>html</i>"}, raw=True)
# %%
display({"text/plain": "plain", "application/x-own+json": {"a": 1}}, raw=True, metadata={"application/x-own+json": {"b": 2}})
# %%
publish_display_data({"text/plain": "published"})
# %%
publish_display_data("wrong")
# %%
display(3, include=["text/html"])
# %%
display(HTML("x"), exclude=["text/plain"])
# %%
display_html("<p>raw</p>", raw=True)
# %%
display_markdown("*md*", raw=True); display_latex("$x$", raw=True); display_png(PNG, raw=True)
# %%
class Rich:
    def _repr_html_(self): return "<b>rich</b>"
    def __repr__(self): return "poor"
Rich()
# %%
display(Rich(), Rich())
# %%
print(Rich())
# %%
[Rich()]
# %%
class Many:
    def _repr_html_(self): return "<b>html</b>"
    def _repr_markdown_(self): return "*md*"
    def _repr_latex_(self): return "$l$"
    def _repr_png_(self): return PNG
    def _repr_jpeg_(self): return b"jpeg"
    def _repr_svg_(self): return "<svg></svg>"
    def _repr_json_(self): return {"a": 1}
    def _repr_javascript_(self): return "js"
    def _repr_pdf_(self): return b"pdf"
Many()
# %%
class WithMeta:
    def _repr_html_(self): return "<b>x</b>", {"isolated": True}
WithMeta()
# %%
class Bundle:
    def _repr_mimebundle_(self, include=None, exclude=None): return {"text/plain": "b", "text/html": "<i>b</i>"}
Bundle()
# %%
class BundleMeta:
    def _repr_mimebundle_(self, **kw): return {"text/plain": "b", "image/png": PNG}, {"image/png": {"width": 1}}
BundleMeta()
# %%
class Own:
    def _ipython_display_(self): print("shows itself")
Own()
# %%
display(Own()); [Own()]
# %%
class Pretty2:
    def _repr_pretty_(self, p, cycle): p.text("pretty!")
[Pretty2()]
# %%
class Bad:
    def _repr_html_(self): raise ValueError("no html")
Bad()
# %%
class Worse:
    def __repr__(self): raise ValueError("no repr")
Worse()
# %%
display(Worse())
# %%
class NotText:
    def __repr__(self): return 3
NotText()
# %%
class Any:
    def __getattr__(self, name): return lambda *a, **k: "any"
Any()
# %%
class NotHtml:
    def _repr_html_(self): return 3
NotHtml()
# %%
class NoneHtml:
    def _repr_html_(self): return None
NoneHtml()
# %%
class Deep:
    def __repr__(self): return "Deep\nover lines"
{1: Deep(), 2: [Deep()]}
# %%
get_ipython().display_formatter.formatters["text/html"].for_type(Deep, lambda d: "<b>registered</b>")
# %%
Deep()
# %%
get_ipython().display_formatter.format(3)
# %%
set_matplotlib_formats("png")
# %%
from IPython.core.display import display as old_display
# %%
import IPython
IPython.display.display(5)
# %%
from IPython.display import clear_output
print(1); clear_output(); print(2)
# %%
print(1); clear_output(wait=True); print(2)
# %%
print(1); clear_output(wait=True)
# %%
display(1); clear_output(wait=True); 2
# %%
for n in range(3):
    clear_output(wait=True); print(n)
# %%
print("x"); clear_output(); clear_output(wait=True); 1 / 0
""",
    "handles": r"""
h = display(1, display_id=True)
# %%
h.update(2)
# %%
h
# %%
type(h), len(h.display_id) > 5
# %%
h2 = display("a", display_id="mine"); h2.update("b")
# %%
h2.update("c"); print("here")
# %%
display("again", display_id="mine")
# %%
update_display("d", display_id="mine") if "update_display" in globals() else None
# %%
from IPython.display import *
update_display("e", display_id="mine")
# %%
display("f", display_id="mine", update=True)
# %%
update_display("nobody", display_id="never shown")
# %%
update_display("no id")
# %%
h3 = DisplayHandle(); h3.display(3)
# %%
h3.update(HTML("<b>html</b>"))
# %%
h3.update({"text/plain": "raw"}, raw=True)
# %%
h3.update(4, metadata={"text/plain": {"a": 1}})
# %%
h4 = display(Image(bytes.fromhex("89504e470d0a1a0a")), display_id=True)
# %%
h4.update(Image(bytes.fromhex("89504e470d0a1a0a00")))
# %%
h5 = display(display_id="empty")
# %%
h5.update("filled")
# %%
h6 = display("cleared", display_id="c"); clear_output(); h6.update("not there")
# %%
h6.update("still not there")
# %%
h6.display("now it is")
# %%
print("before"); h7 = display("middle", display_id=True); print("after")
# %%
for n in range(5): h7.update(n)
# %%
display("x", display_id=3)
# %%
display(1, 2, display_id="two")
# %%
update_display(9, display_id="two")
# %%
display("wait", display_id="w"); clear_output(wait=True); print("new")
# %%
update_display("gone", display_id="w")
# %%
publish_display_data({"text/plain": "p"}, transient={"display_id": "p"})
# %%
publish_display_data({"text/plain": "q"}, transient={"display_id": "p"}, update=True)
# %%
def later():
    h.update("from a function")
later()
# %%
h.update("last"); 1 / 0
# %%
class Counter:
    def __init__(self): self.n = 0
    def __repr__(self): return f"counted {self.n}"
counter = Counter(); shown = display(counter, display_id=True)
# %%
for counter.n in range(10): shown.update(counter)
# %%
del h; display("y", display_id="mine"); h2
""",
    "errors": r"""
1 / 0
# %%
def f(:
# %%
x = = 3
# %%
  indented
# %%
if True:
print(1)
# %%
print("unclosed
# %%
(1, 2
# %%
print "old"
# %%
for i in range(3) print(i)
# %%
return 3
# %%
yield 3
# %%
break
# %%
class A:
    await x
# %%
f"{"
# %%
undefined_name
# %%
prnt(3)
# %%
import absent_module
# %%
from math import sine
# %%
"a" + 1
# %%
[1, 2][5]
# %%
{"a": 1}["b"]
# %%
int("x")
# %%
None.attribute
# %%
import math; math.pie
# %%
math.sqrt(-1)
# %%
def a(): return b()
def b(): return c()
def c(): raise ValueError("deep")
a()
# %%
raise ValueError
# %%
raise ValueError("two\nlines")
# %%
raise ValueError("a", 2)
# %%
raise Exception("x" * 500)
# %%
raise "text"
# %%
raise
# %%
class Own(Exception): pass
raise Own("mine")
# %%
class Silent(Exception):
    def __str__(self): return ""
raise Silent(3)
# %%
class BadStr(Exception):
    def __str__(self): raise ValueError("no str")
raise BadStr()
# %%
class NotStr(Exception):
    def __str__(self): return 3
raise NotStr()
# %%
try:
    1 / 0
except ZeroDivisionError as e:
    raise ValueError("while") from e
# %%
try:
    1 / 0
except ZeroDivisionError:
    undefined_name
# %%
try:
    1 / 0
except ZeroDivisionError:
    raise ValueError("hidden") from None
# %%
raise ExceptionGroup("several", [ValueError(1), TypeError(2)])
# %%
e = ValueError("noted"); e.add_note("a note"); e.add_note("another\nnote"); raise e
# %%
raise KeyError("a key")
# %%
raise FileNotFoundError(2, "No such file", "x.txt")
# %%
open("absent.txt")
# %%
raise SyntaxError("made up")
# %%
raise SyntaxError("with place", ("file.py", 1, 2, "the text", 1, 3))
# %%
compile("x = = 3", "<mine>", "exec")
# %%
eval("1 +")
# %%
exec("def g():\n    1 / 0\ng()")
# %%
eval("1 / 0")
# %%
import helper_with_error
# %%
import helper; helper.fail()
# %%
import helper_with_syntax_error
# %%
assert 1 == 2
# %%
assert 1 == 2, "not equal"
# %%
import numpy as np
np.zeros((2, 2)) @ np.zeros((3, 3))
# %%
np.linalg.inv(np.zeros((2, 2)))
# %%
np.array([1, 2])[7]
# %%
np.testing.assert_allclose([1.0, 2.0], [1.0, 2.5])
# %%
next(iter([]))
# %%
list(n / 0 for n in range(3))
# %%
[n / 0 for n in range(3)]
# %%
sorted([1, "a"])
# %%
f = lambda: 1 / 0
f()
# %%
class B:
    def __init__(self): self.m()
    def m(self): raise RuntimeError("method")
B()
# %%
class C:
    raise NotImplementedError("in a class")
# %%
with open("absent") as f: pass
# %%
import contextlib
@contextlib.contextmanager
def cm():
    yield
    raise ValueError("leaving")
with cm(): pass
# %%
def gen():
    yield 1
    raise ValueError("generator")
list(gen())
# %%
print("before"); 1 / 0; print("after")
# %%
display(1); 1 / 0
# %%
raise SystemExit
# %%
raise SystemExit("a message")
# %%
import sys; sys.exit(3)
# %%
sys.exit()
# %%
raise KeyboardInterrupt
# %%
raise GeneratorExit
# %%
raise StopIteration(3)
# %%
raise BaseException("base")
# %%
class OwnBase(BaseException): pass
raise OwnBase("own base")
# %%
raise MemoryError
# %%
raise EOFError
# %%
raise UnicodeDecodeError("utf-8", b"x", 0, 1, "why")
# %%
input("name?")
# %%
input()
# %%
import getpass; getpass.getpass()
# %%
breakpoint()
# %% differs: there is no debugger, nor anybody to use it
import pdb; pdb.set_trace()
# %% differs: there is no debugger, nor anybody to use it
sys.breakpointhook.__module__
# %%
def many(n):
    if n == 0:
        raise ValueError("bottom")
    many(n - 1)
many(30)
# %%
# a comment, and an error below an empty line

# here
1 / 0  # now
# %%
def long():
    a = 1
    b = 2
    c = 3
    d = 4
    e = 5
    raise ValueError(
        "over",
        a, b,
        c)
    f = 6
    g = 7
    return a
long()
# %%
class Hidden(Exception):
    def _render_traceback_(self): return ["rendered", "by itself"]
raise Hidden("x")
# %%
class Hidden2(Exception):
    def _render_traceback_(self): raise ValueError("no")
raise Hidden2("x")
# %%
def hide():
    __tracebackhide__ = True
    raise ValueError("hidden frame")
def outer():
    hide()
outer()
# %%
sys.last_type, sys.last_value
# %%
sys.exc_info()
# %%
%tb
# %%
%xmode Plain
# %%
a()
# %%
%xmode Minimal
# %%
a()
# %%
%xmode Verbose
# %%
a()
# %%
%xmode Docs
# %%
a()
# %%
%xmode Context
# %%
a()
# %%
%xmode wrong
# %%
%xmode
# %%
%xmode Context
# %%
def handler(shell, etype, value, tb, tb_offset=None): print("handled", etype.__name__)
get_ipython().set_custom_exc((ZeroDivisionError,), handler)
# %%
1 / 0
# %%
get_ipython().showtraceback()
# %%
try:
    a()
except ValueError:
    get_ipython().showtraceback()
# %%
get_ipython().showsyntaxerror()
# %%
sys.excepthook(ValueError, ValueError("by hand"), None)
""",
    "recursion": r"""
import sys
sys.setrecursionlimit(160)
# %%
def f(x): return f(x + 1)
f(0)
# %%
def even(n): return odd(n + 1)
def odd(n): return even(n + 1)
even(0)
# %%
def a(): b()
def b(): c()
def c():
    d()
def d(): a()
a()
# %%
class Loop:
    def __repr__(self): return repr(self)
Loop()
# %%
print(Loop())
# %%
class Less:
    def __eq__(self, other): return self == other
Less() == 1
# %%
class Attr:
    def __getattr__(self, name): return self.absent
Attr().x
# %%
class Prop:
    @property
    def x(self): return self.x
Prop().x
# %%
class Set:
    def __setattr__(self, k, v): self.k = v
Set().a = 1
# %%
f = lambda: f()
f()
# %%
exec("def g(): return g()\ng()")
# %%
import helper; helper.recurse(0)
# %%
def again(n):
    try:
        raise ValueError(n)
    except ValueError:
        if n: again(n - 1)
        raise
again(5)
# %%
def chain(n):
    try:
        if n: chain(n - 1)
        else: 1 / 0
    except Exception as e:
        raise ValueError(n) from e
chain(15)
# %%
class Big(Exception):
    def __repr__(self): return "x" * 10_000
    __str__ = __repr__
raise Big()
# %%
def fact(n): return n * fact(n - 1)
fact(5)
# %%
sorted([Less(), Less()])
# %%
x = []; x.append(x); x
# %%
d = {}; d["d"] = d; d
# %%
x == [x]
# %%
nested = []
for _n in range(5000): nested = [nested]
nested
# %%
print(nested)
# %%
import copy; copy.deepcopy(nested)
# %%
import json; json.dumps(nested)
# %%
eval("(" * 300 + ")" * 300)
# %%
def deep(n): return n if n == 0 else deep(n - 1)
deep(90)
# %%
def gen(n): yield from gen(n + 1)
next(gen(0))
# %%
import functools
@functools.lru_cache(None)
def cached(n): return cached(n + 1)
cached(0)
# %%
def wide(a, b=2, *args, c=3, **kw):
    local = [a] * 3
    if a:
        return wide(
            a + 1,
            b,
            *args,
        )
wide(1)
# %%
import numpy as np
def numeric(x): return np.add(numeric(x), 1)
numeric(np.eye(3))
""",
    "magics": r"""
%pwd
# %%
%cd data
# %%
%cd -
# %%
%cd ..
# %%
%cd transforms
# %%
import os; os.getcwd() == _dh[0], _dh[0].endswith("transforms")
# %%
%cd absent
# %%
os.chdir("data"); os.chdir(_dh[0]); os.path.basename(os.getcwd())
# %%
[os.path.basename(d) for d in _dh]
# %%
%dhist
# %%
%cd -0
# %%
%pushd data
# %%
%dirs
# %%
%popd
# %%
%bookmark -l
# %%
%ls -1
# %%
%ls data
# %%
%cat data/points.csv
# %%
%mkdir made
# %%
%rmdir made
# %%
%cp data/points.csv copied.csv
# %%
%mv copied.csv moved.csv
# %%
%rm moved.csv
# %%
%time 1 + 1
# %%
%time x = sum(range(1000))
# %%
%time print("timed")
# %%
%%time
x = 3
x
# %%
%timeit -n 1 -r 1 x
# %%
%%timeit -n 1 -r 1
x
# %%
t = %timeit -n 2 -r 2 -o -q x
# %%
t.loops
# %%
%%time
1 / 0
# %%
%who
# %%
%who int
# %%
del t
# %%
%whos
# %%
%who_ls
# %%
%psearch x*
# %% differs: three are of a kernel to which others connect: %connect_info, %qtconsole, %subshell; and %clear clears no terminal
%lsmagic
# %%
%magic
# %%
%quickref
# %%
%absent_magic
# %%
%%absent_cell_magic
1
# %%
%matplotlib
# %%
%matplotlib inline
# %%
%matplotlib --list
# %%
%config InlineBackend.figure_format = "png"
# %%
%config InlineBackend.figure_format
# %%
%config InteractiveShell.ast_node_interactivity = "all"
# %%
1
2
# %%
%config InteractiveShell.ast_node_interactivity = "last_expr_or_assign"
# %%
y = 3
# %%
%config InteractiveShell.ast_node_interactivity = "last_expr"
# %%
%config Absent.x = 3
# %% differs: there is no application around the kernel
%config
# %%
%env HOME_OF_MINE=here
# %%
%env HOME_OF_MINE
# %%
import os; os.environ["HOME_OF_MINE"]
# %%
%set_env OTHER 3
# %%
%env ABSENT_VARIABLE
# %%
%%capture kept
print("captured"); display(3); 4
# %%
kept.stdout, kept.stderr, kept.outputs
# %%
kept()
# %%
kept.show()
# %%
%%capture --no-display
print("x"); display(3)
# %%
%%capture
1 / 0
# %%
from IPython.utils.capture import capture_output
with capture_output() as c:
    print("in"); display(1)
c.stdout, len(c.outputs)
# %%
%%writefile written.py
print("from a file")
value = 7
# %%
%%writefile -a written.py
print("appended")
# %%
%run written.py
# %%
value
# %%
%run written
# %%
%run absent.py
# %%
%run -t written.py
# %%
%run -n written.py
# %%
%%writefile failing.py
def f(): 1 / 0
f()
# %%
%run failing.py
# %%
%%writefile arguments.py
import sys
print(sys.argv, __name__, __file__)
sys.exit(3)
# %%
%run arguments.py a -b "c d"
# %%
%pycat written.py
# %%
%load written.py
# %%
%run written.py; print("x")
# %%
%%python
print("another python")
# %%
%%python3
import sys; print(sys.argv)
# %%
%%script bash
echo script
# %%
%%script --out kept_output bash
echo kept
# %%
kept_output
# %%
%%script --no-raise-error bash
exit 3
# %%
%%bash
echo shell
# %%
%%bash
echo out; echo err >&2; exit 2
# %%
%%sh
pwd | sed 's,.*/,,'
# %%
%%bash --bg
sleep 0
# %%
%%html
<b>html</b>
# %%
%%markdown
*md*
# %%
%%latex
$x$
# %%
%%svg
<svg></svg>
# %%
%%javascript
1
# %%
%%js
1
# %%
%alias_magic t time
# %%
%alias say echo said
# %%
%say words
# %%
%unalias say
# %%
%automagic
# %%
%automagic
# %%
%autocall
# %%
%autosave 60
# %%
%autosave 0
# %%
%autosave x
# %%
%pprint
# %%
[[1] * 30, [2] * 30]
# %%
%pprint
# %%
%colors nocolor
# %%
%logstate
# %%
%history
# %%
%history -n 1-3
# %%
%recall 1
# %%
%rep 1
# %%
%macro m 1
# %%
m
# %%
%save -f saved.py 1-2
# %%
%notebook exported.ipynb
# %%
%pinfo x
# %%
x?
# %%
?x
# %%
x??
# %%
len?
# %%
absent_name?
# %%
*int*?
# %%
%pdoc len
# %%
%pdef len
# %%
%psource os.getcwd
# %%
%pfile os
# %%
%store x
# %%
%load_ext autoreload
# %%
%autoreload 2
# %%
%reload_ext autoreload
# %%
%unload_ext autoreload
# %%
%load_ext absent_extension
# %%
%pdb
# %%
%pdb
# %%
%prun -q 1
# %%
%%prun -q
1
# %%
%sc x=ls
# %%
%sx echo captured
# %%
%system echo captured
# %%
%reset_selective -f ^x$
# %%
x
# %%
%xdel y
# %%
%reset -f
# %%
value
# %%
%%file written2.txt
text
# %%
%%debug
# %%
%debug 1
# %%
%gui
# %% differs: there are no windows
%gui wrong
# %%
%code_wrap
# %%
%conda list
# %%
%killbgscripts
# %%
%page 3
# %%
%less written.py
# %%
%more written.py
# %%
%man ls
# %% differs: there is no editor
%edit x
# %%
%doctest_mode
# %%
1 + 1
# %%
%doctest_mode
# %% differs: nothing connects to the kernel
%subshell
# %%
%profile
# %%
%tb
# %%
%%
# %%
%
# %%
%%time
# %%
%time
# %%
%%capture
# %%
x = %time 3
x
# %%
y = %pwd
y.endswith("transforms")
# %%
for n in range(2):
    %time n
# %%
from IPython.core.magic import *
@register_line_magic
def hello(line):
    "Says hello."
    return f"hello {line}"
@register_cell_magic
def shout(line, cell):
    print(line, cell.upper())
@register_line_cell_magic
def both(line, cell=None): return line, cell
# %%
%hello there
# %%
%%shout loud
words
# %%
%both a
# %%
%%both a
b
# %%
%hello?
# %%
get_ipython().run_line_magic("hello", "again")
# %%
get_ipython().run_cell_magic("shout", "x", "y\n")
# %%
get_ipython().magic("hello old")
# %%
@magics_class
class Mine(Magics):
    @line_magic
    def counted(self, line): return len(line)
get_ipython().register_magics(Mine)
# %%
%counted abc
# %%
%config Completer
""",
    "shell": r"""
!echo shown
# %%
!echo one; echo two
# %%
!exit 3
# %%
_exit_code
# %%
x = !echo a; echo b
x
# %%
x.s, x.n, x.l, x.grep("a")
# %%
!!echo list
# %%
name = "world"
!echo hello {name} $name $HOME_X
# %%
!absent_command
# %%
!echo err >&2
# %%
!python -c "print(3)"
# %%
!sleep 0 &
# %%
!printf 'no newline'
# %%
import os, time
print("before"); os.system("echo during"); time.sleep(0.1); print("after")
# %%
print("before"); _ = os.system("echo during"); time.sleep(0.1); print("after")
# %%
print("a"); !echo b
print("c")
# %%
import subprocess
print("before"); subprocess.run(["echo", "during"]); time.sleep(0.1); print("after")
# %%
_ = subprocess.run("echo err >&2; exit 3", shell=True); time.sleep(0.1)
_
# %%
subprocess.run(["false"], check=True)
# %%
subprocess.run(["absent_command"])
# %%
subprocess.check_output(["echo", "x"]), subprocess.getoutput("echo y"), os.popen("echo z").read()
# %%
subprocess.run(["echo", "captured"], capture_output=True, text=True).stdout
# %%
_ = subprocess.Popen(["echo", "popen"]).wait(); time.sleep(0.1)
_
# %%
_ = subprocess.run(["cat"], input=b"given"); time.sleep(0.1)
_
# %%
subprocess.run(["echo", "to stdout"], stdout=sys.stdout) if "sys" in globals() else 1
# %%
import sys
_ = subprocess.run(["echo", "to stdout"], stdout=sys.stderr).returncode in (0, 1); time.sleep(0.1)
_
# %%
os.write(1, b"raw\n"); time.sleep(0.1)
# %%
os.write(2, b"raw err\n"); time.sleep(0.1)
# %%
display(1); os.system("echo between"); time.sleep(0.1); display(2)
# %%
import ctypes
libc = ctypes.CDLL(None); libc.puts(b"from C"); libc.fflush(None); time.sleep(0.1)
# %%
print("first"); libc.puts(b"from C"); libc.fflush(None); time.sleep(0.1); print("last")
# %%
_ = os.system("echo last"); time.sleep(0.1)
_
# %%
for n in range(3): print(n); os.system(f"echo {n}{n}"); time.sleep(0.1)
# %%
os.system("exit 3")
# %%
get_ipython().system("echo by name")
# %%
get_ipython().getoutput("echo by name")
# %%
get_ipython().getoutput("echo a; echo b", split=False)
# %%
print("no newline", end=""); _ = os.system("echo joined"); time.sleep(0.1)
# %%
os.system("echo before the error"); time.sleep(0.1); 1 / 0
# %%
if True:
    !echo indented
# %%
files = !ls data
print(files)
# %%
!ls -1 data
# %%
!test -t 1 && echo terminal || echo none
# %%
!echo $TERM $PAGER $CLICOLOR $FORCE_COLOR
# %%
os.environ["TERM"], os.environ["PAGER"], os.environ["GIT_PAGER"], os.environ.get("COLUMNS"), os.environ["FORCE_COLOR"]
# %% differs: Jupyter's and Python's settings are not those of the machine
sorted(k for k in os.environ if k.startswith(("CLI", "MPL", "PY", "JPY")))
# %%
os.environ["MPLBACKEND"]
# %%
!stty size
# %%
import shutil; shutil.get_terminal_size()
# %%
os.get_terminal_size()
# %%
os.isatty(0), os.isatty(1), os.isatty(2)
""",
    "system": r'''
import getpass, os, pwd
bool(getpass.getuser())
# %%
pwd.getpwuid(os.getuid()).pw_name == getpass.getuser()
# %%
os.path.expanduser("~") == os.environ["HOME"], os.path.isdir(os.path.expanduser("~"))
# %%
os.path.expanduser("~" + getpass.getuser()).startswith("/")
# %%
import pathlib; pathlib.Path.home().is_dir()
# %%
pathlib.Path("~").expanduser().is_dir(), pathlib.Path.cwd().name
# %%
pathlib.Path("data").owner() == getpass.getuser()
# %%
import grp; grp.getgrgid(os.getgid()).gr_name != ""
# %%
pathlib.Path("data").group() != ""
# %%
import tempfile
with tempfile.NamedTemporaryFile("w+") as f: f.write("x"); f.seek(0); print(f.read())
# %%
os.path.exists(tempfile.gettempdir()), os.path.exists("/dev/null"), os.path.exists("/tmp")
# %%
with open("note.txt", "w") as f: print("noted", file=f)
open("note.txt").read()
# %%
import platform; platform.system(), platform.python_version()[:2], platform.node() != "", platform.python_implementation()
# %%
import socket; socket.gethostname() != ""
# %%
os.getpid() > 0, os.getppid() >= 0
# %%
os.cpu_count() >= 1
# %%
import time; time.time() > 0, time.tzname != (), time.strftime("%Y") > "2000"
# %%
import locale, sys; locale.getpreferredencoding().lower(), sys.getdefaultencoding()
# %%
import random, numpy as np
random.seed(3); np.random.seed(3); random.random(), np.random.rand()
# %%
np.random.default_rng(3).random()
# %%
import sys, json, math, itertools, functools, scipy, matplotlib
"numpy" in sys.modules, "executor" in sys.modules, "channel" in sys.modules
# %%
scipy.__version__, np.__version__, matplotlib.__version__
# %%
import IPython; IPython.version_info[:1], IPython.get_ipython() is get_ipython()
# %%
from scipy.spatial.transform import Rotation
Rotation.from_euler("z", 90, degrees=True).as_matrix()
# %%
import transform_lab; transform_lab.__name__
# %%
import signal; signal.getsignal(signal.SIGINT) is not None, signal.getsignal(signal.SIGCHLD)
# %%
import threading; threading.current_thread() is threading.main_thread(), threading.main_thread().name
# %%
import pickle; pickle.loads(pickle.dumps({"a": np.eye(2)}))
# %%
class Local:
    def __init__(self): self.v = 1
pickle.loads(pickle.dumps(Local())).v
# %%
import inspect
def sourced(x):
    return x + 1
print(inspect.getsource(sourced))
# %%
print(inspect.getsource(Local))
# %%
inspect.getmodule(sourced), inspect.getsourcefile(sourced) is not None, inspect.signature(sourced)
# %%
inspect.currentframe().f_code.co_name, sourced.__code__.co_firstlineno
# %%
sourced.__code__.co_filename
# %%
import linecache; linecache.getline(sourced.__code__.co_filename, 1)
# %%
import doctest
def tested(x):
    """
    >>> tested(1)
    2
    """
    return x + 1
doctest.testmod()
# %%
doctest.run_docstring_examples(tested, globals(), verbose=True)
# %%
import unittest
class T(unittest.TestCase):
    def test_ok(self): self.assertEqual(1, 1)
    def test_bad(self): self.assertEqual(1, 2)
r = unittest.main(argv=["x"], exit=False, verbosity=2)
# %%
from multiprocessing import Pool
with Pool(2) as pool: print(pool.map(abs, [-1, 2]))
# %%
from concurrent.futures import ThreadPoolExecutor
with ThreadPoolExecutor(2) as pool: print(list(pool.map(abs, [-1, 2])))
# %%
import gc; gc.isenabled(), gc.get_threshold()
# %%
gc.collect() >= 0, gc.get_freeze_count() >= 0
# %%
import resource; resource.getrlimit(resource.RLIMIT_CORE)[0] >= -1
# %%
import atexit; atexit.register(print, "bye")
# %%
import importlib; importlib.reload(importlib.import_module("helper")).answer
# %%
import urllib.request
try:
    urllib.request.urlopen("http://127.0.0.1:9/", timeout=1)
except Exception as error:
    print(type(error).__name__)
# %%
os.umask(0o22)
# %%
oct(os.stat("note.txt").st_mode), os.access("note.txt", os.W_OK)
# %%
sys.path[0] in ("", os.getcwd()), "" in sys.path[:2]
# %%
[type(p) for p in sys.path[:1]], sys.meta_path != []
# %%
import typing, __main__
__main__.__dict__ is globals(), hasattr(__main__, "__file__"), hasattr(__main__, "__spec__")
# %%
__spec__, __loader__
# %%
type(__builtins__), hasattr(__builtins__, "get_ipython"), hasattr(__builtins__, "display"), __builtins__.__IPYTHON__
# %%
exit, quit
# %%
copyright, license, credits
# %%
open
# %% differs: the kernel is another class
input
# %%
print
''',
    "interpreter": r"""
get_ipython().__class__.__name__, type(get_ipython()).__module__
# %%
str(type(get_ipython()))
# %%
"IPKernelApp" in get_ipython().config, hasattr(get_ipython(), "kernel"), get_ipython().kernel is not None
# %%
get_ipython().has_trait("kernel")
# %%
from IPython.core.interactiveshell import InteractiveShell
InteractiveShell.instance() is get_ipython(), InteractiveShell.initialized()
# %%
get_ipython().execution_count
# %%
get_ipython().user_ns is globals(), get_ipython().user_module.__name__
# %%
ip = get_ipython()
ip.ev("1 + 1"), ip.ex("z = 3"), z
# %%
ip.run_cell("1 + 1")
# %%
ip.run_cell("print(5)").success
# %%
ip.run_cell("1 / 0").success
# %%
ip.run_code("print('code')")
# %%
ip.set_next_input("x = 1")
# %%
ip.push({"pushed": 3}); pushed
# %%
ip.drop_by_id({"pushed": 3}); pushed
# %%
ip.show_usage()
# %%
ip.banner[:6]
# %% differs: tracebacks have no colours
ip.colors, ip.xmode, ip.autocall, ip.automagic, ip.quiet, ip.pdb
# %%
ip.history_manager is not None, ip.history_length
# %%
list(ip.history_manager.get_range())[:2]
# %%
ip.history_manager.input_hist_raw[1]
# %%
ip.complete("pri")[1][:1]
# %%
ip.object_inspect("ip")["found"]
# %%
ip.input_transformers_post, ip.ast_transformers
# %%
def upper(lines): return [l.replace("PRINT", "print") for l in lines]
ip.input_transformers_cleanup.append(upper)
# %%
PRINT(3)
# %%
ip.input_transformers_cleanup.remove(upper)
# %%
def fail(lines):
    if lines[0].startswith("FAIL"): raise ValueError("transformer")
    return lines
ip.input_transformers_cleanup.append(fail)
# %%
FAIL
# %%
ip.input_transformers_cleanup.remove(fail)
# %%
2
# %%
def hook(*a): print("hook")
ip.events.register("post_run_cell", hook); ip.events.register("pre_run_cell", hook)
# %%
3
# %%
ip.events.unregister("post_run_cell", hook); ip.events.unregister("pre_run_cell", hook)
# %%
ip.events.register("post_execute", lambda: print("executed"))
# %%
4
# %%
ip.events.callbacks["post_execute"].pop(); ip.events.register("pre_execute", lambda: 1 / 0)
# %%
5
# %%
ip.events.callbacks["pre_execute"].pop()
# %%
ip.display_pub.__class__.__name__, ip.displayhook.__class__.__name__
# %%
ip.display_pub.publish({"text/plain": "published"})
# %%
ip.display_pub.publish(3)
# %%
ip.display_pub.clear_output()
# %%
ip.write_payload if hasattr(ip, "write_payload") else "none"
# %%
ip.payload_manager.read_payload()
# %%
ip.parent_header.__class__, ip.get_parent().__class__
# %%
ip.enable_matplotlib("inline")
# %%
ip.loop_runner
# %%
ip.autoawait
# %%
%autoawait
# %%
ip.ask_exit
# %%
ip.exiter, ip.exit_now
# %%
ip.user_global_ns is globals()
# %%
ip.input_prefilter if hasattr(ip, "input_prefilter") else "none"
# %%
ip.find_cell_magic("time") is not None, ip.find_line_magic("nothing")
# %%
ip.extract_input_lines("1-2")
# %%
ip.show_rewritten_input, ip.separate_in
# %%
ip.profile if isinstance(ip.profile, str) else 1
# %%
from IPython.core.getipython import get_ipython as again
again() is ip
# %% differs: ipykernel is not loaded, which takes as long as half a notebook
import sys
"ipykernel" in sys.modules
# %%
def is_notebook():
    try:
        return get_ipython().__class__.__name__ == "ZMQInteractiveShell"
    except NameError:
        return False
is_notebook()
# %%
import builtins; builtins.display is display, builtins.get_ipython is get_ipython
# %%
builtins._ if hasattr(builtins, "_") else "none"
# %%
ip.showtraceback
# %%
ip.auto_rewrite_input
# %%
ip.alias_manager.user_aliases != []
# %%
ip.magics_manager.lsmagic()["cell"] != []
# %%
ip.compile.__class__.__name__
# %%
exit
# %%
exit.__class__.__name__, quit.__class__.__name__
""",
    "blank": r'''

# %%
   
# %%
# a comment
# %%


# %%
pass
# %%
%pwd
# %%
"""text"""
# %%
1
# %%
%%capture
# %%
2
''',
    "asynchronous": r"""
import asyncio
await asyncio.sleep(0)
5
# %%
async def f(): return 7
await f()
# %%
f()
# %%
x = await f(); x
# %%
asyncio.get_event_loop().is_running()
# %%
asyncio.get_running_loop() is asyncio.get_event_loop()
# %%
asyncio.run(f())
# %%
asyncio.get_event_loop().run_until_complete(f())
# %%
task = asyncio.create_task(f())
# %%
await task
# %%
task.done(), task.result()
# %%
asyncio.ensure_future(f()).__class__
# %%
await asyncio.gather(f(), f())
# %%
async with asyncio.Lock(): print("locked")
# %%
async def g():
    for n in range(3): yield n
async for n in g(): print(n)
# %%
[n async for n in g()]
# %%
async def fail(): raise ValueError("in a coroutine")
await fail()
# %%
task = asyncio.create_task(fail())
await asyncio.sleep(0)
# %%
task
# %%
await asyncio.wait_for(asyncio.sleep(5), 0.01)
# %%
try:
    async with asyncio.timeout(0.01): await asyncio.sleep(5)
except TimeoutError: print("late")
# %%
await asyncio.to_thread(lambda: 3)
# %%
await asyncio.get_event_loop().run_in_executor(None, lambda: 4)
# %%
p = await asyncio.create_subprocess_exec("echo", "x", stdout=asyncio.subprocess.PIPE)
(await p.communicate())[0]
# %%
q = asyncio.Queue(); await q.put(1); await q.get()
# %%
await 3
# %%
await asyncio.sleep(0); 1 / 0
# %%
raise asyncio.CancelledError
# %%
async def cancel():
    asyncio.current_task().cancel(); await asyncio.sleep(0)
await asyncio.create_task(cancel())
# %%
6
# %%
import threading
t = threading.Thread(target=lambda: print("from a thread")); t.start(); t.join()
# %%
def bad(): 1 / 0
t = threading.Thread(target=bad); t.start(); t.join()
# %%
def shows(): display(3)
t = threading.Thread(target=shows); t.start(); t.join()
# %%
ts = [threading.Thread(target=print, args=(f"{n}\n",), kwargs={"end": ""}) for n in range(3)]
for t in ts: t.start(); t.join()
# %%
asyncio.run(asyncio.sleep(0)) if False else None
# %%
asyncio.new_event_loop().run_until_complete(f())
# %%
def in_thread(): print(asyncio.run(f()))
t = threading.Thread(target=in_thread); t.start(); t.join()
# %%
print("start"); await asyncio.sleep(0.01); print("end")
# %%
asyncio.get_event_loop().__class__.__module__.startswith("asyncio"), asyncio.current_task() is not None
# %%
loop = asyncio.get_event_loop(); loop.call_soon(print, "called"); await asyncio.sleep(0)
# %%
await asyncio.sleep(0, result=3)
# %%
if True:
    await asyncio.sleep(0)
    print("inside")
# %%
def sync():
    await asyncio.sleep(0)
# %%
class K:
    async def m(self): return 1
    async def __aenter__(self): print("in"); return self
    async def __aexit__(self, *a): print("out")
async with K() as k: print(await k.m())
# %%
import contextvars
v = contextvars.ContextVar("v", default=0); v.set(3)
# %%
v.get()
# %%
await asyncio.sleep(0); v.set(5)
# %%
v.get()
# %%
import decimal; decimal.getcontext().prec = 5
# %%
decimal.Decimal(1) / 3
# %%
import numpy as np; np.seterr(all="raise"); np.set_printoptions(precision=2)
# %%
np.array([1 / 3]) / 0
# %%
np.array([1 / 3])
# %%
async def ticks():
    for n in range(3): await asyncio.sleep(0)
    return "ticked"
running = asyncio.create_task(ticks())
# %%
await running
""",
    "figures": r"""
import matplotlib.pyplot as plt
plt.plot([1, 2])
# %%
plt.plot([1, 2]);
# %%
plt.plot([1, 2])
plt.show()
# %%
plt.plot([1, 2]); plt.title("t"); plt.show(); print("after")
# %%
fig, ax = plt.subplots()
ax.plot([1, 2])
# %%
fig
# %%
fig, ax = plt.subplots(); print("text"); 3
# %%
plt.figure(); plt.figure(); None
# %%
plt.plot([1]); plt.close()
# %%
display(fig)
# %%
plt.figure(figsize=(2, 2)); plt.imshow([[1, 2], [3, 4]])
# %%
plt.plot([1, 2]); 1 / 0
# %%
plt.savefig("saved.png"); import os; os.path.exists("saved.png")
# %%
import matplotlib; matplotlib.get_backend()
# %%
plt.isinteractive(), plt.rcParams["figure.dpi"], plt.rcParams["figure.figsize"]
# %%
%matplotlib inline
# %%
plt.scatter([1], [2])
# %%
from mpl_toolkits.mplot3d import Axes3D
ax = plt.figure().add_subplot(projection="3d"); ax.quiver(0, 0, 0, 1, 0, 0)
# %%
plt.rcParams["svg.hashsalt"] = "same"
%config InlineBackend.print_figure_kwargs = {"bbox_inches": "tight", "metadata": {"Date": None}}
%config InlineBackend.figure_formats = ["svg"]
# %%
plt.plot([1, 2]);
# %%
%config InlineBackend.figure_formats = ["png"]
# %%
%config InlineBackend.close_figures = False
# %%
plt.plot([1, 2]);
# %%
plt.plot([2, 1]);
# %%
%matplotlib notebook
# %%
%matplotlib widget
# %%
%matplotlib agg
# %%
plt.plot([1]); plt.show()
# %%
matplotlib.use("Agg"); plt.figure()
# %%
%matplotlib inline
plt.plot([3]);
# %%
%pylab inline
# %%
from matplotlib import animation
a = animation.FuncAnimation(fig, lambda n: [], frames=2, cache_frame_data=False); type(a)
""",
    "widgets": r"""
import ipywidgets as w
# %%
type(w.IntSlider())
# %%
w.IntSlider(value=3)
# %%
s = w.FloatSlider(description="a"); display(s)
# %%
s.value = 5; s.value
# %%
s.observe(lambda change: print("changed", change["new"]), "value"); s.value = 7
# %%
w.interact(lambda x: x * 2, x=3)
# %%
@w.interact(x=(0, 10))
def shown(x=4): print("x is", x)
# %%
w.interactive(lambda x: x, x=2)
# %%
w.HBox([w.Label("a"), w.Button(description="b")])
# %%
out = w.Output()
with out: print("inside")
print("outside")
# %%
out
# %%
out.outputs
# %%
with out: display(3); 1 / 0
# %%
out.append_stdout("appended"); [kept["output_type"] for kept in out.outputs]
# %%
out.clear_output()
# %%
with out: print("again")
# %%
@out.capture()
def f(): print("captured")
f(); print("not")
# %%
out2 = w.Output(); display(out2)
with out2: print("shown in it")
# %%
w.interact_manual(lambda x: x, x=1)
# %%
b = w.Button(); b.on_click(lambda b: print("clicked")); b.click()
# %%
w.HTML("<b>x</b>").value
# %%
p = w.IntProgress(max=3); display(p)
for n in range(3): p.value = n
# %%
w.Widget.close_all()
""",
    "hidden prompts": r'''
1; 2
# %%
1 ;
# %%
1;  # a comment
# %%
"text;"
# %%
x = 3;
# %%
print(1);
# %%
display(1);
# %%
(1
);
# %%
1 if True else 2
# %%
def f():
    return 1
f()
# %%
f(); # %% not a cell
# %%
x == 3
# %%
x = 4; x
# %%
[x for x in range(3)]; 
# %%
with open("data/points.csv") as f:
    f.read()
# %%
try:
    1
finally:
    2
# %%
@property
def p(self): return 1
# %%
p
# %%
import os as operating
# %%
x: int = 3
# %%
x += 1
# %%
(y := 5)
# %%
lambda: 1;
# %%
...
# %%
Ellipsis is ...
# %%
match x:
    case 4: print("four")
# %%
x = 1
x
x + 1
# %%
print(x) or x
# %%
"""doc
string"""
# %%
a = [1,
     2]
a
# %%
a\
[0]
# %%
if x:
    print("yes")

else:
    print("no")
# %%
	x
# %%
 x
# %%
x  
# %%
    x = 1
    print(x)
# %%
>>> 1 + 1
# %%
>>> for n in range(2):
...     print(n)
# %%
In [1]: 5
# %%
?
# %%
x.?
# %%
/print 3
# %%
,print a b
# %%
;print a b
# %%
exec("5")
# %%
ls -1
# %%
pwd
# %%
cd
# %%
time 1
# %%
who
# %%
cat data/points.csv
# %%
!
# %%
!!
# %%
# %time 1
# %%
#!echo
1
# %%
%time # comment
# %%
x = !
# %%
global x
# %%
nonlocal x
# %%
del x
# %%
x
# %%
from __future__ import annotations
# %%
def g(x: undefined_type): return x
g.__annotations__
# %%
from __future__ import braces
# %%
import this
# %%
import antigravity_absent
# %%
print(3
# %%
print(3))
# %%
x = 'a
# %%
x = """a
# %%
dict(a=1, a=2)
# %%
f(**{1: 2})
# %%
f(1)
# %%
"é" == "e\u0301"
# %%
π = 3; π
# %%
x‑y
# %%
“quoted”
# %%
0777
# %%
1_000
# %%
1__0
# %%
{**{"a": 1}, "b": 2}
# %%
print(f"{x!r:>10}") if "x" in globals() else print("none")
# %%
True = 3
# %%
f() = 3
# %%
if x = 3: pass
# %%
else: pass
# %%
def
# %%
class
# %%
import
# %%
from math import (sin,
  cos)
sin(0), cos(0)
''',
    "exit": r"""
1
# %%
exit
""",
}
