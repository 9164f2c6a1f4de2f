"""Lines of the text files in which trajectories, logs and pose graphs are exchanged."""

import gzip
import zlib
from collections.abc import Iterable
from decimal import Decimal
from pathlib import Path

from daidalos.mapping.errors import LineError


def read_lines(path: Path, error: type[LineError]) -> list[tuple[int, str]]:
    """Return the lines of a file, which may be a ``.gz``, that are neither empty nor comments, numbered from 1.

    Raises
    ------
    LineError
        Of the kind `error`, when the file cannot be read or is no text.
    """
    try:
        content = gzip.decompress(path.read_bytes()) if path.suffix.lower() == ".gz" else path.read_bytes()
        lines = content.decode("ascii").splitlines()
    except (OSError, EOFError, zlib.error) as problem:
        raise error(path, None, getattr(problem, "strerror", None) or str(problem)) from problem
    except UnicodeDecodeError as problem:
        raise error(path, None, "not a text file") from problem
    return [
        (number, line) for number, line in enumerate(lines, 1) if line.strip() and not line.lstrip().startswith("#")
    ]


def write_lines(path: Path, lines: Iterable[str], error: type[LineError]) -> None:
    """Write lines, each of which ends with a newline.

    Raises
    ------
    LineError
        Of the kind `error`, when the file cannot be written.
    """
    try:
        path.write_text("".join(lines), encoding="ascii")
    except OSError as problem:
        raise error(path, None, problem.strerror or str(problem)) from problem


def nanoseconds(seconds: str) -> int:
    """Convert decimal seconds to nanoseconds; a float cannot hold the time since 1970 that finely.

    Raises
    ------
    ValueError
        When they are no decimal number.
    """
    try:
        return int(Decimal(seconds).scaleb(9))
    except ArithmeticError:
        raise ValueError(f"expected decimal seconds, found '{seconds}'") from None


def seconds_text(stamp_ns: int) -> str:
    """Return nanoseconds as decimal seconds."""
    sign = "-" if stamp_ns < 0 else ""
    return f"{sign}{abs(stamp_ns) // 10**9}.{abs(stamp_ns) % 10**9:09d}"


def format_suffix(path: Path) -> str:
    """Return the suffix that names a file's format, without the ``.gz`` of a compressed one."""
    return Path(path.stem if path.suffix.lower() == ".gz" else path.name).suffix.lower()
