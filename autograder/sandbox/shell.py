"""IPython set up as ipykernel sets it up, but for what only a kernel with a browser can do. Lives inside the sandbox."""

import ast
import copy
import inspect
import itertools
import os
import tempfile
import warnings
import zlib
from functools import partial
from types import CodeType, TracebackType

from IPython.core import page
from IPython.core.autocall import ZMQExitAutocall
from IPython.core.compilerop import CachingCompiler
from IPython.core.display_trap import DisplayTrap
from IPython.core.displayhook import DisplayHook
from IPython.core.displaypub import DisplayPublisher
from IPython.core.error import StdinNotImplementedError, UsageError
from IPython.core.interactiveshell import InteractiveShell
from IPython.core.magic import Magics, line_magic, magics_class
from IPython.display import Javascript, display
from traitlets import Any, Instance, Type, default
from traitlets.config import Config

ENVIRONMENT = {
    "TERM": "xterm-color",
    "CLICOLOR": "1",
    "FORCE_COLOR": "1",
    "CLICOLOR_FORCE": "1",
    "PAGER": "cat",
    "GIT_PAGER": "cat",
}
CONFIG = Config(
    HistoryManager={"enabled": False},  # nothing to look back to, and no thread that writes it down
    IPKernelApp={"parent_appname": ""},  # tqdm asks whether it is there
)
MOST_FRAMES = 100  # of a traceback; of a longer one, those that say the same are counted


class ZMQDisplayPublisher(DisplayPublisher):
    """Turns `display(…)` into outputs."""

    outputs = Any()

    def publish(self, data, metadata=None, *, transient=None, update=False, **_):
        metadata, transient = metadata or {}, transient or {}
        self._validate_data(data, metadata)
        if update:
            self.outputs.update(transient.get("display_id"), data, metadata)
            return
        shown = {"output_type": "display_data", "data": data, "metadata": metadata}
        if transient.get("display_id"):
            self.outputs.update(transient["display_id"], data, metadata)
        self.outputs.add(shown | {"transient": transient})

    def clear_output(self, wait=False):
        self.outputs.clear(wait)


class ZMQShellDisplayHook(DisplayHook):
    """Turns the value of a cell's last line into an output."""

    outputs = Any()
    showing = False

    def quiet(self):
        cells = self.shell.history_manager.input_hist_parsed
        known = self.shell.compile.quiet.get(cells[-1]) if cells else None
        return super().quiet() if known is None else known

    def start_displayhook(self):
        self.showing = True

    def write_output_prompt(self):
        """Jupyter shows the prompt itself."""

    def write_format_data(self, format_dict, md_dict=None):
        if format_dict:
            shown = {"output_type": "execute_result", "execution_count": self.prompt_count}
            self.outputs.add(shown | {"data": format_dict, "metadata": md_dict or {}})

    def finish_displayhook(self):
        """Jupyter ends the line itself."""
        self.showing = False


class XCachingCompiler(CachingCompiler):
    """Names cells as files that are not there: warnings, syntax errors and IPython's choice of lines depend on it.

    Of cells that are expected it keeps what was made of them.
    """

    def __init__(self):
        super().__init__()
        self.trees = {}  # {text of a cell: (flags, its syntax tree)}
        self.codes = {}  # {(id of a statement in one of the trees, mode, flags): (the statement, its code)}
        self.quiet = {}  # {text of a cell: whether it ends in a semicolon}

    def expect(self, cell):
        """Parse and compile a cell (as transformed) that will be run, as IPython will; one that gives a warning is left."""
        if cell in self.trees:
            return
        tree, flags = super().ast_parse(cell), self.flags
        codes = {}
        with self.extra_flags(ast.PyCF_ALLOW_TOP_LEVEL_AWAIT):
            for statement in tree.body:
                shown = statement is tree.body[-1] and isinstance(statement, ast.Expr)
                mode, whole = ("single", ast.Interactive) if shown else ("exec", partial(ast.Module, type_ignores=[]))
                code = super().__call__(whole([statement]), "", mode)
                codes[id(statement), mode, self.flags] = statement, code
        if self.flags == flags:  # it imports nothing from __future__
            self.trees[cell], self.quiet[cell] = (flags, tree), DisplayHook.semicolon_at_end_of_expression(cell)
            self.codes |= codes
        self.flags = flags

    def ast_parse(self, source, filename="<unknown>", symbol="exec"):
        flags, tree = self.trees.get(source, (None, None))
        if (flags, symbol) != (self.flags, "exec"):
            return super().ast_parse(source, filename, symbol)
        return ast.Module(list(tree.body), tree.type_ignores)

    def __call__(self, source, filename, symbol, **kwargs):
        body = source.body if isinstance(source, (ast.Module, ast.Interactive)) else ()
        if len(body) == 1:
            statement, code = self.codes.get((id(body[0]), symbol, self.flags), (None, None))
            if statement is body[0]:
                return _in_file(code, filename)
        return super().__call__(source, filename, symbol, **kwargs)

    def get_code_name(self, raw_code, code, number):
        number = zlib.crc32(raw_code.encode(errors="replace"))
        return f"{tempfile.gettempdir()}/ipykernel_{os.getpid()}/{number}.py"


def _in_file(code, name):
    """A code object as if it had been compiled in a file of this name."""
    constants = (_in_file(one, name) if isinstance(one, CodeType) else one for one in code.co_consts)
    return code.replace(co_filename=name, co_consts=tuple(constants))


@magics_class
class KernelMagics(Magics):
    """Those that ipykernel adds, and a notebook without a browser can have."""

    @line_magic
    def autosave(self, arg_s):
        """Set the time between two savings of a notebook in seconds: %autosave 60"""
        try:
            seconds = int(arg_s)
        except ValueError as error:
            raise UsageError(f"%autosave requires an integer, got {arg_s!r}") from error
        script = Javascript(f"IPython.notebook.set_autosave_interval({1000 * seconds})")
        display(script, include=["application/javascript"])
        print(f"Autosaving every {seconds} seconds" if seconds else "Autosave disabled")

    @line_magic
    def less(self, arg_s):
        """Show a file in the pager, which is a part of the browser's window."""
        if not arg_s:
            raise UsageError("Missing filename.")
        with open(arg_s) as file:
            page.page(file.read())

    @line_magic
    def more(self, arg_s):
        """As %less."""
        self.less(arg_s)

    @line_magic
    def man(self, arg_s):
        """Show the manual's page of a command in the pager."""


class Kernel:
    """What libraries ask the kernel for."""

    def get_parent(self, *_):
        return self.shell.get_parent()

    def raw_input(self, prompt=""):
        """There is nobody to answer."""
        raise StdinNotImplementedError("raw_input was called, but this frontend does not support input requests.")

    def getpass(self, prompt="", stream=None):
        raise StdinNotImplementedError("getpass was called, but this frontend does not support input requests.")


class ZMQInteractiveShell(InteractiveShell):
    """IPython without a terminal, a history file or a keyboard; libraries know by its name that they are in a notebook."""

    outputs, kernel = Any(), Any()
    display_pub_class, displayhook_class = Type(ZMQDisplayPublisher), Type(ZMQShellDisplayHook)
    compiler_class = Type(XCachingCompiler)
    exiter = Instance(ZMQExitAutocall)
    keepkernel_on_exit = None
    ended = False
    display_failed = False  # the value of the cell's last line could not be shown
    transformers = None  # those that IPython comes with

    def __init__(self, **kwargs):
        self.expected = {}  # {text of a cell: what IPython's transformers make of it}
        super().__init__(**kwargs)

    @default("exiter")
    def _default_exiter(self):
        return ZMQExitAutocall(self)

    def expect(self, cells):
        """Make of these cells (texts) what IPython will make of them, once for all notebooks."""
        self.transformers = self._transformers()
        for cell in set(cells) - self.expected.keys():
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                try:
                    transformed = self.transform_cell(cell)
                    self.compile.expect(transformed)
                    if len(transformed.splitlines()) > 1:  # a single line may call what is defined by then
                        self.expected[cell] = transformed
                except (SyntaxError, ValueError, Warning):
                    continue  # it will be shown when it is run

    def transform_cell(self, raw_cell):
        if raw_cell in self.expected and self._transformers() == self.transformers:
            return self.expected[raw_cell]
        return super().transform_cell(raw_cell)

    def _transformers(self):
        manager = self.input_transformer_manager
        lists = manager.cleanup_transforms, manager.line_transforms, manager.token_transformers
        return [*map(list, lists), list(self.input_transformers_post)]

    def transform_ast(self, node):
        return super().transform_ast(copy.deepcopy(node) if self.ast_transformers else node)

    def begin(self):
        """What depends on the folder that the notebook runs in."""
        self.starting_dir, self.home_dir = os.getcwd(), os.environ["HOME"]
        self.history_manager.reset(new_session=False)

    def init_environment(self):
        os.environ.update(ENVIRONMENT)

    def init_virtualenv(self):
        """The packages of a notebook are those that it is started with."""

    def init_display_pub(self):
        self.display_pub = self.display_pub_class(parent=self, shell=self, outputs=self.outputs)
        self.configurables.append(self.display_pub)

    def init_displayhook(self):
        self.displayhook = self.displayhook_class(parent=self, shell=self, outputs=self.outputs)
        self.configurables.append(self.displayhook)
        self.display_trap = DisplayTrap(hook=self.displayhook)

    def init_hooks(self):
        super().init_hooks()
        self.set_hook("show_in_pager", page.as_hook(lambda *_, **__: None), 99)  # beside the notebook, and not in it

    def init_magics(self):
        super().init_magics()
        self.register_magics(KernelMagics)

    def init_traceback_handlers(self, custom_exceptions):
        super().init_traceback_handlers(custom_exceptions)
        self.InteractiveTB.get_records = partial(few_records, self.InteractiveTB.get_records)

    def _showtraceback(self, etype, evalue, stb):
        self.display_failed |= self.displayhook.showing
        self.outputs.add(
            {"output_type": "error", "ename": str(etype.__name__), "evalue": str(evalue), "traceback": list(stb)}
        )

    def ask_exit(self):
        self.ended = not self.keepkernel_on_exit

    def enable_gui(self, gui=None):
        """There is no window to show anything in."""

    @property
    def parent_header(self):
        """The message that ipykernel runs the cell for, as far as ipywidgets asks for it."""
        return {"header": {"msg_id": str(self.outputs.cell)}}

    def get_parent(self):
        return self.parent_header

    def set_parent(self, parent):
        """Whatever comes is the running cell's."""


def few_records(all_records, traceback, context, tb_offset):
    """The frames that IPython shows of a traceback (its `all_records`); where there are too many of them, which takes seconds,
    those that repeat the same line are counted, as IPython does in a terminal."""
    import stack_data
    from IPython.core.tbtools import FrameInfo
    from stack_data.utils import collapse_repeated, frame_and_lineno, iter_stack

    def line(one):
        frame, number = frame_and_lineno(one)
        return frame.f_code, number

    stack = list(iter_stack(traceback))
    for name in {one.tb_frame.f_code.co_filename for one in stack}:
        if not os.path.exists(name):  # it is no module's: else all modules are searched for it, again for each frame
            inspect.modulesbyfile[name] = inspect.modulesbyfile[os.path.abspath(name)] = ""
    if len(stack) <= MOST_FRAMES:
        return all_records(traceback, context, tb_offset)
    records = []
    parts = collapse_repeated(stack, collapser=stack_data.RepeatedFrames, key=line)
    for repeated, group in itertools.groupby(parts, lambda part: isinstance(part, stack_data.RepeatedFrames)):
        if repeated:
            records += map(FrameInfo._from_stack_data_FrameInfo, group)
        else:
            records += all_records(_joined(list(group)), context, tb_offset)
    return records


def _joined(tracebacks):
    """A traceback of these alone, one below the other."""
    below = None
    for one in reversed(tracebacks):
        below = TracebackType(below, one.tb_frame, one.tb_lasti, one.tb_lineno)
    return below


for _class in (ZMQInteractiveShell, ZMQDisplayPublisher):
    _class.__module__ = "ipykernel.zmqshell"
ZMQShellDisplayHook.__module__ = "ipykernel.displayhook"
