"""Program that runs a Python script of a user's package: ``python run_script.py SCRIPT ARGUMENT...``.

The script runs as it would by itself; an exception that it does not catch is reported by the lines of the user's own
code instead of a traceback through Python, setuptools and rclpy.
"""

from __future__ import annotations

import contextlib
import os
import sys
from types import ModuleType, TracebackType

TYPE_CHECKING = False
if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

_NAME_LENGTH = 15
"""Characters of a process's name in Linux."""


def main() -> None:
    """Run the script that the first argument names."""
    del sys.argv[0]
    path = sys.argv[0]
    sys.path[0] = os.path.dirname(os.path.realpath(path))
    with contextlib.suppress(OSError), open("/proc/self/comm", "w") as name:  # what `killall` looks for
        name.write(os.path.basename(path)[:_NAME_LENGTH])
    run(path)


def run(path: str) -> None:
    """Run a script as ``__main__``, and report from now on what nobody catches by the lines of the user's code."""
    from daidalos.common import tracebacks

    def show(kind: type[BaseException], error: BaseException, trace: TracebackType | None) -> None:
        if issubclass(kind, KeyboardInterrupt):
            return  # Ctrl-C while modules are imported; the process ends by the signal
        problem = "" if tracebacks.own_frames(error) else _fault_of_entry_point(path, error)
        if problem:
            sys.stderr.write(f"{problem}\n")
        else:
            tracebacks.show(kind, error, trace)

    sys.excepthook = show
    program = ModuleType("__main__")
    program.__file__ = path
    sys.modules["__main__"] = program
    with open(path, "rb") as file:
        code = compile(file.read(), path, "exec", dont_inherit=True)
    exec(code, program.__dict__)


def _fault_of_entry_point(path: str, error: BaseException) -> str:
    """Return what is wrong with the entry point behind a script that setuptools wrote; empty where it is right."""
    entry = _entry_point(path)
    if entry is None:
        return ""
    where = f"setup.py: the entry point '{entry.name} = {entry.value}'"
    if not entry.attr:
        return f"{where} names no function; write '{entry.name} = {entry.value}:main'"
    module = sys.modules.get(entry.module)
    if isinstance(error, AttributeError) and module is not None:
        return f"{where}: {error}{_hint(entry.attr, dir(module))}"
    if isinstance(error, ModuleNotFoundError) and f"{entry.module}.".startswith(f"{error.name}."):
        return f"{where}: {error}{_hint(entry.module, _modules_beside(entry.module))}"
    return ""


def _entry_point(path: str) -> EntryPoint | None:
    """Return the entry point that a script's second line names; None for a script of another form."""
    import re
    from importlib.metadata import PackageNotFoundError, distribution

    with open(path, encoding="utf-8", errors="replace") as file:
        found = re.search(
            r"^# EASY-INSTALL-ENTRY-SCRIPT: '([^'=]+)=[^']*','(\w+)','([^']+)'", file.read(), re.MULTILINE
        )
    if found is None:
        return None
    name, group, script = found.groups()
    try:
        entries = distribution(name).entry_points
    except PackageNotFoundError:
        return None
    return next((one for one in entries if (one.group, one.name) == (group, script)), None)


def _modules_beside(module: str) -> list[str]:
    """Return the modules of a module's package."""
    from importlib.util import find_spec
    from pkgutil import iter_modules

    package = module.partition(".")[0]
    spec = find_spec(package)
    return [f"{package}.{one.name}" for one in iter_modules(spec.submodule_search_locations)] if spec else []


def _hint(name: str, known: list[str]) -> str:
    from daidalos.common.suggestions import near

    found = near(name, known)
    return f"; did you mean {' or '.join(repr(one) for one in found)}?" if found else ""


if __name__ == "__main__":
    main()
