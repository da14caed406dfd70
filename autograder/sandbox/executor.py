"""Runs the cells of one notebook as Jupyter would, and calls its functions. Lives inside the sandbox.

The outputs are nbformat's; they are meant to be what ipykernel gives for the same cells: streams, display and update,
clear_output, figures, magics, `!commands`, top-level await.
"""

import asyncio
import base64
import builtins
import contextlib
import contextvars
import ctypes
import getpass
import os
import random
import re
import signal
import sys
import sysconfig
import tempfile
from pathlib import Path

import comm
import numpy as np
from outputs import Comm, Outputs, OutStream
from shell import CONFIG, Kernel, ZMQInteractiveShell
from transform_lab.judging.calling import call, one_line
from transform_lab.judging.verdict import Reply

LAUNCHED = [f"{sysconfig.get_path('purelib')}/ipykernel_launcher.py", "-f", "/tmp/kernel.json"]  # as ipykernel is


class Interrupted(KeyboardInterrupt):
    """The grader's time limit; shown as one line, since where the cell happened to be says little."""

    def _render_traceback_(self):
        return [str(self)]


class Executor:
    """One notebook: its namespace, its outputs, and the student's functions."""

    def __init__(self):
        """All that can be made before it is known which notebook is run."""
        self.outputs = Outputs()
        kernel = Kernel()
        self.shell = kernel.shell = ZMQInteractiveShell.instance(
            outputs=self.outputs, kernel=kernel, colors="nocolor", config=CONFIG
        )
        self.shell.extension_manager.load_extension("storemagic")  # as ipykernel does
        Comm.outputs, comm.create_comm = self.outputs, Comm
        sys.breakpointhook = lambda *_, **__: None  # as where no debugger listens
        builtins.input, getpass.getpass = kernel.raw_input, kernel.getpass
        self.libc = ctypes.CDLL(None)
        self.context = contextvars.copy_context()  # of all cells and calls: NumPy and decimal keep their settings there
        self.running = False
        self.kept = {}  # {name: function}, of those that are called as they once were

    def start(self, files):
        """The rest, in the notebook's own process and folder.

        files: what the student handed in besides notebooks, {path relative to the folder: bytes as base64}
        """
        random.seed()
        np.random.seed()
        signal.signal(signal.SIGINT, self._interrupt)
        raw = {"stdout": 1, "stderr": 2}
        for descriptor in raw.values():
            with tempfile.TemporaryFile() as file:
                os.dup2(file.fileno(), descriptor)
        self.outputs.start(raw)
        for name in raw:
            setattr(sys, name, OutStream(name, self.outputs, os.open(os.devnull, os.O_WRONLY)))
        self.shell.begin()
        self.loop = asyncio.new_event_loop()
        asyncio.set_event_loop(self.loop)
        # Only now: a student's own numpy.py must not become the grader's.
        for path, content in files.items():
            with contextlib.suppress(OSError):  # a file that cannot be made here must not cost the notebook
                Path(path).parent.mkdir(parents=True, exist_ok=True)
                Path(path).write_bytes(base64.b64decode(content))
        packages = (n for n, path in enumerate(sys.path) if path.endswith(("/site-packages", "/dist-packages")))
        sys.path.insert(next(packages, 0), "")  # as in Jupyter: modules beside the notebook
        sys.argv[:] = LAUNCHED

    def prepare(self, source):
        """Run lines of the grader's before the first cell; they have no outputs, and do not count."""
        exec(source, self.shell.user_ns)
        return {}

    def run_cell(self, source):
        """Run one cell: {"outputs", "changed" of cells above, "execution_count", "ended", "failed"}."""
        failed = True
        try:
            self.running = True
            # A Jupyter cell runs inside an event loop: `await` works, asyncio.run says that a loop is running.
            failed = not self.loop.run_until_complete(self.loop.create_task(self._run(source), context=self.context))
            self.context.run(self.outputs.tell)
        except (Exception, KeyboardInterrupt):  # IPython shows those of the cell; this one came between its own steps
            self.shell.showtraceback()
        finally:
            self.running = False
        self.libc.fflush(None)
        outputs, changed = self.outputs.take()
        return {
            "outputs": outputs,
            "changed": changed,
            "execution_count": self.shell.execution_count - 1,
            "ended": self.shell.ended,
            "failed": failed,
        }

    def keep(self, name):
        """Have `calls` call the function that has this name now."""
        self.kept[name] = self.shell.user_ns.get(name)
        return {}

    def calls(self, name, cases):
        """Call a function of the notebook with the plain arguments of each case, [args, kwargs]; nobody sees what it prints.

        Yields a transform_lab.judging.verdict.Reply to each as a dictionary, with whether its arguments were "changed" in
        their stead; the first that neither returned nor raised is the last.
        """
        function = self.kept.get(name, self.shell.user_ns.get(name))
        for args, kwargs in cases:
            reply = self._call(function, args, kwargs)
            yield reply
            if not Reply(reply["outcome"]).finished:
                break

    def _call(self, function, args, kwargs):
        if not callable(function):
            return {"outcome": "undefined"}
        try:
            self.running = True
            reply = vars(self.context.run(call, function, args, kwargs))
            return reply | {"arguments": None, "changed": reply["arguments"] not in (None, [args, kwargs])}
        except KeyboardInterrupt:
            return {"outcome": "timeout"}
        except BaseException as error:  # SystemExit and whatever a student derived from BaseException
            return {"outcome": "raised", "error": one_line(error)}
        finally:
            self.running = False
            self.outputs.forget()

    async def _run(self, source):
        """As ipykernel does it; whether it ran without an error."""
        shell = self.shell
        shell.display_failed = False
        cell = None
        with contextlib.suppress(Exception):  # of a transformer that the student has put in: IPython meets it again
            cell = shell.transform_cell(source)
        if cell is None:
            return shell.run_cell(source, store_history=True).success
        running, result = shell.run_cell_async(source, store_history=True, transformed_cell=cell), None
        if re.search("await|async", cell) and shell.should_run_async(source, transformed_cell=cell):
            running = asyncio.ensure_future(running)  # what it sets in its context ends with it
        try:
            result = await running
        except Exception:  # of a student's that IPython met while it showed another
            shell.showtraceback(running_compiled_code=True)
            return False
        finally:
            shell.events.trigger("post_execute")  # figures are shown here
            shell.events.trigger("post_run_cell", result)
        return result.success and not shell.display_failed

    def _interrupt(self, *_):
        if self.running:
            raise Interrupted("The grader stopped this cell: it took too long.")
