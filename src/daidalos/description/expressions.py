"""Expressions of xacro files, evaluated where they can do no harm.

A description from the web may hold any expression. Python's own `eval` gives it a way to every object of the process
and as much time and memory as it wants, however few names it is given. Here the syntax tree is checked first: only the
kinds of nodes that compute something are taken, attributes are those on a list for each type, and whatever may take
long or become large (powers, products, repetitions, ranges, loops) goes through functions that count and measure.
"""

from __future__ import annotations

import ast
import math
import re
import string
from collections.abc import Callable, Iterable, Iterator
from functools import lru_cache
from types import CodeType
from typing import Any

MAX_STEPS = 2_000_000
"""Evaluations, elements and turns of loops in the expansion of one file; large robots take some 20,000."""
MAX_LENGTH = 100_000
"""Characters of a text, elements of a list."""
MAX_BITS = 10_000
"""Bits of an integer."""
MAX_EXPRESSION = 10_000
"""Characters of an expression."""
MAX_DEPTH = 50
"""Operations within each other in an expression."""
_MAX_COMBINATORIAL = 1_000

_NODES = (
    ast.Expression, ast.Constant, ast.Name, ast.Load, ast.Store, ast.Attribute, ast.Subscript, ast.Slice, ast.Call,
    ast.keyword, ast.Starred, ast.UnaryOp, ast.unaryop, ast.BinOp, ast.operator, ast.BoolOp, ast.boolop, ast.Compare,
    ast.cmpop, ast.IfExp, ast.List, ast.Tuple, ast.Dict, ast.Set, ast.Lambda, ast.arguments, ast.arg, ast.ListComp,
    ast.SetComp, ast.DictComp, ast.GeneratorExp, ast.comprehension, ast.JoinedStr, ast.FormattedValue,
)  # fmt: skip
_ATTRIBUTES: dict[type, frozenset[str]] = {
    str: frozenset(
        [
            "capitalize",
            "casefold",
            "count",
            "endswith",
            "find",
            "format",
            "index",
            "isalnum",
            "isalpha",
            "isascii",
            "isdecimal",
            "isdigit",
            "isidentifier",
            "islower",
            "isnumeric",
            "isspace",
            "istitle",
            "isupper",
            "join",
            "lower",
            "lstrip",
            "partition",
            "removeprefix",
            "removesuffix",
            "replace",
            "rfind",
            "rindex",
            "rpartition",
            "rsplit",
            "rstrip",
            "split",
            "splitlines",
            "startswith",
            "strip",
            "swapcase",
            "title",
            "upper",
            "zfill",
        ]
    ),
    list: frozenset(
        ["append", "clear", "copy", "count", "extend", "index", "insert", "pop", "remove", "reverse", "sort"]
    ),
    tuple: frozenset(("count", "index")),
    dict: frozenset(["clear", "copy", "get", "items", "keys", "pop", "setdefault", "update", "values"]),
    set: frozenset(
        ["add", "copy", "difference", "discard", "intersection", "issubset", "issuperset", "remove", "union", "update"]
    ),
    frozenset: frozenset(["copy", "difference", "intersection", "issubset", "issuperset", "union"]),
    int: frozenset(("bit_length", "imag", "real")),
    float: frozenset(("as_integer_ratio", "imag", "is_integer", "real")),
    complex: frozenset(("conjugate", "imag", "real")),
}
_PERCENT_WIDTH = re.compile(r"%[^a-zA-Z%]*(\d{4}|\*)")
_SPEC_WIDTH = re.compile(r"\d{4}")
_MAX_DIGITS = 400
"""Decimal places of `round`; a number has no more."""
_GUARDED_OPERATORS = {ast.Pow: "power", ast.Mult: "product", ast.LShift: "shift", ast.Add: "sum", ast.Mod: "remainder"}
_GUARD = "_guarded_"


class ExpressionError(Exception):
    """An expression that is refused: for its syntax, its size, or the attributes that it uses."""


class Evaluator:
    """Evaluator of expressions with one allowance of steps.

    Parameters
    ----------
    namespaces : tuple of types
        Mappings whose entries are their attributes.
    dotted : tuple of types
        Dictionaries whose entries are attributes beside a dictionary's methods.
    """

    def __init__(self, namespaces: tuple[type, ...] = (), dotted: tuple[type, ...] = ()) -> None:
        self._namespaces = namespaces
        self._dotted = dotted
        self._left = MAX_STEPS
        guards: dict[str, Callable[..., Any]] = {
            "attribute": self._attribute,
            "call": self._call,
            "iteration": self._iterate,
            "operand": self._operand,
            "power": self._power,
            "product": self._product,
            "shift": self._shift,
            "sum": self._sum,
            "remainder": _remainder,
            "format": _checked_spec,
        }
        self._guards = {f"{_GUARD}{name}": guard for name, guard in guards.items()}

    def evaluate(self, expression: str, symbols: Any) -> Any:
        """Return the value of an expression.

        Parameters
        ----------
        expression : str
        symbols : mapping
            The names that it may use.

        Raises
        ------
        ExpressionError
            When it is refused.
        SyntaxError
            When it is no expression.
        """
        code = _compiled(expression.strip())
        self.charge(1)
        return self.checked(eval(code, _Names(symbols, self._guards)))  # made of checked nodes only

    def charge(self, steps: int) -> None:
        """Take steps from the allowance.

        Raises
        ------
        ExpressionError
            When none are left.
        """
        self._left -= steps
        if self._left < 0:
            raise ExpressionError(f"the description takes more than {MAX_STEPS} steps to expand")

    def checked(self, value: Any) -> Any:
        """Return a value, after checking its size.

        Raises
        ------
        ExpressionError
            When it is too large.
        """
        if isinstance(value, int) and value.bit_length() > MAX_BITS:
            raise ExpressionError(f"an integer has more than {MAX_BITS} bits")
        if isinstance(value, str | list | tuple | dict | set | bytes) and len(value) > MAX_LENGTH:
            raise ExpressionError(f"a value has more than {MAX_LENGTH} elements")
        return value

    def functions(self) -> dict[str, Callable[..., Any]]:
        """Return replacements of Python's functions that could take long, or give access to more than values."""

        def bounded_range(*arguments: int) -> range:
            found = range(*arguments)
            if found and abs(found.stop - found.start) // abs(found.step) > MAX_LENGTH:
                raise ExpressionError(f"a range has more than {MAX_LENGTH} elements")
            return found

        def total(values: Iterable[Any], start: Any = 0) -> Any:
            for value in self._iterate(values):
                start = self._sum(start, value)
            return start

        def product(values: Iterable[Any], *, start: Any = 1) -> Any:
            for value in self._iterate(values):
                start = self._product(start, value)
            return start

        def rounded(value: Any, digits: int | None = None) -> Any:
            if digits is not None and abs(digits) > _MAX_DIGITS:
                raise ExpressionError(f"round takes up to {_MAX_DIGITS} digits")
            return round(value, digits)

        def combinatorial(function: Callable[..., int]) -> Callable[..., int]:
            def bounded(*arguments: int) -> int:
                if any(abs(argument) > _MAX_COMBINATORIAL for argument in arguments):
                    raise ExpressionError(f"{function.__name__} takes numbers up to {_MAX_COMBINATORIAL}")
                return function(*arguments)

            return bounded

        return {
            "range": bounded_range,
            "sum": total,
            "prod": product,
            "round": rounded,
            "map": lambda function, *values: map(function, *(self._iterate(each) for each in values)),
            "filter": lambda function, values: filter(function, self._iterate(values)),
            "type": _type_of,
            "factorial": combinatorial(math.factorial),
            "comb": combinatorial(math.comb),
            "perm": combinatorial(math.perm),
        }

    def _attribute(self, value: Any, name: str) -> Any:
        if isinstance(value, self._namespaces):
            entries: Any = value
            return entries[name]
        for kind, names in _ATTRIBUTES.items():
            if isinstance(value, kind) and name in names:
                return getattr(value, name)
        if isinstance(value, self._dotted):
            return getattr(value, name)
        raise ExpressionError(f"the attribute '{name}' of {type(value).__name__} is not for expressions")

    def _call(self, function: Any, *arguments: Any, **options: Any) -> Any:
        owner = getattr(function, "__self__", None)
        self.charge(1 + sum(_size(one) for one in (owner, *arguments)) // 10)
        if isinstance(owner, str):
            name = function.__name__
            if name == "format":
                return self.checked(_FORMATTER.vformat(owner, arguments, options))
            _check_text_method(owner, name, arguments)
        result = self.checked(function(*arguments, **options))
        self.checked(owner)  # which the method may have changed
        return result

    def _iterate(self, values: Iterable[Any]) -> Iterator[Any]:
        for value in values:
            self.charge(1)
            yield value

    def _operand(self, value: Any) -> Any:
        self.charge(_size(value) // 10)
        return value

    def _power(self, base: Any, exponent: Any) -> Any:
        if isinstance(base, int) and isinstance(exponent, int) and abs(base) > 1:
            _check_bits(base.bit_length() * exponent)
        return base**exponent

    def _product(self, left: Any, right: Any) -> Any:
        for value, count in ((left, right), (right, left)):
            if isinstance(count, int) and _size(value) * count > MAX_LENGTH:
                raise ExpressionError(f"a value has more than {MAX_LENGTH} elements")
        return self._operand(self.checked(left * right))

    def _shift(self, left: Any, right: Any) -> Any:
        if isinstance(right, int):
            _check_bits(right)
        return self.checked(left << right)

    def _sum(self, left: Any, right: Any) -> Any:
        return self._operand(self.checked(left + right))


class _Names(dict[str, Any]):
    """Names of an expression: the guards, which nothing replaces, then the symbols."""

    def __init__(self, symbols: Any, guards: dict[str, Any]) -> None:
        super().__init__(guards, __builtins__={})
        self._symbols = symbols

    def __missing__(self, name: str) -> Any:
        return self._symbols[name]


class _SafeFormatter(string.Formatter):
    """Formatter of texts that reaches arguments and their items, but no attributes."""

    def get_field(self, field_name: str, args: Any, kwargs: Any) -> Any:
        if "." in field_name or "__" in field_name:
            raise ExpressionError(f"the field '{field_name}' of a format reaches an attribute")
        return super().get_field(field_name, args, kwargs)

    def format_field(self, value: Any, format_spec: str) -> Any:
        return super().format_field(value, _checked_spec(format_spec))


_FORMATTER = _SafeFormatter()


def _checked_spec(spec: str) -> str:
    if _SPEC_WIDTH.search(spec):
        raise ExpressionError("a format has a width of more than 999 characters")
    return spec


def _remainder(left: Any, right: Any) -> Any:
    if isinstance(left, str | bytes) and _PERCENT_WIDTH.search(
        left if isinstance(left, str) else left.decode("latin-1")
    ):
        raise ExpressionError("a format has a width of more than 999 characters")
    return left % right


def _check_bits(bits: int) -> None:
    if bits > MAX_BITS:
        raise ExpressionError(f"an integer has more than {MAX_BITS} bits")


def _check_text_method(owner: str, name: str, arguments: tuple[Any, ...]) -> None:
    """Refuse a method of a text whose result would be too long."""
    length = 0
    if name == "zfill" and arguments and isinstance(arguments[0], int):
        length = arguments[0]
    elif name == "replace" and len(arguments) > 1:
        length = (len(owner) + 1) * _size(arguments[1]) // max(_size(arguments[0]), 1)
    elif name == "join" and arguments:
        length = len(owner) * _size(arguments[0])
    if length > MAX_LENGTH:
        raise ExpressionError(f"a value has more than {MAX_LENGTH} elements")


def _type_of(value: Any) -> type:
    """Return the type of a value; those of types and functions make classes and run code."""
    if not isinstance(value, (*_ATTRIBUTES, type(None))):
        raise ExpressionError("the type of what is no value is not for expressions")
    return type(value)


def _size(value: Any) -> int:
    return len(value) if isinstance(value, str | list | tuple | dict | set | frozenset | bytes | range) else 0


@lru_cache(maxsize=4096)
def _compiled(expression: str) -> CodeType:
    if len(expression) > MAX_EXPRESSION:
        raise ExpressionError(f"the expression has more than {MAX_EXPRESSION} characters")
    try:
        tree = ast.parse(expression, "<expression>", "eval")
        checked = _Guarding().visit(tree)
    except (RecursionError, MemoryError):
        raise ExpressionError("the expression is nested too deeply") from None
    return compile(ast.fix_missing_locations(checked), "<expression>", "eval")


class _Guarding(ast.NodeTransformer):
    """Replacement of what may do harm by calls of guards; refusal of everything unknown."""

    def __init__(self) -> None:
        self._depth = 0

    def visit(self, node: ast.AST) -> Any:
        """Check a node, and those within it."""
        if not isinstance(node, _NODES):
            raise ExpressionError(f"'{type(node).__name__}' is not for expressions")
        self._depth += 1
        if self._depth > MAX_DEPTH:
            raise ExpressionError("the expression is nested too deeply")
        try:
            return super().visit(node)
        finally:
            self._depth -= 1

    def visit_Constant(self, node: ast.Constant) -> ast.AST:
        """Check the size of a number."""
        if isinstance(node.value, int) and node.value.bit_length() > MAX_BITS:
            raise ExpressionError(f"an integer has more than {MAX_BITS} bits")
        return node

    def visit_Name(self, node: ast.Name) -> ast.AST:
        """Refuse the names that Python and this module keep for themselves."""
        _check_name(node.id)
        return node

    def visit_arg(self, node: ast.arg) -> ast.AST:
        """Refuse such names as arguments of a lambda."""
        _check_name(node.arg)
        return node

    def visit_Attribute(self, node: ast.Attribute) -> ast.AST:
        """Replace an attribute by a call that checks its name and the type of its owner."""
        if node.attr.startswith("_"):
            raise ExpressionError(f"the attribute '{node.attr}' is not for expressions")
        return _guarded("attribute", self.visit(node.value), ast.Constant(node.attr))

    def visit_Call(self, node: ast.Call) -> ast.AST:
        """Replace a call by one that counts."""
        self.generic_visit(node)
        return ast.Call(ast.Name(f"{_GUARD}call", ast.Load()), [node.func, *node.args], node.keywords)

    def visit_Compare(self, node: ast.Compare) -> ast.AST:
        """Count what a comparison looks at."""
        self.generic_visit(node)
        node.comparators = [_guarded("operand", each) for each in node.comparators]
        return node

    def visit_BinOp(self, node: ast.BinOp) -> ast.AST:
        """Replace an operation whose result may be large."""
        guard = _GUARDED_OPERATORS.get(type(node.op))
        self.generic_visit(node)
        return node if guard is None else _guarded(guard, node.left, node.right)

    def visit_comprehension(self, node: ast.comprehension) -> ast.AST:
        """Count the turns of a loop."""
        self.generic_visit(node)
        node.iter = _guarded("iteration", node.iter)
        return node

    def visit_FormattedValue(self, node: ast.FormattedValue) -> ast.AST:
        """Check a field's width."""
        self.generic_visit(node)
        if node.format_spec is not None:
            checked = ast.FormattedValue(_guarded("format", node.format_spec), -1)
            node.format_spec = ast.JoinedStr([checked])
        return node


def _check_name(name: str) -> None:
    if name.startswith(("__", _GUARD)):
        raise ExpressionError(f"the name '{name}' is not for expressions")


def _guarded(guard: str, *arguments: Any) -> ast.Call:
    return ast.Call(ast.Name(f"{_GUARD}{guard}", ast.Load()), list(arguments), [])
