"""The programs that an editor has open, with the modules beside them on disk."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from daidalos.common.errors import UserError
from daidalos.industry.rapid import predefined
from daidalos.industry.rapid.checking import Checker
from daidalos.industry.rapid.declarations import MAX_NAME
from daidalos.industry.rapid.editing.occurrences import Index, Target
from daidalos.industry.rapid.lexing import KEYWORDS
from daidalos.industry.rapid.parsing import Parsed, parse
from daidalos.industry.rapid.problems import Problem
from daidalos.industry.rapid.sources import Source, modules_beside, read_source

_NAME = re.compile(r"[^\W\d_]\w*")


class Workspace:
    """Modules by their paths; what an editor has changed comes before what is on disk."""

    def __init__(self) -> None:
        self._open: dict[str, Parsed] = {}
        self._on_disk: dict[str, tuple[float, Parsed]] = {}

    def update(self, file: str, text: str) -> None:
        """Take the text of a module that is open."""
        self._open[file] = parse(Source(file, text))

    def close(self, file: str) -> None:
        """Take a module from disk again."""
        self._open.pop(file, None)

    def open_files(self) -> list[str]:
        """Return the modules that are open."""
        return list(self._open)

    def program(self, file: str) -> Program:
        """Return the program that a module is part of: the modules beside it."""
        paths = [str(path) for path in modules_beside(Path(file))]
        modules = [parsed for path in dict.fromkeys([*paths, file]) if (parsed := self._read(path)) is not None]
        return Program(modules)

    def _read(self, file: str) -> Parsed | None:
        if file in self._open:
            return self._open[file]
        try:
            changed = Path(file).stat().st_mtime
            before = self._on_disk.get(file)
            if before is None or before[0] != changed:
                self._on_disk[file] = changed, parse(read_source(Path(file)))
        except (OSError, UserError):
            return None
        return self._on_disk[file][1]


class Program:
    """Modules that see each other's names, as an editor asks about them."""

    def __init__(self, modules: list[Parsed]) -> None:
        self.modules = {parsed.source.file: parsed for parsed in modules}
        self.checker = Checker(modules)
        self._indices: dict[str, Index] = {}

    def problems(self) -> dict[str, list[Problem]]:
        """Return all problems by file."""
        return self.checker.check()

    def index(self, file: str) -> Index:
        """Return the names of a module."""
        if file not in self._indices:
            self._indices[file] = Index(self.modules[file], self.checker)
        return self._indices[file]

    def definition(self, file: str, offset: int) -> Target | None:
        """Return the declaration of the name at an offset; None where it is predefined or not known."""
        found = self.index(file).at(offset)
        return found.target if found is not None and found.target.file else None

    def uses(self, target: Target) -> Iterator[tuple[str, int, int]]:
        """Yield file, start and end of each occurrence of a declared name, that in its declaration too."""
        for file in self.modules:
            for one in self.index(file).occurrences:
                if one.target == target:
                    yield file, one.name.start, one.name.end

    def hover(self, file: str, offset: int) -> str | None:
        """Return the declaration of the name at an offset as text, with the comment above it."""
        found = self.index(file).at(offset)
        if found is None:
            return None
        target = found.target
        if not target.file:
            return predefined.signature(target.text.lower()) or None
        source = self.modules[target.file].source
        lines = source.text.splitlines()
        line = source.place(target.start)[0] - 1
        first = line
        while first > 0 and lines[first - 1].lstrip().startswith("!"):
            first -= 1
        return "\n".join(one.strip() for one in lines[first : line + 1])

    def rename(self, file: str, offset: int, name: str) -> dict[str, list[tuple[int, int]]]:
        """Return the places, by file, that a new name has to be written to.

        Raises
        ------
        UserError
            If there is no name at the offset, it is predefined, or the new one cannot be used.
        """
        found = self.index(file).at(offset)
        if found is None:
            raise UserError("there is no name here that is declared")
        if not found.target.file:
            raise UserError(f"'{found.target.text}' is predefined and cannot be renamed")
        self._check_name(file, offset, found.target, name)
        places: dict[str, list[tuple[int, int]]] = {}
        for where, start, end in self.uses(found.target):
            places.setdefault(where, []).append((start, end))
        return {where: sorted(set(ranges)) for where, ranges in places.items()}

    def _check_name(self, file: str, offset: int, target: Target, name: str) -> None:
        if not _NAME.fullmatch(name) or len(name) > MAX_NAME:
            raise UserError(f"'{name}' is no name: a letter, then letters, digits and '_', {MAX_NAME} at most")
        if name.upper() in KEYWORDS:
            raise UserError(f"'{name}' is a keyword of RAPID and cannot be a name")
        if name.lower() == target.text.lower():
            return
        places = [(file, offset), *((where, start) for where, start, _ in self.uses(target))]
        for where, start in places:
            other = self.index(where).scope_at(start).find(name.lower())
            if other is not None:
                line = self.modules[other.file].source.place(other.name.start)[0]
                raise UserError(f"'{name}' is declared in {Path(other.file).name}:{line} already")
