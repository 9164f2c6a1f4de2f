"""Data types: what they are made of, and which values fit."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

from daidalos.industry.rapid.literals import parse_literals
from daidalos.industry.rapid.symbols import Type, TypeSymbol

NUM, DNUM, STRING, BOOL, LITERAL, SWITCH = (
    Type(name) for name in ("num", "dnum", "string", "bool", "literal", "switch")
)
NUMBERS = ("num", "dnum", "literal", "number")
CONFIGURED = {
    "signalai", "signalao", "signaldi", "signaldo", "signalgi", "signalgo", "mecunit", "taskid", "cameradev", "sensor",
}  # fmt: skip
"""Types of data that the controller's configuration declares."""

MAX_ALIASES = 32
_BARE = str.maketrans("", "", "0123456789+-.eE \t\r\n")

Lookup = Callable[[str], TypeSymbol | None]


class TypeTable:
    """Data types by their names.

    Parameters
    ----------
    lookup
        Returns the type of a name, lower case.
    """

    def __init__(self, lookup: Lookup) -> None:
        self._lookup = functools.cache(lookup)
        self._bases: dict[str, str] = {}
        self._forms: dict[str, str | None] = {}

    def find(self, name: str) -> TypeSymbol | None:
        """Return the symbol of a type."""
        return self._lookup(name)

    def base(self, type_: Type) -> Type:
        """Return what a type is in the end, behind aliases."""
        name = self._bases.get(type_.name)
        if name is None:
            name = self._bases[type_.name] = self._find_base(type_.name)
        return Type(name, type_.dimensions) if name != type_.name else type_

    def _find_base(self, name: str) -> str:
        for _ in range(MAX_ALIASES):
            symbol = self._lookup(name)
            if symbol is None or symbol.kind != "alias":
                break
            name = symbol.base
        return name

    def as_value(self, type_: Type) -> Type:
        """Return the type of a value that data stands for: signals stand for the number that they have."""
        base = self.base(type_)
        if not base.dimensions and base.name.startswith("signal"):
            return NUM
        return base

    def fits(self, found: Type, expected: Type) -> bool:
        """Return whether data of one type can be used where another is expected."""
        if expected.name == "any":
            return True
        found, expected = self.base(found), self.base(expected)
        if found.dimensions != expected.dimensions:
            return False
        if found == expected or found.name == "any":
            return True
        if expected.name in ("num", "dnum", "number"):
            names = ("num", "dnum", "literal", "number") if expected.name == "number" else (expected.name, "literal")
            return self.as_value(found).name in names
        return found.name == "number" and expected.name == "literal"

    def components(self, type_: Type) -> list[tuple[str, str]] | None:
        """Return the components of a record; None for all else, and where they are not known."""
        symbol = self._lookup(self.base(type_).name)
        return symbol.components if symbol is not None and not type_.dimensions else None

    def is_open(self, type_: Type) -> bool:
        """Return whether what a type is made of is not known."""
        symbol = self._lookup(self.base(type_).name)
        return symbol is None or (symbol.kind == "record" and symbol.components is None)

    def literal_error(self, text: str, expected: Type, sizes: list[int | None] | None = None) -> str | None:
        """Return why an aggregate of literals has not the form of a type; None where it has."""
        if not expected.dimensions and self._form(expected) == text.translate(_BARE):
            return None
        return self._value_error(parse_literals(text), expected, sizes or [])

    def _form(self, type_: Type) -> str | None:
        """Return the brackets and commas of a record of numbers only; None of any other type."""
        if type_.name not in self._forms:
            self._forms[type_.name] = None  # a record that has itself as a component has no form
            base = self.base(type_)
            parts = [self._form(Type(one)) for _, one in self.components(base) or ()]
            known = [part for part in parts if part is not None]
            if base.name in ("num", "dnum"):
                self._forms[type_.name] = ""
            elif parts and len(known) == len(parts):
                self._forms[type_.name] = f"[{','.join(known)}]"
        return self._forms[type_.name]

    def _value_error(self, value: Any, expected: Type, sizes: list[int | None]) -> str | None:
        if expected.name == "any" or self.is_open(expected):
            return None
        if expected.dimensions:
            if not isinstance(value, list):
                return f"an array in brackets is expected where {_shown(value)} stands"
            if sizes and sizes[0] is not None and len(value) != sizes[0]:
                return f"{len(value)} elements for an array of {sizes[0]}"
            element = Type(expected.name, expected.dimensions - 1)
            return next((e for one in value if (e := self._value_error(one, element, sizes[1:]))), None)
        components = self.components(expected)
        if components is not None:
            if not isinstance(value, list):
                return f"{_article(expected)} in brackets is expected where {_shown(value)} stands"
            if len(value) != len(components):
                return f"{len(value)} values for {_article(expected)}, which has {len(components)}: {_list(components)}"
            for (name, type_), one in zip(components, value, strict=True):
                error = self._value_error(one, Type(type_), [])
                if error:
                    return f"{error} (component {name} of {expected})"
            return None
        base = self.base(expected).name
        if isinstance(value, list):
            return f"{_article(expected)} is expected, not a list in brackets"
        kinds = {"bool": bool, "string": str, "num": float, "dnum": float, "number": float}
        kind = kinds.get(base)
        if kind is None or type(value) is kind:
            return None
        return f"{_article(expected)} is expected where {_shown(value)} stands"


def _list(components: list[tuple[str, str]]) -> str:
    return ", ".join(name for name, _ in components)


def _article(type_: Type) -> str:
    return f"{'an' if str(type_)[0] in 'aeio' else 'a'} {type_}"


def _shown(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).upper()
    if isinstance(value, float):
        return f"{value:g}"
    return f'"{value}"' if isinstance(value, str) else "a list in brackets"
