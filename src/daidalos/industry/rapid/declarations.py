"""Check of declarations: data, their types, sizes and values, records and aliases."""

from __future__ import annotations

import math

from daidalos.industry.rapid import predefined, tree
from daidalos.industry.rapid.expressions import ExpressionChecker
from daidalos.industry.rapid.lexing import number_value
from daidalos.industry.rapid.reporting import Reporter
from daidalos.industry.rapid.symbols import Type
from daidalos.industry.rapid.types import CONFIGURED, NUM

MAX_NAME = 32
MAX_DIMENSIONS = 3
MAX_ELEMENTS = 1_000_000
"""Elements of an array; a controller's memory holds fewer."""


class DeclarationChecker:
    """Checks the declarations of a module."""

    def __init__(self, expressions: ExpressionChecker, report: Reporter) -> None:
        self._expressions = expressions
        self._report = report

    def check(self, node: tree.Data | tree.Alias | tree.Record) -> None:
        """Check a declaration of a module."""
        self.check_length(node.name)
        if isinstance(node, tree.Data):
            self.check_data(node)
        elif isinstance(node, tree.Alias):
            self.check_type(node.type)
        else:
            self._check_record(node)

    def check_data(self, node: tree.Data) -> None:
        """Check data, in a module or in a routine."""
        self.check_type(node.type)
        if len(node.dimensions) > MAX_DIMENSIONS:
            self._report.error(
                node.dimensions[MAX_DIMENSIONS].start, f"an array has at most {MAX_DIMENSIONS} dimensions"
            )
        sizes = [self._size(one) for one in node.dimensions]
        if math.prod(size for size in sizes if size is not None) > MAX_ELEMENTS:
            self._report.error(node.dimensions[0].start, f"an array has at most {MAX_ELEMENTS} elements")
        if node.value is None:
            if node.kind == "CONST":
                self._report.error(
                    node.name.start, f"the constant '{node.name.text}' has no value", len(node.name.text)
                )
            return
        symbol = self._expressions.types.find(self._expressions.types.base(Type(node.type.key)).name)
        if symbol is not None and symbol.kind == "opaque" and node.type.key not in CONFIGURED:
            self._report.error(node.value.start, f"data of type {node.type.text} cannot have a value")
            return
        self._expressions.check(node.value, Type(node.type.key, len(node.dimensions)), sizes)

    def _size(self, node: tree.Expression) -> int | None:
        """Return the size of a dimension; None where it is not a plain number."""
        if isinstance(node, tree.Placeholder):
            return None
        self._expressions.check(node, NUM)
        if not isinstance(node, tree.Number):
            return None
        size = number_value(node.text)
        if size < 1 or (size != math.inf and size % 1):
            self._report.error(node.start, f"an array has 1 element or more, not {node.text}", len(node.text))
            return None
        return int(min(size, MAX_ELEMENTS + 1))

    def _check_record(self, node: tree.Record) -> None:
        seen: set[str] = set()
        for component in node.components:
            self.check_length(component.name)
            self.check_type(component.type)
            text = component.name.text
            if component.name.key in seen:
                self._report.error(component.name.start, f"the record has a component '{text}' already", len(text))
            if component.type.key == node.name.key:
                self._report.error(component.type.start, "a record cannot have itself as a component", len(text))
            seen.add(component.name.key)

    def check_type(self, name: tree.Name) -> None:
        """Check that a name is a data type."""
        if self._expressions.types.find(name.key) is not None:
            return
        width = len(name.text)
        if self._expressions.symbol(name.key) is not None:
            self._report.error(name.start, f"'{name.text}' is no data type", width)
            return
        scope = self._expressions.scope
        known = {one for one in scope.visible() if self._expressions.types.find(one.lower())}
        known |= {one for one in predefined.names() if predefined.find_type(one.lower())}
        self._report.error(
            name.start, f"there is no data type '{name.text}'{self._report.hint(name.text, known)}", width
        )

    def check_length(self, name: tree.Name) -> None:
        """Check the length of a name."""
        if len(name.text) > MAX_NAME:
            text = f"a name has at most {MAX_NAME} characters; '{name.text}' has {len(name.text)}"
            self._report.error(name.start, text, len(name.text))
        if name.text.startswith("<"):
            self._report.error(name.start, f"{name.text} is still to be replaced by a name", len(name.text))
