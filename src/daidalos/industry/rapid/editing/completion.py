"""Names that can be written at a place."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from daidalos.industry.rapid import predefined, tree
from daidalos.industry.rapid.editing.workspace import Program
from daidalos.industry.rapid.lexing import KEYWORDS, tokenize
from daidalos.industry.rapid.parsing import parse
from daidalos.industry.rapid.sources import Source
from daidalos.industry.rapid.symbols import DataSymbol, RoutineSymbol, Symbol

_PREFIX = re.compile(r"\w*\Z")
_REFERENCE = re.compile(r"[^\W\d_]\w*(?:\.\w+|\{[^{}]*\})*\Z")


@dataclass(frozen=True)
class Completion:
    """A name that fits; `kind` is keyword, type, data, routine, component or parameter."""

    text: str
    kind: str
    detail: str = ""


def complete(program: Program, file: str, offset: int) -> list[Completion]:
    """Return what can be written at an offset, sorted by name.

    Behind a dot these are components, behind a backslash optional arguments, else all names and keywords.
    """
    text = program.modules[file].source.text
    before = _PREFIX.sub("", text[:offset])
    if before.endswith("."):
        found = list(_components(program, file, offset, before[:-1]))
    elif before.endswith("\\"):
        found = list(_optional_arguments(program, file, offset, before[:-1]))
    else:
        found = list(_names(program, file, offset))
    return sorted(found, key=lambda one: one.text.lower())


def _components(program: Program, file: str, offset: int, before: str) -> Iterator[Completion]:
    match = _REFERENCE.search(before)
    if match is None:
        return
    statements = parse(Source(file, f"x := {match[0]};")).tree.fragment
    if not statements or not isinstance(statements[0], tree.Assignment):
        return
    expressions = program.index(file).expressions_at(offset)
    type_ = expressions.type_of(statements[0].value)
    for name, component in (expressions.types.components(type_) or ()) if type_ is not None else ():
        yield Completion(name, "component", component)


def _optional_arguments(program: Program, file: str, offset: int, before: str) -> Iterator[Completion]:
    symbol = _called(program, file, offset, before)
    for group in (symbol.groups or ()) if symbol is not None else ():
        for one in group.alternatives:
            if group.is_optional and isinstance(one, tree.Parameter):
                yield Completion(one.name.text, "parameter", one.type.text)


def _called(program: Program, file: str, offset: int, before: str) -> RoutineSymbol | None:
    """Return the routine whose call is open at the end of a text."""
    start = max(before.rfind(";"), before.rfind("\n", 0, before.rfind("\n"))) + 1
    depth, name = 0, None
    tokens = tokenize(before[start:])[0]
    for index in range(len(tokens) - 1, -1, -1):
        token = tokens[index]
        depth += (token.type == "RPAR") - (token.type == "LPAR")
        if depth < 0:
            name = tokens[index - 1].text if index and tokens[index - 1].type == "IDENT" else None
            break
        starts = not index or tokens[index - 1].type not in ("COMMA", "CEQ", "BACKSLASH", "DOT", "LPAR", "LBRACE")
        if token.type == "IDENT" and depth == 0 and starts and not (index and tokens[index - 1].type == "IDENT"):
            symbol = _symbol(program, file, offset, token.text)
            if isinstance(symbol, RoutineSymbol):
                return symbol
    found = _symbol(program, file, offset, name) if name else None
    return found if isinstance(found, RoutineSymbol) else None


def _symbol(program: Program, file: str, offset: int, name: str) -> Symbol | None:
    owned = program.index(file).scope_at(offset).find(name.lower())
    return owned.symbol if owned is not None else predefined.find(name.lower())


def _names(program: Program, file: str, offset: int) -> Iterator[Completion]:
    seen: set[str] = set()
    scope = program.index(file).scope_at(offset)
    while scope is not None:
        for key, owned in scope.names.items():
            if key not in seen:
                seen.add(key)
                yield _completion(owned.symbol)
        if scope.parent is None:
            break
        scope = scope.parent
    for name in predefined.names():
        if name.lower() not in seen:
            yield Completion(
                name, _kind_of_line(predefined.signature(name.lower())), predefined.signature(name.lower())
            )
    for word in KEYWORDS:
        yield Completion(word, "keyword")


def _completion(symbol: Symbol) -> Completion:
    if isinstance(symbol, DataSymbol):
        return Completion(symbol.name, "data", f"{symbol.kind} {symbol.type}")
    if isinstance(symbol, RoutineSymbol):
        return Completion(symbol.name, "routine", f"{symbol.kind} {symbol.type or ''}".strip())
    return Completion(symbol.name, "type", symbol.kind)


def _kind_of_line(signature: str) -> str:
    word = signature.split(" ", 1)[0]
    return "routine" if word in ("PROC", "FUNC") else "data" if word in ("VAR", "PERS", "CONST") else "type"
