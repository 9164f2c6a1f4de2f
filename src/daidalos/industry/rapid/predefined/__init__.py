"""Names that every controller knows: data types, data, instructions and functions.

They are declared in the text files beside this one, a line each in the notation of the language, and read when a
program uses them: a program uses few of some 1500.
"""

from __future__ import annotations

import functools
import re
from importlib.resources import files

from daidalos.industry.rapid.parsing import parse_parameters
from daidalos.industry.rapid.symbols import DataSymbol, RoutineSymbol, Symbol, Type, TypeSymbol

_DATA = re.compile(r"(?P<kind>VAR|PERS|CONST) (?P<type>\w+) (?P<name>\w+)(?: := (?P<value>.*))?")
_ROUTINE = re.compile(r"(?P<kind>PROC|FUNC)(?: (?P<type>\w+))? (?P<name>\w+)(?P<parameters>\(.*\))")
_TYPE = re.compile(r"(?P<kind>ATOMIC|OPAQUE|ALIAS|RECORD)(?: (?P<base>\w+))? (?P<name>\w+)(?P<components>\(.*\))?")
_NAME = re.compile(r"^(?:(?:PROC|ATOMIC|OPAQUE|RECORD)|(?:VAR|PERS|CONST|FUNC|ALIAS) \w+) (\w+)")


@functools.cache
def _lines() -> dict[str, str]:
    lines: dict[str, str] = {}
    for file in ("types", "data", "instructions", "functions"):
        text = files(__package__ or "").joinpath(f"{file}.txt").read_text(encoding="utf-8")
        for line in text.splitlines():
            match = _NAME.match(line)
            if match:
                lines.setdefault(match[1].lower(), line)
                if file == "types":
                    lines[f"type {match[1].lower()}"] = line
    return lines


@functools.cache
def find(key: str) -> Symbol | None:
    """Return what a name, lower case, stands for on every controller; None where it is not predefined."""
    line = _lines().get(key)
    if line is None:
        return None
    if match := _DATA.fullmatch(line):
        return DataSymbol(match["name"], match["kind"], Type(match["type"].lower()), value=match["value"] or "")  # type: ignore[arg-type]
    if match := _ROUTINE.fullmatch(line):
        is_known = match["parameters"] != "(...)"
        groups = parse_parameters(match["parameters"]) if is_known else None
        type_ = Type(match["type"].lower()) if match["type"] else None
        return RoutineSymbol(match["name"], match["kind"], groups, type_, signature=line)  # type: ignore[arg-type]
    return _type(line)


@functools.cache
def find_type(key: str) -> TypeSymbol | None:
    """Return a predefined data type; a name may be that of data or a routine too."""
    line = _lines().get(f"type {key}")
    return _type(line) if line else None


def _type(line: str) -> TypeSymbol:
    match = _TYPE.fullmatch(line)
    assert match is not None, line
    name = match["name"]
    if match["kind"] == "ALIAS":
        return TypeSymbol(name, "alias", match["base"].lower())
    if match["kind"] != "RECORD":
        return TypeSymbol(name, "atomic" if match["kind"] == "ATOMIC" else "opaque")
    components = None
    if match["components"] != "(...)":
        pairs = (part.split() for part in match["components"][1:-1].split(","))
        components = [(component.lower(), type_.lower()) for type_, component in pairs]
    return TypeSymbol(name, "record", components=components)


@functools.cache
def names() -> frozenset[str]:
    """Return all predefined names as they are spelled."""
    return frozenset(match[1] for line in _lines().values() if (match := _NAME.match(line)))


def signature(key: str) -> str:
    """Return the declaration of a predefined name, empty where there is none."""
    return _lines().get(key, "")
