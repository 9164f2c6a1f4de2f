"""Interpreter of the commands of a CMakeLists.txt that determine what is installed."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from daidalos.common.errors import Location
from daidalos.workspaces.cmake.conditions import is_true
from daidalos.workspaces.cmake.contents import Contents
from daidalos.workspaces.cmake.syntax import Block, Command, Node, parse
from daidalos.workspaces.cmake.values import expand, split
from daidalos.workspaces.errors import WorkspaceError

_MAX_ROUNDS = 10_000


@dataclass(frozen=True)
class Call:
    """Command being run: its name in lower case, its values and its location."""

    name: str
    values: list[str]
    where: Location


Handler = Callable[["Interpreter", Call], None]


class _Left(Exception):
    """Exit from a function, file or loop by ``return``, ``break`` or ``continue``."""


class Interpreter:
    """Interpreter of commands; installed files are collected in `contents`.

    Parameters
    ----------
    handlers
        The commands that have a meaning here, by name; others are noted and skipped.
    ignored
        Commands that mean nothing for what is installed.
    variables
        What is set at the start.
    folder
        Where the CMakeLists.txt is.
    """

    def __init__(
        self, handlers: Mapping[str, Handler], ignored: frozenset[str], variables: Mapping[str, str], folder: Path
    ) -> None:
        self.contents = Contents()
        self.folder = folder
        self.source = folder / "CMakeLists.txt"
        self._handlers = handlers
        self._ignored = ignored
        self._defined: dict[str, Block] = {}
        self._scopes: list[dict[str, str]] = [dict(variables)]

    @property
    def variables(self) -> dict[str, str]:
        """Variables of the current scope."""
        return self._scopes[-1]

    @property
    def parent_variables(self) -> dict[str, str]:
        """Variables of the caller of this function."""
        return self._scopes[-2] if len(self._scopes) > 1 else self._scopes[-1]

    def is_command(self, name: str) -> bool:
        """Return whether there is a command of this name."""
        name = name.lower()
        return name in self._handlers or name in self._ignored or name in self._defined

    def is_target(self, name: str) -> bool:
        """Return whether there is a target of this name."""
        return name in self.contents.targets

    def path(self, value: str) -> Path:
        """Return a path of the source folder as CMake understands it."""
        return self.folder / value

    def is_made_by_build(self, path: Path) -> bool:
        """Return whether a file is created only by a program of the build, which is not run here."""
        return not path.exists() and path.is_relative_to(self.variables["CMAKE_BINARY_DIR"])

    def run_file(self, path: Path) -> None:
        """Run the commands of a file.

        Raises
        ------
        WorkspaceError
            Naming the file and the line at fault.
        """
        try:
            text = path.read_text(encoding="utf-8-sig")
        except UnicodeDecodeError as error:
            raise WorkspaceError(f"byte {error.start} is not valid UTF-8", Location(str(path))) from None
        outer, self.source = self.source, path
        self.variables["CMAKE_CURRENT_LIST_DIR"] = str(path.parent)
        self.variables["CMAKE_CURRENT_LIST_FILE"] = str(path)
        try:
            self._run_until_return(parse(text, str(path)))
        finally:
            self.source = outer
            self.variables["CMAKE_CURRENT_LIST_DIR"] = str(outer.parent)
            self.variables["CMAKE_CURRENT_LIST_FILE"] = str(outer)

    def run_folder(self, folder: Path) -> None:
        """Run the CMakeLists.txt of a subfolder with its own variables; see `run_file`."""
        outer, self.folder = self.folder, folder
        self._scopes.append({**self.variables, "CMAKE_CURRENT_SOURCE_DIR": str(folder)})
        try:
            self.run_file(folder / "CMakeLists.txt")
        finally:
            self._scopes.pop()
            self.folder = outer

    def _run_until_return(self, nodes: Sequence[Node]) -> None:
        try:
            self._run(nodes)
        except _Left as left:
            if str(left) != "return":
                raise WorkspaceError(f"{left}() outside of a loop", Location(str(self.source))) from None

    def _run(self, nodes: Sequence[Node]) -> None:
        for node in nodes:
            if isinstance(node, Block):
                self._run_block(node)
            else:
                self._run_command(node)

    def _run_block(self, block: Block) -> None:
        head, body = block.branches[0]
        if block.kind == "if":
            for condition, branch in block.branches:
                if condition.name == "else" or self._is_true(condition):
                    self._run(branch)
                    return
        elif block.kind in ("function", "macro"):
            values = expand(head.arguments, self.variables)
            if not values:
                raise self._fault(head, f"{block.kind}() needs a name")
            self._defined[values[0].lower()] = block
        elif block.kind == "foreach":
            self._run_foreach(head, body)
        elif block.kind == "while":
            self._run_while(head, body)
        else:
            self._run(body)

    def _run_foreach(self, head: Command, body: Sequence[Node]) -> None:
        name, *values = expand(head.arguments, self.variables) or [""]
        if not name:
            raise self._fault(head, "foreach() needs a variable")
        before = self.variables.get(name)
        for item in self._items(head, values):
            self.variables[name] = item
            if self._leaves_loop(body):
                break
        if before is None:
            self.variables.pop(name, None)
        else:
            self.variables[name] = before

    def _items(self, head: Command, values: list[str]) -> list[str]:
        if values[:1] == ["RANGE"]:
            try:
                numbers = [int(value) for value in values[1:]]
            except ValueError:
                raise self._fault(head, "foreach(RANGE) needs whole numbers") from None
            start, stop = (0, numbers[0]) if len(numbers) == 1 else (numbers[0], numbers[1])
            step = numbers[2] if len(numbers) == 3 else 1
            return [str(number) for number in range(start, stop + 1, step)][:_MAX_ROUNDS]
        if values[:1] != ["IN"]:
            return values
        items: list[str] = []
        keyword = ""
        for value in values[1:]:
            if value in ("LISTS", "ITEMS"):
                keyword = value
            else:
                items += split(self.variables.get(value, "")) if keyword == "LISTS" else [value]
        return items

    def _run_while(self, head: Command, body: Sequence[Node]) -> None:
        for _ in range(_MAX_ROUNDS):
            if not self._is_true(head) or self._leaves_loop(body):
                return
        raise self._fault(head, f"while() did not end after {_MAX_ROUNDS} rounds")

    def _leaves_loop(self, body: Sequence[Node]) -> bool:
        try:
            self._run(body)
        except _Left as left:
            if str(left) == "return":
                raise
            return str(left) == "break"
        return False

    def _is_true(self, command: Command) -> bool:
        try:
            return is_true(command.arguments, self)
        except (ValueError, IndexError) as error:
            # What only a package's own CMake files would have set makes no mistake of the user's.
            if len(expand(command.arguments, self.variables)) < len(command.arguments):
                self.contents.notes.append(f"{self.source}:{command.line}: {error}; taken as false")
                return False
            raise self._fault(command, str(error)) from None

    def _run_command(self, command: Command) -> None:
        name = command.name
        if name in ("return", "break", "continue"):
            raise _Left(name)
        call = Call(name, expand(command.arguments, self.variables), Location(str(self.source), command.line))
        if name in self._defined:
            self._call_defined(self._defined[name], call)
        elif name in self._handlers:
            try:
                self._handlers[name](self, call)
            except WorkspaceError:
                raise
            except (IndexError, ValueError, re.error) as error:
                if len(call.values) >= len(command.arguments):
                    raise self._fault(command, f"{name}() cannot be run with these arguments: {error}") from None
                self.contents.notes.append(f"{call.where}: {name}() was left out: a variable is not set here")
        elif name not in self._ignored:
            self.contents.notes.append(f"{call.where}: {name}() is not understood and was left out")

    def _call_defined(self, block: Block, call: Call) -> None:
        head, body = block.branches[0]
        parameters = expand(head.arguments, self.variables)[1:]
        if len(call.values) < len(parameters):
            raise WorkspaceError(f"{call.name}() needs {len(parameters)} arguments", call.where)
        own = dict(zip(parameters, call.values, strict=False))
        own |= {"ARGC": str(len(call.values)), "ARGV": ";".join(call.values)}
        own["ARGN"] = ";".join(call.values[len(parameters) :])
        own |= {f"ARGV{index}": value for index, value in enumerate(call.values)}
        if block.kind == "function":
            self._scopes.append({**self.variables, **own})
            try:
                self._run_until_return(body)
            finally:
                self._scopes.pop()
            return
        before = {name: self.variables.get(name) for name in own}
        self.variables.update(own)
        self._run(body)
        for name, value in before.items():
            if value is None:
                self.variables.pop(name, None)
            else:
                self.variables[name] = value

    def _fault(self, command: Command, what: str) -> WorkspaceError:
        return WorkspaceError(what, Location(str(self.source), command.line))


def keywords(
    values: Sequence[str], options: Sequence[str] = (), single: Sequence[str] = (), many: Sequence[str] = ()
) -> tuple[dict[str, list[str]], list[str]]:
    """Sort values by the keywords before them, as in cmake_parse_arguments.

    Returns
    -------
    dict
        The values after each keyword that is there; none after an option.
    list
        The values that belong to no keyword.
    """
    found: dict[str, list[str]] = {}
    others: list[str] = []
    current: list[str] = others
    most = len(values)
    for value in values:
        if value in options:
            found[value] = []
            current, most = others, len(values)
        elif value in single or value in many:
            current = found.setdefault(value, [])
            most = len(current) + 1 if value in single else len(values)
        else:
            if len(current) >= most:
                current, most = others, len(values)
            current.append(value)
    return found, others
