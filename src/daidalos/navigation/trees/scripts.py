"""Script language of BehaviorTree.CPP 4: expressions and assignments over the blackboard, as ``n += 1; ok := n > 3``.

A name is an entry of the blackboard. There are numbers, texts in single quotes, ``true`` and ``false``, the operators
of C, and ``condition ? yes : no``. Statements are separated by semicolons; ``:=`` creates an entry, and ``=``, ``+=``,
``-=``, ``*=`` and ``/=`` change one that exists.
"""

from __future__ import annotations

import operator
from collections.abc import Callable
from functools import cache
from itertools import pairwise
from typing import Any

from daidalos.navigation.trees.blackboard import Blackboard
from daidalos.navigation.trees.errors import TreeError

_Value = Callable[[Blackboard], Any]

_GRAMMAR = r"""
start: _SEMICOLON* (statement (_SEMICOLON+ statement)* _SEMICOLON*)?
?statement: NAME ASSIGN choice -> assignment | choice
?choice: either "?" choice ":" choice -> choose | either
?either: both ("||" both)* -> any_of
?both: comparison ("&&" comparison)* -> all_of
?comparison: bits (COMPARE bits)* -> compared
?bits: sum (BITS sum)* -> calculated
?sum: product (SUM product)* -> calculated
?product: unary (PRODUCT unary)* -> calculated
?unary: "!" unary -> negation | SUM unary -> signed | "~" unary -> complement | primary
?primary: NUMBER -> number | TEXT -> text | BOOLEAN -> boolean | NAME -> name | "(" choice ")"
ASSIGN: /:=|[-+*\/]=|=(?!=)/
COMPARE: /==|!=|<=|>=|<|>/
BITS: /&(?!&)|\|(?!\|)|\^/
SUM: /[-+](?!=)/
PRODUCT: /[*\/](?!=)/
BOOLEAN.2: /(true|false)\b/
NUMBER: /0x[0-9a-f]+|(\d+\.?\d*|\.\d+)(e[-+]?\d+)?/i
TEXT: /'[^']*'/
NAME: /@?[a-z_]\w*/i
_SEMICOLON: ";"
%ignore /\s+/
"""
_COMPARISONS: dict[str, Callable[[Any, Any], bool]] = {
    "==": operator.eq,
    "!=": operator.ne,
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
}
_ARITHMETIC: dict[str, Callable[[Any, Any], Any]] = {
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "/": operator.truediv,
}
_BITWISE: dict[str, Callable[[int, int], int]] = {"&": operator.and_, "|": operator.or_, "^": operator.xor}


class Script:
    """Script bound to its place in a tree.

    Parameters
    ----------
    source : str
        Its text.
    where : str
        File, line and element, for errors.

    Raises
    ------
    TreeError
        It is not of the language.
    """

    def __init__(self, source: str, where: str) -> None:
        self._source = source
        self._where = where
        self._statements = _parse(source, where)

    def run(self, board: Blackboard) -> Any:
        """Execute the statements, and return the value of the last one; None where there is none.

        Raises
        ------
        TreeError
            A name is not on the blackboard, or an operator does not fit the values.
        """
        value: Any = None
        try:
            for statement in self._statements:
                value = statement(board)
        except LookupError as error:
            raise TreeError(f"{self._where}: script {self._source!r}: {error.args[0]}") from None
        except (TypeError, ValueError, ArithmeticError) as error:
            raise TreeError(f"{self._where}: script {self._source!r}: {error}") from None
        return value


def equal(one: Any, other: Any) -> bool:
    """Return whether two values are equal; a text that is a number equals that number."""
    one, other = _matched(one, other)
    return bool(one == other)


def _parse(source: str, where: str) -> list[_Value]:
    from lark import UnexpectedInput, UnexpectedToken

    try:
        tree = _parser().parse(source)
    except UnexpectedInput as error:
        is_at_end = isinstance(error, UnexpectedToken) and error.token.type == "$END"
        rest = "" if is_at_end else source[error.pos_in_stream or 0 :].strip()
        found = repr(rest) if rest else "the end"
        raise TreeError(f"{where}: script {source!r}: there is {found} where it cannot be") from None
    return [_compile(statement) for statement in tree.children]


@cache
def _parser() -> Any:
    from lark import Lark

    return Lark(_GRAMMAR, parser="lalr", maybe_placeholders=False)


def _compile(tree: Any) -> _Value:
    """Return the function that evaluates a node of the syntax tree."""
    if not tree.data.startswith(("number", "text", "boolean", "name")) and len(tree.children) == 1:
        operands = [_compile(tree.children[0])]
        if tree.data == "negation":
            return lambda board: not operands[0](board)
        if tree.data == "complement":
            return lambda board: ~_whole(operands[0](board))
        return operands[0]
    compiled: _Value = _COMPILERS[tree.data](tree.children)
    return compiled


def _number(children: list[Any]) -> _Value:
    text = str(children[0])
    value: float = int(text, 0) if text.isdecimal() or text[:2].lower() == "0x" else float(text)
    return lambda board: value


def _name(children: list[Any]) -> _Value:
    name = str(children[0]).removeprefix("@")

    def value(board: Blackboard) -> Any:
        if name not in board:
            raise LookupError(f"there is no entry {name!r} on the blackboard")
        found = board.get(name)
        return getattr(found, "number", found)

    return value


def _constant(value: Any) -> _Value:
    return lambda board: value


def _signed(children: list[Any]) -> _Value:
    operand = _compile(children[1])
    sign = -1 if children[0] == "-" else 1
    return lambda board: sign * _numeric(operand(board))


def _choose(children: list[Any]) -> _Value:
    condition, yes, no = (_compile(child) for child in children)
    return lambda board: yes(board) if condition(board) else no(board)


def _all_of(children: list[Any]) -> _Value:
    operands = [_compile(child) for child in children]
    return lambda board: all(operand(board) for operand in operands)


def _any_of(children: list[Any]) -> _Value:
    operands = [_compile(child) for child in children]
    return lambda board: any(operand(board) for operand in operands)


def _compared(children: list[Any]) -> _Value:
    operands = [_compile(child) for child in children[::2]]
    signs = [_COMPARISONS[str(sign)] for sign in children[1::2]]

    def value(board: Blackboard) -> bool:
        values = [operand(board) for operand in operands]
        pairs = zip(signs, pairwise(values), strict=True)
        return all(sign(*_matched(one, other)) for sign, (one, other) in pairs)

    return value


def _calculated(children: list[Any]) -> _Value:
    first = _compile(children[0])
    rest = [(str(sign), _compile(operand)) for sign, operand in zip(children[1::2], children[2::2], strict=True)]

    def value(board: Blackboard) -> Any:
        result = first(board)
        for sign, operand in rest:
            result = _calculate(sign, result, operand(board))
        return result

    return value


def _assignment(children: list[Any]) -> _Value:
    name, sign, expression = str(children[0]).removeprefix("@"), str(children[1]), _compile(children[2])

    def assign(board: Blackboard) -> Any:
        if sign != ":=" and name not in board:
            raise LookupError(f"there is no entry {name!r} on the blackboard that {sign} could change; := creates one")
        value = expression(board)
        if sign not in (":=", "="):
            value = _calculate(sign[0], board.get(name), value)
        board.set(name, value)
        return value

    return assign


_COMPILERS: dict[str, Callable[[list[Any]], _Value]] = {
    "number": _number,
    "text": lambda children: _constant(str(children[0])[1:-1]),
    "boolean": lambda children: _constant(children[0] == "true"),
    "name": _name,
    "signed": _signed,
    "choose": _choose,
    "all_of": _all_of,
    "any_of": _any_of,
    "compared": _compared,
    "calculated": _calculated,
    "assignment": _assignment,
}


def _calculate(sign: str, one: Any, other: Any) -> Any:
    if sign in _BITWISE:
        return _BITWISE[sign](_whole(one), _whole(other))
    one, other = _matched(one, other)
    if sign == "+" and isinstance(one, str) and isinstance(other, str):
        return one + other
    return _ARITHMETIC[sign](_numeric(one), _numeric(other))


def _matched(one: Any, other: Any) -> tuple[Any, Any]:
    """Return two values, a text as a number if the other one is a number."""
    one, other = getattr(one, "number", one), getattr(other, "number", other)
    if isinstance(one, str) and isinstance(other, int | float):
        return _from_text(one), other
    if isinstance(other, str) and isinstance(one, int | float):
        return one, _from_text(other)
    return one, other


def _from_text(text: str) -> Any:
    """Return a text as a number or Boolean, and unchanged where it is neither."""
    words = {"true": True, "false": False}
    try:
        return words[text.lower()] if text.lower() in words else float(text)
    except ValueError:
        return text


def _numeric(value: Any) -> float:
    number = _from_text(value) if isinstance(value, str) else value
    if not isinstance(number, int | float):
        raise TypeError(f"{value!r} is not a number")
    return number


def _whole(value: Any) -> int:
    number = _numeric(value)
    if number != int(number):
        raise TypeError(f"{value!r} is not a whole number")
    return int(number)
