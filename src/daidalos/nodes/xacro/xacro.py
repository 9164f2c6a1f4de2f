"""`xacro`: expands a robot description with macros; the original command, with the location of errors."""

from __future__ import annotations

import contextlib
import io
import sys

_IN_ORDER = ("--inorder", "-i")
"""Options of ROS 1, which ROS 2's command accepts with a warning that breaks launch files."""

_WAY = ("when ", "in file", "included from", "instantiated from")
_SHOWN = 8
_MAX_CPU_S = 60
_MAX_MEMORY = 4 << 30


def main() -> int:
    """Run the command in this process, whose time and memory it bounds."""
    _limit_resources()
    return run()


def run() -> int:
    """Run the command."""
    try:
        return _expand()
    except KeyboardInterrupt:
        print("xacro: interrupted", file=sys.stderr)
        return 130
    except (MemoryError, _OutOfTimeError):
        print("error: the description takes too much time or memory to expand", file=sys.stderr)
        return 2


class _OutOfTimeError(BaseException):
    """The end of the computing time; nothing within xacro handles it."""


def _limit_resources() -> None:
    """Bound the computing time and the memory, in case that a description gets around the limits of its expressions."""
    if sys.platform == "win32":
        return
    import resource
    import signal

    def end(*_: object) -> None:
        raise _OutOfTimeError

    signal.signal(signal.SIGXCPU, end)
    for kind, wanted in ((resource.RLIMIT_CPU, _MAX_CPU_S), (resource.RLIMIT_AS, _MAX_MEMORY)):
        soft, hard = resource.getrlimit(kind)
        limits = [limit for limit in (soft, hard, wanted) if limit != resource.RLIM_INFINITY]
        with contextlib.suppress(OSError, ValueError):  # not every system limits both
            resource.setrlimit(kind, (min(limits), hard))


def _expand() -> int:
    import xml.parsers.expat  # noqa: F401  (xacro uses it without importing it, when a file is missing)

    import xacro
    from xacro.cli import load_mappings

    from daidalos.description.xacro_limits import ReadableFiles, limited
    from daidalos.nodes.asset_folders import record_named_files

    sys.argv = ["xacro", *(word for word in sys.argv[1:] if word not in _IN_ORDER)]
    record_named_files(sys.argv[1:])
    said = io.StringIO()
    try:
        with contextlib.redirect_stderr(said), limited(xacro, ReadableFiles(load_mappings(sys.argv[1:]))):
            xacro.main()
    except SystemExit as end:
        words = said.getvalue()
        usage = "Usage:" in words
        print(words if usage or not end.code else _located(words), end="", file=sys.stderr)
        return 2 if end.code else 0
    print(said.getvalue(), end="", file=sys.stderr)
    return 0


def _located(said: str) -> str:
    """Return what xacro said of a mistake with the file and the line of it first, and the way that led there."""
    from xacro.cli import process_args

    from daidalos.description.errors import DescriptionError
    from daidalos.description.xacro import load_xacro
    from daidalos.nodes.packages import package_share

    options, file = process_args(sys.argv[1:])
    try:
        load_xacro(file, options.mappings, package_share)
    except DescriptionError as error:
        way = [line for line in said.splitlines() if line.startswith(_WAY) and line not in str(error)]
        more = [f"... and {len(way) - _SHOWN} more"] if len(way) > _SHOWN else []
        return "\n".join([f"error: {error}", *way[:_SHOWN], *more]) + "\n"
    return said  # such as an undefined M_PI, which other tools define
