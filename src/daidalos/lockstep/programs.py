"""Programs of a lock-step run: what would be processes of their own, as groups of threads with a state of their own.

A program has its arguments, environment, working folder, output, random numbers, signal handlers and exit status, and
what rclpy keeps once a process. Modules are shared, but for ``__main__``.
"""

from __future__ import annotations

import contextlib
import importlib
import io
import os
import signal
import sys
import threading
import traceback
from collections.abc import Callable, Mapping, Sequence
from types import ModuleType
from typing import Any, ClassVar
from weakref import WeakSet

from daidalos.lockstep.patching import Randomness
from daidalos.lockstep.scheduler import Owner, Scheduler, Thread

_ONCE_A_PROCESS: dict[str, dict[str, Callable[[], Any]]] = {
    "rclpy": {"__executor": lambda: None},
    "rclpy.utilities": {"g_default_context": lambda: None},
    "rclpy.context": {"g_logging_ref_count": int},
    "rclpy.signals": {
        "_contexts": WeakSet,
        "_guards": WeakSet,
        "_installed": lambda: importlib.import_module("rclpy.signals").SignalHandlerOptions.NO,
        "_previous": dict,
        "_previous_hook": lambda: None,
        "_last_signal_s": lambda: float("-inf"),
    },
    "daidalos.nodes.runner": {"_failed": threading.Event},
}
"""Variables of modules that are a process's own, with functions that create their first values."""

_VARIABLES = (
    *(("sys", name) for name in ("argv", "path", "stdout", "stderr", "excepthook")),
    ("threading", "excepthook"),
    *((module, name) for module, names in _ONCE_A_PROCESS.items() for name in names),
)
"""Modules and names of a program's own variables; `Program` creates their first values in this order."""

_real_chdir = os.chdir


class _Places:
    """Where a program's own variables are, in the modules that are loaded by now."""

    def __init__(self) -> None:
        self._found: list[tuple[int, dict[str, Any], str]] = []
        self._modules = 0

    def loaded(self) -> list[tuple[int, dict[str, Any], str]]:
        """Return the numbers of the variables, the dictionaries that hold them, and their names."""
        if len(sys.modules) != self._modules:
            self._modules = len(sys.modules)
            self._found = [
                (number, vars(sys.modules[module]), name)
                for number, (module, name) in enumerate(_VARIABLES)
                if module in sys.modules and name in vars(sys.modules[module])
            ]
        return self._found


_places = _Places()


class Terminated(BaseException):
    """A signal that a program does not handle ends it."""

    def __init__(self, number: int) -> None:
        super().__init__(number)
        self.number = number


class _Output(io.RawIOBase):
    """Raw stream that passes bytes on."""

    def __init__(self, write: Callable[[bytes], object]) -> None:
        super().__init__()
        self._write = write

    def writable(self) -> bool:
        """Return True."""
        return True

    def write(self, data: Any) -> int:
        """Pass bytes on."""
        data = bytes(data)
        self._write(data)
        return len(data)


class Program(Owner):
    """A program of a run.

    Parameters
    ----------
    scheduler : Scheduler
    body : callable
        What it does; returns the exit status as `sys.exit` takes it.
    argv : sequence of str
        Its ``sys.argv``.
    seed : int
        Of its random numbers.
    environ : mapping, optional
        Its environment; that of the creating program where None.
    folder : str, optional
        Its working folder.
    on_output : callable, optional
        Takes 1 or 2 and the bytes that it writes; they go to the output of the creating program where None.

    Attributes
    ----------
    status : int or None
        The exit status, or minus the number of the signal that ended it; None before.
    on_exit : list of callable
        Called with the status when it has ended.
    handlers : dict
        Handlers of signals by number.
    """

    _present_folder: ClassVar[str] = ""

    def __init__(
        self,
        scheduler: Scheduler,
        body: Callable[[], Any],
        argv: Sequence[str],
        seed: int,
        *,
        environ: Mapping[str, str] | None = None,
        folder: str | None = None,
        on_output: Callable[[int, bytes], object] | None = None,
    ) -> None:
        self.name = os.path.basename(argv[0]) if argv else "program"
        self.scheduler = scheduler
        self.randomness = Randomness(seed)
        self.status: int | None = None
        self.on_exit: list[Callable[[int], None]] = []
        self.handlers: dict[int, Any] = {signal.SIGINT: signal.default_int_handler}
        self.main_thread: Any = threading.main_thread()
        self._body = body
        self._folder = os.path.abspath(folder or os.getcwd())
        self._environ = _environment(os.environ if environ is None else environ)
        self._pending: list[int] = []
        self._main: Thread | None = None
        streams = (sys.stdout, sys.stderr) if on_output is None else tuple(_stream(on_output, fd) for fd in (1, 2))
        first = [list(argv), list(sys.path), *streams, sys.__excepthook__, threading.__excepthook__]
        created = [create() for variables in _ONCE_A_PROCESS.values() for create in variables.values()]
        self._values: list[Any] = [*first, *created]
        self._log_output: dict[str, Any] | None = None
        self._module = ModuleType("__main__")

    # The life of the program.

    def start(self) -> None:
        """Start the program: it runs after the threads that are ready now."""
        main = threading.Thread(name="MainThread", daemon=False)
        thread = self._main = self.scheduler.spawn(self._run, self, "MainThread")
        main._ident = main._native_id = thread.ident  # type: ignore[attr-defined]
        main._lockstep = thread  # type: ignore[attr-defined]
        main._started.set()  # type: ignore[attr-defined]
        threading._active[main.ident] = main  # type: ignore[attr-defined]
        self.main_thread = main

    def _run(self) -> None:
        try:
            status = _exit_status(self._body())
        except SystemExit as ended:
            status = _exit_status(ended.code)
        except KeyboardInterrupt:
            _report_error()
            status = -signal.SIGINT
        except Terminated as ended:
            status = -ended.number
        except Exception:
            _report_error()
            status = 1
        with contextlib.suppress(BaseException):
            self._wait_for_threads()
        self._end(status)

    def _wait_for_threads(self) -> None:
        """Wait for the threads that a process would wait for; pools of threads are only told to end there."""
        pools = sys.modules.get("concurrent.futures.thread")
        for thread in list(threading._active.values()):  # type: ignore[attr-defined]
            own = getattr(thread, "_lockstep", None) in self._others()
            if own and not thread.daemon and (pools is None or thread not in pools._threads_queues):
                thread.join()

    def _others(self) -> list[Thread]:
        threads = list(self.scheduler.threads.values())
        return [thread for thread in threads if thread.owner is self and thread is not self._main]

    def _end(self, status: int) -> None:
        """Leave the graph, end what still runs, and report the status."""
        if self.status is not None:
            return
        self.status = status
        for thread in self._others():
            self.scheduler.abandon(thread)
        for context in list(sys.modules["rclpy.signals"]._contexts) if "rclpy.signals" in sys.modules else ():
            with contextlib.suppress(Exception):
                context.try_shutdown()
        for stream in (sys.stdout, sys.stderr):
            with contextlib.suppress(Exception):
                stream.flush()
        threading._active.pop(self.main_thread.ident, None)  # type: ignore[attr-defined]
        for callback in self.on_exit:
            callback(status)

    def send_signal(self, number: int) -> None:
        """Send a signal to the program; its main thread handles it as soon as it runs or waits."""
        main = self._main
        if self.status is not None or main is None:
            return
        if number == getattr(signal, "SIGKILL", 9):
            self._kill(number)
        elif self.scheduler.current is main:
            self._handle(number)
        else:
            self._pending.append(number)
            self.scheduler.interrupt(main)

    def _kill(self, number: int) -> None:
        for thread in (*self._others(), self._main):
            if thread is not None:
                self.scheduler.abandon(thread)
        self.scheduler.spawn(lambda: self._end(-number), self, "end")

    def _handle(self, number: int) -> None:
        handler = self.handlers.get(number, signal.SIG_DFL)
        if callable(handler):
            handler(number, None)
        elif handler == signal.SIG_DFL:
            raise Terminated(number)

    # As an owner of threads.

    def on_resume(self, thread: Thread) -> None:
        """Handle the signals that came meanwhile, if it is the main thread."""
        if thread is self._main:
            while self._pending:
                self._handle(self._pending.pop(0))

    def enter(self) -> None:
        """Install the program's state."""
        values = self._values
        for number, variables, name in _places.loaded():
            variables[name] = values[number]
        os.environ._data = self._environ  # type: ignore[attr-defined]
        sys.modules["__main__"] = self._module
        if Program._present_folder != self._folder:
            _real_chdir(self._folder)
            Program._present_folder = self._folder
        self.randomness.install_numpy()
        self._swap_log_output(install=True)

    def leave(self) -> None:
        """Save the program's state."""
        values = self._values
        for number, variables, name in _places.loaded():
            values[number] = variables[name]
        self._module = sys.modules["__main__"]
        self._folder = Program._present_folder
        self._swap_log_output(install=False)

    def _swap_log_output(self, *, install: bool) -> None:
        module = sys.modules.get("rclpy.impl.log_output")
        if module is None:
            return
        if not install:
            self._log_output = module.OUTPUT.__dict__
            return
        if self._log_output is None:
            output = module.Output()
            output.to_file = False  # the same run would write the same names
            output.relative_sources = True  # bags must not depend on where this is installed
            self._log_output = output.__dict__
        module.OUTPUT.__dict__ = self._log_output


def change_folder(path: Any) -> None:
    """Change the working folder of the program that runs."""
    _real_chdir(path)
    Program._present_folder = os.getcwd()


def _environment(variables: Mapping[str, str]) -> dict[Any, Any]:
    """Return what `os.environ` keeps of an environment."""
    encode: Any = os.environ.encodekey
    value: Any = os.environ.encodevalue
    return {encode(name): value(text) for name, text in variables.items()}


def _stream(on_output: Callable[[int, bytes], object], fd: int) -> io.TextIOWrapper:
    raw = _Output(lambda data: on_output(fd, data))
    buffered = io.BufferedWriter(raw)
    return io.TextIOWrapper(buffered, encoding="utf-8", errors="backslashreplace", line_buffering=True)


def _report_error() -> None:
    """Pass the exception that is handled to the program's `sys.excepthook`, and report what that raises itself."""
    try:
        sys.excepthook(*sys.exc_info())
    except Exception:
        sys.stderr.write("Error in sys.excepthook:\n")
        traceback.print_exc()


def _exit_status(code: Any) -> int:
    if code is None or isinstance(code, int):
        return int(code or 0)
    sys.stderr.write(f"{code}\n")
    return 1
