"""Files of RAPID: their encodings, the folders and the program files (.pgf) that list them."""

from __future__ import annotations

import os
import re
from bisect import bisect_right
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from functools import cached_property
from itertools import groupby
from pathlib import Path

from daidalos.common.errors import UserError

SUFFIXES = {".mod", ".sys", ".prg", ".modx", ".sysx"}
MAX_BYTES = 64 * 2**20
_TASK_FOLDER = re.compile(r"TASK\d+", re.IGNORECASE)


@dataclass(frozen=True)
class Source:
    """Text of a module.

    Attributes
    ----------
    file
        Path as the user wrote it.
    text
        The text, its line ends as they are in the file.
    encoding
        Encoding that the text was read with, and is to be written with.
    """

    file: str
    text: str
    encoding: str = "utf-8"

    @cached_property
    def _line_starts(self) -> list[int]:
        return [0, *(match.end() for match in re.finditer(r"\r\n|\n|\r", self.text))]

    def place(self, offset: int) -> tuple[int, int]:
        """Return line and column, both from 1, of an offset into the text."""
        line = bisect_right(self._line_starts, offset)
        return line, offset - self._line_starts[line - 1] + 1

    def offset(self, line: int, column: int) -> int:
        """Return the offset of a line and a column, both from 1, or the nearest that there is."""
        starts = self._line_starts
        start = starts[min(max(line, 1), len(starts)) - 1]
        return min(start + max(column, 1) - 1, len(self.text))


@dataclass(frozen=True)
class Program:
    """Modules that a task loads together, and so see each other's names."""

    name: str
    files: tuple[Path, ...] = field(default=())


def read_source(path: Path) -> Source:
    """Read a module.

    Modules of newer controllers are UTF-8, those of older ones Windows-1252; UTF-16 is known by its byte order mark.

    Raises
    ------
    UserError
        If the file cannot be read, is too large or is not text.
    """
    try:
        if path.stat().st_size > MAX_BYTES:
            raise UserError(f"{path}: has more than {MAX_BYTES >> 20} MiB")
        data = path.read_bytes()
    except OSError as error:
        raise UserError(f"{path}: {error.strerror or error}") from error
    text, encoding = decode(data)
    if "\0" in text:
        raise UserError(f"{path}: is not a text file, or is encrypted; RAPID modules are UTF-8 or Windows-1252")
    return Source(str(path), text, encoding)


def write_source(path: Path, text: str, encoding: str) -> None:
    """Write a module in one step: a program that reads it finds the old text or the new one.

    Raises
    ------
    UserError
        If the file cannot be written.
    """
    temporary = path.with_name(f".{path.name}.{os.getpid()}.tmp")
    try:
        temporary.write_bytes(text.encode(encoding))
        if path.exists():
            temporary.chmod(path.stat().st_mode)
        temporary.replace(path)
    except OSError as error:
        raise UserError(f"{path}: {error.strerror or error}") from error
    finally:
        temporary.unlink(missing_ok=True)


def decode(data: bytes) -> tuple[str, str]:
    """Return the text of a module and the name of its encoding."""
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        return data.decode("utf-16", "replace"), "utf-16"
    for encoding in ("utf-8-sig" if data.startswith(b"\xef\xbb\xbf") else "utf-8", "cp1252"):
        try:
            return data.decode(encoding), encoding
        except UnicodeDecodeError:
            continue
    return data.decode("latin-1"), "latin-1"


def find_programs(path: Path) -> list[Program]:
    """Return the programs at a path: a module, a program file, or a folder with any of them below it.

    In a folder, each program file is a program. Other modules belong together where they lie in the same folder, or
    below the same folder of a controller's backup, ``TASK1`` and so on.
    """
    if path.suffix.lower() == ".pgf":
        return [Program(str(path), tuple(read_program_file(path)))]
    if not path.is_dir():
        if not path.exists():
            raise UserError(f"{path}: No such file or directory")
        return [Program(str(path), (path,))]
    programs = [Program(str(file), tuple(read_program_file(file))) for file in _files(path, {".pgf"})]
    listed = {file.resolve() for program in programs for file in program.files}
    others = [file for file in _files(path, SUFFIXES) if file.resolve() not in listed]
    if not programs and not others:
        raise UserError(f"{path}: no module in it; their names end in {', '.join(sorted(SUFFIXES))}")
    for home, files in groupby(sorted(others, key=lambda file: (_home(file), file)), key=_home):
        programs.append(Program(str(home), tuple(files)))
    return programs


def modules_beside(file: Path) -> list[Path]:
    """Return the modules that one is loaded with: those in its folder, or below its task's folder in a backup."""
    home = _home(file)
    if not home.is_dir():
        return []
    found = _files(home, SUFFIXES) if _TASK_FOLDER.fullmatch(home.name) else home.iterdir()
    return sorted(path for path in found if path.suffix.lower() in SUFFIXES and path.is_file())


def _files(folder: Path, suffixes: Iterable[str]) -> Iterator[Path]:
    wanted = set(suffixes)
    yield from (path for path in sorted(folder.rglob("*")) if path.suffix.lower() in wanted and path.is_file())


def _home(file: Path) -> Path:
    for folder in file.parents:
        if _TASK_FOLDER.fullmatch(folder.name):
            return folder
    return file.parent


def read_program_file(path: Path) -> list[Path]:
    """Return the modules that a program file lists, relative to it; upper and lower case do not matter."""
    from daidalos.description.errors import DescriptionError
    from daidalos.description.markup import parse_markup

    try:
        root = parse_markup(path.read_bytes(), str(path))
    except OSError as error:
        raise UserError(f"{path}: {error.strerror or error}") from error
    except DescriptionError as error:
        raise UserError(str(error)) from error
    names = [(element.text or "").strip() for element in root.all("Module")]
    if root.tag != "Program" or not all(names):
        raise UserError(f"{path}: a program file is <Program> with one <Module>NAME.mod</Module> per module")
    present = {file.name.lower(): file for file in path.parent.iterdir()}
    return [present.get(name.lower(), path.parent / name) for name in names]
