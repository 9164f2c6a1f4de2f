"""Types of expressions, and whether they fit where they stand."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

from daidalos.industry.rapid import predefined, tree
from daidalos.industry.rapid.arguments import bind
from daidalos.industry.rapid.lexing import number_value, string_value
from daidalos.industry.rapid.reporting import Reporter
from daidalos.industry.rapid.symbols import DataSymbol, RoutineSymbol, Scope, Symbol, Type, TypeSymbol
from daidalos.industry.rapid.types import BOOL, CONFIGURED, LITERAL, NUM, NUMBERS, STRING, SWITCH, TypeTable

MAX_STRING = 80
_RELATIONS = {"<", "<=", ">", ">="}
_LOGIC = {"AND", "OR", "XOR"}
_VECTORS = {("pos", "pos"): "pos", ("orient", "orient"): "orient"}


class ExpressionChecker:
    """Checks the expressions of a module.

    Parameters
    ----------
    types
        All data types.
    report
        Gathers what is wrong.
    configured
        Names that are used as signals, mechanical units and so on, which the configuration declares; added to.
    undeclared
        Called with each name that is not declared, and the names that are.
    """

    def __init__(
        self,
        types: TypeTable,
        report: Reporter,
        configured: set[str],
        undeclared: Callable[[tree.Name, Scope, str], None],
    ) -> None:
        self.types = types
        self._report = report
        self._configured = configured
        self._undeclared = undeclared
        self.scope = Scope()
        self._forms: dict[Any, list[tuple[tree.Parameter, int]]] = {}

    def symbol(self, key: str) -> Symbol | None:
        """Return what a name stands for."""
        owned = self.scope.find(key)
        return owned.symbol if owned is not None else predefined.find(key)

    def note_undeclared(self, name: tree.Name, what: str) -> None:
        """Record a name that is not declared; `what` it should be, such as ``function ``."""
        self._undeclared(name, self.scope, what)

    # What is expected somewhere

    def check(self, node: tree.Expression, expected: Type | None, sizes: list[int | None] | None = None) -> None:
        """Check an expression, and that it is of a type, where that is known."""
        if expected is not None and self._check_aggregate(node, expected, sizes or []):
            return
        is_configured = expected is not None and expected.name in CONFIGURED
        if is_configured and isinstance(node, tree.Variable) and self.symbol(node.name.key) is None:
            self._configured.add(node.name.key)
            return
        found = self.type_of(node)
        if found is not None and expected is not None and not self._fits(found, expected):
            self._report.error(node.start, f"{expected} is expected here, not {_named(found)}", _width(node))

    def _fits(self, found: Type, expected: Type) -> bool:
        if self.types.fits(found, expected):
            return True
        unknown = [one for one in (found, expected) if self.types.find(self.types.base(one).name) is None]
        return any(one.name not in ("any", "number", "literal") for one in unknown)

    def _check_aggregate(self, node: tree.Expression, expected: Type, sizes: list[int | None]) -> bool:
        """Check an aggregate part by part, and return whether the expression is one."""
        if isinstance(node, tree.Literals):
            error = self.types.literal_error(node.text, expected, sizes)
            if error:
                self._report.error(node.start, error, len(node.text.splitlines()[0]))
            return True
        if not isinstance(node, tree.Aggregate):
            return False
        items = node.items
        if expected.dimensions:
            if sizes and sizes[0] is not None and len(items) != sizes[0]:
                self._report.error(node.start, f"{len(items)} elements for an array of {sizes[0]}")
            for item in items:
                self.check(item, Type(expected.name, expected.dimensions - 1), sizes[1:])
            return True
        components = self.types.components(expected)
        if components is None:
            if not self.types.is_open(expected) and expected.name != "any":
                self._report.error(node.start, f"{expected} is expected here, not a list in brackets")
            for item in items:
                self.check(item, None)
        elif len(components) != len(items):
            names = ", ".join(name for name, _ in components)
            self._report.error(node.start, f"{len(items)} values for a record of {len(components)}: {names}")
        else:
            for item, (_, type_) in zip(items, components, strict=True):
                self.check(item, Type(type_))
        return True

    # What an expression is

    def type_of(self, node: tree.Expression) -> Type | None:
        """Check an expression and return its type; None where it is not known."""
        match node:
            case tree.Number():
                if number_value(node.text) == math.inf:
                    self._report.error(node.start, "this number is too large", len(node.text))
                return LITERAL
            case tree.String():
                if len(string_value(node.text)) > MAX_STRING:
                    self._report.error(node.start, f"a string has at most {MAX_STRING} characters", len(node.text))
                return STRING
            case tree.Boolean():
                return BOOL
            case tree.Variable():
                return self._variable(node)
            case tree.Component():
                return self._component(node)
            case tree.Index():
                return self._index(node)
            case tree.Call():
                return self._call(node)
            case tree.Unary():
                return self._unary(node)
            case tree.Binary():
                return self._binary(node)
            case tree.Placeholder():
                self._report.error(node.start, f"{node.text} is still to be replaced by an expression", len(node.text))
            case tree.Aggregate():
                for item in node.items:
                    self.check(item, None)
        return None

    def _variable(self, node: tree.Variable) -> Type | None:
        symbol = self.symbol(node.name.key)
        if symbol is None:
            self._undeclared(node.name, self.scope, "")
            return None
        if isinstance(symbol, DataSymbol):
            return symbol.type
        if isinstance(symbol, TypeSymbol):
            self._report.error(node.start, f"'{node.name.text}' is a data type, not data", _width(node))
        elif symbol.kind == "FUNC":
            self._report.error(node.start, f"'{node.name.text}' is a function; its call needs ()", _width(node))
        else:
            self._report.error(node.start, f"'{node.name.text}' is a routine without a value", _width(node))
        return None

    def _component(self, node: tree.Component) -> Type | None:
        of = self.type_of(node.of)
        if of is None or self.types.is_open(of):
            return None
        components = self.types.components(of)
        if components is None:
            self._report.error(node.name.start, f"{_named(of)} has no components", len(node.name.text))
            return None
        type_ = dict(components).get(node.name.key)
        if type_ is None:
            hint = self._report.hint(node.name.text, [name for name, _ in components])
            known = hint or f"; it has: {', '.join(name for name, _ in components)}"
            self._report.error(node.name.start, f"{of} has no component '{node.name.text}'{known}", len(node.name.text))
            return None
        return Type(type_)

    def _index(self, node: tree.Index) -> Type | None:
        of = self.type_of(node.of)
        for index in node.indices:
            self.check(index, NUM)
        if of is None:
            return None
        if of.dimensions != len(node.indices):
            what = f"an array of {of.dimensions} dimensions" if of.dimensions else f"{_named(of)}, which is no array"
            self._report.error(node.indices[0].start, f"{len(node.indices)} indices for {what}")
            return None
        return Type(of.name)

    def _unary(self, node: tree.Unary) -> Type | None:
        if isinstance(node.operand, tree.Aggregate | tree.Literals):
            self._report.error(node.start, f"'{node.operator}' does not take a list in brackets", len(node.operator))
        found = self.type_of(node.operand)
        if found is None:
            return BOOL if node.operator == "NOT" else None
        value = self.types.as_value(found)
        if node.operator == "NOT":
            if value != BOOL:
                self._report.error(node.start, f"NOT needs bool, not {_named(found)}", 3)
            return BOOL
        if value.name not in (*NUMBERS, "pos") or value.dimensions:
            self._report.error(node.start, f"'{node.operator}' needs a number, not {_named(found)}")
            return None
        return value

    def _binary(self, node: tree.Binary) -> Type | None:
        sides = [one for one in (node.left, node.right) if not isinstance(one, tree.Aggregate | tree.Literals)]
        types = [self.type_of(one) for one in sides]
        if not sides:
            message = f"'{node.operator}' does not take two lists in brackets, whose type is not known"
            self._report.error(node.at, message, len(node.operator))
        if len(sides) == 1:
            other = node.right if sides[0] is node.left else node.left
            self.check(other, types[0])
            types = [types[0], types[0]]
        if len(types) != 2 or types[0] is None or types[1] is None:
            return BOOL if node.operator in ("=", "<>", *_RELATIONS, *_LOGIC) else None
        left, right = self.types.as_value(types[0]), self.types.as_value(types[1])
        result = self._operate(node.operator, left, right)
        if result is None:
            message = f"'{node.operator}' does not take {_named(types[0])} and {_named(types[1])}"
            self._report.error(node.at, message, len(node.operator))
            return BOOL if node.operator in ("=", "<>", *_RELATIONS, *_LOGIC) else None
        return result

    def _operate(self, operator: str, left: Type, right: Type) -> Type | None:
        """Return the type of a result; None where the operator does not take such operands."""
        if left.dimensions or right.dimensions:
            return BOOL if operator in ("=", "<>") and self._fits(left, right) else None
        if operator in _LOGIC:
            return BOOL if left == right == BOOL else None
        number = _common_number(left, right)
        if operator in ("=", "<>"):
            return BOOL if number or self._fits(left, right) or self._fits(right, left) else None
        if operator in _RELATIONS:
            return BOOL if number else None
        if number:
            return number
        names = (left.name, right.name)
        if operator == "+" and names == ("string", "string"):
            return STRING
        if operator in "+-" and names == ("pos", "pos"):
            return left
        if operator == "*" and names in _VECTORS:
            return left
        if operator in "*/" and left.name == "pos" and right.name in NUMBERS:
            return left
        return right if operator == "*" and right.name == "pos" and left.name in NUMBERS else None

    # Calls

    def _call(self, node: tree.Call) -> Type | None:
        symbol = self.symbol(node.name.key)
        if symbol is None:
            self._undeclared(node.name, self.scope, "function ")
        elif not isinstance(symbol, RoutineSymbol):
            self._report.error(node.start, f"'{node.name.text}' is no function", len(node.name.text))
        elif symbol.kind != "FUNC":
            self._report.error(node.start, f"'{node.name.text}' is a procedure and has no value", len(node.name.text))
        else:
            self.check_arguments(node.name, symbol, node.arguments)
            return self._result(symbol, node.arguments)
        self.check_values(node.arguments)
        return None

    def _result(self, symbol: RoutineSymbol, arguments: Sequence[tree.Argument]) -> Type | None:
        if symbol.type is None or symbol.type.name != "number":
            return symbol.type
        quiet = [
            self._quiet_type(one.value) for one in arguments if not isinstance(one, tree.Placeholder) and one.value
        ]
        numbers = [self.types.as_value(one) for one in quiet if one is not None]
        return next((one for one in numbers if one.name in ("num", "dnum")), LITERAL)

    def _quiet_type(self, node: tree.Expression) -> Type | None:
        """Return the type of what was checked before."""
        problems = list(self._report.problems)
        try:
            return self.type_of(node)
        finally:
            self._report.problems[:] = problems

    def check_values(self, arguments: Sequence[tree.Argument | tree.Placeholder]) -> None:
        """Check the values of arguments whose parameters are not known."""
        for argument in arguments:
            if not isinstance(argument, tree.Placeholder) and argument.value is not None:
                self.check(argument.value, None)

    def check_arguments(
        self, name: tree.Name, symbol: RoutineSymbol, arguments: Sequence[tree.Argument | tree.Placeholder]
    ) -> None:
        """Check the arguments of a call against the parameters of the routine."""
        for placeholder in (one for one in arguments if isinstance(one, tree.Placeholder)):
            text = placeholder.text
            self._report.error(placeholder.start, f"{text} is still to be replaced by an argument", len(text))
        if symbol.groups is None:
            for argument in arguments:
                value = argument.value if isinstance(argument, tree.Argument) else None
                # What is expected is not known: a name that is not declared may be one of the configuration.
                if value is not None and not (isinstance(value, tree.Variable) and not self.symbol(value.name.key)):
                    self.check(value, None)
            return
        for parameter, argument in self._bind(name, symbol, arguments):
            self._check_argument(symbol, parameter, argument)

    def _bind(
        self, name: tree.Name, symbol: RoutineSymbol, arguments: Sequence[tree.Argument | tree.Placeholder]
    ) -> list[tuple[tree.Parameter, tree.Argument]]:
        """Put arguments to parameters, and report what does not fit; calls of the same form are put alike."""
        form = (id(symbol), tuple(_form(one) for one in arguments))
        known = self._forms.get(form)
        if known is not None:
            return [(parameter, arguments[index]) for parameter, index in known]  # type: ignore[misc]
        binding = bind(symbol.groups or [], arguments)
        if binding.missing and (left_out := self.zone_left_out(symbol, arguments)):
            binding = bind(symbol.groups or [], arguments, left_out)
            self._report.warning(
                name.start, f"{symbol.name} has no zone; 'fine' is taken, so write: ..., fine, tool", len(name.text)
            )
        elif not binding.missing and not binding.errors:
            places = {id(argument): index for index, argument in enumerate(arguments)}
            self._forms[form] = [(parameter, places[id(argument)]) for parameter, argument in binding.given]
        for argument, message in binding.errors:
            self._report.error(argument.start, f"{symbol.name}: {message}", _argument_width(argument))
        if binding.missing:
            names = " and ".join(f"'{one.name.text}' ({one.type.text})" for one in binding.missing)
            verb = "is" if len(binding.missing) == 1 else "are"
            self._report.error(name.start, f"{symbol.name}: {names} {verb} missing", len(name.text))
        bound = {id(argument) for _, argument in binding.given}
        self.check_values([one for one in arguments if id(one) not in bound])
        return binding.given

    def zone_left_out(self, symbol: RoutineSymbol, arguments: Sequence[object]) -> list[tree.Parameter]:
        """Return the zone of a movement that its call lacks, where only that is missing; else nothing."""
        groups = symbol.groups or []
        required = [group.alternatives[0] for group in groups if not group.is_optional]
        given = [one for one in arguments if isinstance(one, tree.Argument) and not one.is_optional]
        zones = [one for one in required if isinstance(one, tree.Parameter) and one.type.key == "zonedata"]
        if len(given) != len(required) - 1 or len(zones) != 1 or symbol.node is not None:
            return []
        in_its_place = given[required.index(zones[0])].value if required.index(zones[0]) < len(given) else None
        if in_its_place is None or isinstance(in_its_place, tree.Literals | tree.Aggregate):
            return []
        type_ = self._quiet_type(in_its_place)
        return zones if type_ is not None and self.types.base(type_).name == "tooldata" else []

    def _note_unknown(self, node: tree.Variable) -> None:
        """Take an undeclared name that may be a signal, since what is expected is not known."""
        if self.symbol(node.name.key) is None:
            self._configured.add(node.name.key)
        else:
            self.type_of(node)

    def _check_argument(self, symbol: RoutineSymbol, parameter: tree.Parameter, argument: tree.Argument) -> None:
        value = argument.value
        if value is None:
            return
        expected = Type(parameter.type.key, parameter.dimensions)
        if argument.is_conditional:
            found = self.type_of(value)
            if found is not None and found != SWITCH and not self._fits(found, expected):
                self._report.error(value.start, f"{expected} is expected here, not {_named(found)}", _width(value))
            return
        if expected.name == "any" and isinstance(value, tree.Variable) and parameter.name.key in _SIGNAL_PARAMETERS:
            self._note_unknown(value)
            return
        if parameter.mode:
            self._check_reference(symbol, parameter, value)
        self.check(value, expected)

    def _check_reference(self, symbol: RoutineSymbol, parameter: tree.Parameter, value: tree.Expression) -> None:
        """Check that an argument is data that the routine may change."""
        what = f"{symbol.name}: '{parameter.name.text}'"
        root = root_of(value)
        if root is None:
            if not isinstance(value, tree.Placeholder):
                self._report.error(value.start, f"{what} needs {_MODES[parameter.mode]}, not a value", _width(value))
            return
        data = self.symbol(root.name.key)
        if not isinstance(data, DataSymbol) or data.type.name in CONFIGURED:
            return
        if data.kind not in _FITTING[parameter.mode]:
            kind = {"CONST": "a constant", "loop": "a loop counter", "VAR": "a variable"}.get(data.kind, "a parameter")
            self._report.error(
                value.start, f"{what} needs {_MODES[parameter.mode]}; '{data.name}' is {kind}", _width(value)
            )


_MODES = {"VAR": "a variable", "PERS": "a persistent", "INOUT": "a variable or a persistent"}
_FITTING = {
    "VAR": {"VAR", "INOUT", "value"},
    "PERS": {"PERS", "INOUT"},
    "INOUT": {"VAR", "PERS", "INOUT", "value"},
}
_SIGNAL_PARAMETERS = {"signal", "fromsignal", "tosignal", "optpar", "parameter"}


def root_of(node: tree.Expression) -> tree.Variable | None:
    """Return the data that a reference begins with; None where an expression is no reference."""
    while isinstance(node, tree.Component | tree.Index):
        node = node.of
    return node if isinstance(node, tree.Variable) else None


def _common_number(left: Type, right: Type) -> Type | None:
    """Return the type of a number from two; None where they are not both num, or both dnum."""
    if left.name not in NUMBERS or right.name not in NUMBERS:
        return None
    names = {left.name, right.name} - {"literal", "number"}
    return None if len(names) > 1 else Type(names.pop()) if names else LITERAL


def _named(type_: Type) -> str:
    return "a number" if type_.name == "literal" else str(type_)


def _width(node: tree.Expression) -> int:
    if isinstance(node, tree.Variable):
        return len(node.name.text)
    return len(node.text.splitlines()[0]) if isinstance(node, tree.String | tree.Number | tree.Literals) else 1


def _form(argument: tree.Argument | tree.Placeholder) -> object:
    """Return what decides which parameter an argument is for."""
    if isinstance(argument, tree.Placeholder):
        return argument.text
    key = argument.name.key if argument.name else None
    return (key, argument.value is None, argument.is_optional, argument.is_conditional) if key else True


def _argument_width(argument: tree.Argument) -> int:
    return len(argument.name.text) + argument.is_optional if argument.name else 1
