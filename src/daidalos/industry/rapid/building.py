"""Actions of the grammar: what each rule makes of the parts that it has found.

Each method is called with the parts of its rule in the grammar, tokens as `Lexeme`, and returns a node of `tree`.
"""

from __future__ import annotations

from typing import Any

from lark import Transformer

from daidalos.industry.rapid import tree
from daidalos.industry.rapid.lexing import Lexeme
from daidalos.industry.rapid.tree import Name

Parts = list[Any]


def _name(token: Lexeme | tree.Placeholder) -> Name:
    text = token.text
    return Name(text, token.start)


class TreeBuilder(Transformer[Lexeme, Any]):
    """Builds the tree while the parser runs, without a tree of rules in between."""

    # Lists and parts of others

    def none_yet(self, parts: Parts) -> list[Any]:
        """Return an empty list."""
        return []

    def nothing(self, parts: Parts) -> None:
        """Return None for what is left out."""

    def first(self, parts: Parts) -> list[Any]:
        """Return a list with its first element."""
        return [parts[-1]]

    def next(self, parts: Parts) -> list[Any]:
        """Append the element behind a separator."""
        elements: list[Any] = parts[0]
        elements.append(parts[-1])
        return elements

    one_more = next

    def itself(self, parts: Parts) -> Any:
        """Return the only part."""
        return parts[0]

    def inner(self, parts: Parts) -> Any:
        """Return what stands between two brackets."""
        return parts[1]

    second = inner

    # Files

    def file(self, parts: Parts) -> tree.Tree:
        """Build a file of modules."""
        return tree.Tree(modules=parts[0])

    def fragment(self, parts: Parts) -> tree.Tree:
        """Build statements outside of a module."""
        return tree.Tree(fragment=parts[0])

    def module(self, parts: Parts) -> tree.Module:
        """Build a module."""
        start, name, attributes, items, end = parts
        return tree.Module(start.start, _name(name), [one.text.upper() for one in attributes], items, end.end)

    # Declarations

    def data(self, parts: Parts) -> tree.Data:
        """Build a declaration of data."""
        scope, kind, type_, name, dimensions, value, end = parts
        start = (scope or kind).start
        return tree.Data(start, _upper(scope), kind.text.upper(), _name(type_), _name(name), dimensions, value, end.end)

    def alias(self, parts: Parts) -> tree.Alias:
        """Build an alias."""
        scope, word, type_, name, end = parts
        return tree.Alias((scope or word).start, _upper(scope), _name(type_), _name(name), end.end)

    def record(self, parts: Parts) -> tree.Record:
        """Build a record."""
        scope, word, name, components, end = parts
        return tree.Record((scope or word).start, _upper(scope), _name(name), components, end.end)

    def record_component(self, parts: Parts) -> tree.RecordComponent:
        """Build a component of a record."""
        return tree.RecordComponent(_name(parts[0]), _name(parts[1]))

    def procedure(self, parts: Parts) -> tree.Routine:
        """Build a procedure."""
        scope, word, name, groups, body, handlers, end = parts
        return _routine(scope, word, None, name, groups, body, handlers, end)

    def function(self, parts: Parts) -> tree.Routine:
        """Build a function."""
        scope, word, type_, name, groups, body, handlers, end = parts
        return _routine(scope, word, _name(type_), name, groups, body, handlers, end)

    def trap(self, parts: Parts) -> tree.Routine:
        """Build a trap."""
        scope, word, name, body, handlers, end = parts
        return _routine(scope, word, None, name, [], body, handlers, end)

    def required_group(self, parts: Parts) -> tree.ParameterGroup:
        """Build a required parameter."""
        return tree.ParameterGroup(False, parts)

    def optional_group(self, parts: Parts) -> tree.ParameterGroup:
        """Build optional parameters that exclude each other."""
        return tree.ParameterGroup(True, parts[1])

    def parameter(self, parts: Parts) -> tree.Parameter:
        """Build a parameter."""
        mode, type_, name, stars = parts
        return tree.Parameter(_upper(mode), _name(type_), _name(name), len(stars))

    def backward_handler(self, parts: Parts) -> tree.Handler:
        """Build a handler for execution backwards."""
        return tree.Handler(parts[0].start, "BACKWARD", [], parts[1])

    def undo_handler(self, parts: Parts) -> tree.Handler:
        """Build a handler for a program pointer that leaves the routine."""
        return tree.Handler(parts[0].start, "UNDO", [], parts[1])

    def error_handler(self, parts: Parts) -> tree.Handler:
        """Build an error handler."""
        return tree.Handler(parts[0].start, "ERROR", parts[1], parts[2])

    # Statements

    def assignment(self, parts: Parts) -> tree.Assignment:
        """Build an assignment."""
        return tree.Assignment(parts[0], parts[2], parts[3].end)

    def call_statement(self, parts: Parts) -> tree.CallStatement:
        """Build a call of a procedure."""
        return tree.CallStatement(_name(parts[0]), parts[1], parts[2].end)

    def late_call(self, parts: Parts) -> tree.LateCall:
        """Build a call of a procedure by a string."""
        return tree.LateCall(parts[0].start, parts[1], parts[3], parts[4].end)

    def label(self, parts: Parts) -> tree.Label:
        """Build a label."""
        return tree.Label(_name(parts[0]), parts[1].end)

    def goto_statement(self, parts: Parts) -> tree.Goto:
        """Build a jump."""
        return tree.Goto(parts[0].start, _name(parts[1]), parts[2].end)

    def return_statement(self, parts: Parts) -> tree.Return:
        """Build a return."""
        return tree.Return(parts[0].start, parts[1] if len(parts) > 2 else None, parts[-1].end)

    def raise_statement(self, parts: Parts) -> tree.Raise:
        """Build the raising of an error."""
        return tree.Raise(parts[0].start, parts[1] if len(parts) > 2 else None, parts[-1].end)

    def retry_statement(self, parts: Parts) -> tree.Retry:
        """Build a retry."""
        return tree.Retry(parts[0].start, parts[1].end)

    def trynext_statement(self, parts: Parts) -> tree.TryNext:
        """Build a continuation behind the statement that failed."""
        return tree.TryNext(parts[0].start, parts[1].end)

    def exit_statement(self, parts: Parts) -> tree.Exit:
        """Build the end of execution."""
        return tree.Exit(parts[0].start, parts[1].end)

    def connect_statement(self, parts: Parts) -> tree.Connect:
        """Build the connection of an interrupt."""
        return tree.Connect(parts[0].start, parts[1], _name(parts[3]), parts[4].end)

    def if_statement(self, parts: Parts) -> tree.If:
        """Build an IF with its branches."""
        word, condition, _, body, branches, otherwise, end = parts
        return tree.If(word.start, [tree.Branch(word.start, condition, body), *branches], otherwise, end.end)

    def branch(self, parts: Parts) -> tree.Branch:
        """Build an ELSEIF."""
        return tree.Branch(parts[0].start, parts[1], parts[3])

    def compact_if(self, parts: Parts) -> tree.If:
        """Build an IF of one statement."""
        word, condition, statement = parts
        return tree.If(word.start, [tree.Branch(word.start, condition, [statement])], None, statement.end, True)

    def for_statement(self, parts: Parts) -> tree.For:
        """Build a counted loop."""
        word, name, _, first, _, last, step, _, body, end = parts
        return tree.For(word.start, _name(name), first, last, step, body, end.end)

    def while_statement(self, parts: Parts) -> tree.While:
        """Build a loop."""
        return tree.While(parts[0].start, parts[1], parts[3], parts[4].end)

    def test_statement(self, parts: Parts) -> tree.Test:
        """Build a choice by a value."""
        return tree.Test(parts[0].start, parts[1], parts[2], parts[3].end)

    def case(self, parts: Parts) -> tree.Case:
        """Build a case."""
        return tree.Case(parts[0].start, parts[1], parts[3])

    def default_case(self, parts: Parts) -> tree.Case:
        """Build the case of all other values."""
        return tree.Case(parts[0].start, None, parts[2])

    # Arguments

    def positional_argument(self, parts: Parts) -> tree.Argument:
        """Build a required argument by its place."""
        value = parts[0]
        return tree.Argument(value.start, None, value)

    def named_argument(self, parts: Parts) -> tree.Argument:
        """Build a required argument by its name."""
        return tree.Argument(parts[0].start, _name(parts[0]), parts[2])

    def switch_argument(self, parts: Parts) -> tree.Argument:
        """Build a switch."""
        return tree.Argument(parts[0].start, _name(parts[1]), None, True)

    def optional_value(self, parts: Parts) -> tree.Argument:
        """Build an optional argument."""
        return tree.Argument(parts[0].start, _name(parts[1]), parts[3], True)

    def conditional_argument(self, parts: Parts) -> tree.Argument:
        """Build an argument that is handed on where it is present."""
        return tree.Argument(parts[0].start, _name(parts[1]), parts[3], True, True)

    # Expressions

    def binary(self, parts: Parts) -> tree.Binary:
        """Build an expression with an operator between two."""
        left, operator, right = parts
        return tree.Binary(operator.text.upper(), left, right, operator.start)

    def binary_not(self, parts: Parts) -> tree.Binary:
        """Build a comparison with a negated value."""
        left, operator, word, right = parts
        return tree.Binary(operator.text, left, tree.Unary(word.start, "NOT", right), operator.start)

    def unary(self, parts: Parts) -> tree.Unary:
        """Build an expression with an operator before it."""
        return tree.Unary(parts[0].start, parts[0].text.upper(), parts[1])

    def number(self, parts: Parts) -> tree.Number:
        """Build a number."""
        return tree.Number(parts[0].start, parts[0].text)

    def string(self, parts: Parts) -> tree.String:
        """Build a string."""
        return tree.String(parts[0].start, parts[0].text)

    def boolean(self, parts: Parts) -> tree.Boolean:
        """Build a truth value."""
        return tree.Boolean(parts[0].start, parts[0].type == "TRUE")

    def literals(self, parts: Parts) -> tree.Literals:
        """Build an aggregate of literals."""
        return tree.Literals(parts[0].start, parts[0].text)

    def aggregate(self, parts: Parts) -> tree.Aggregate:
        """Build a record or an array."""
        return tree.Aggregate(parts[0].start, parts[1])

    def empty_aggregate(self, parts: Parts) -> tree.Aggregate:
        """Build an empty aggregate."""
        return tree.Aggregate(parts[0].start, [])

    def call(self, parts: Parts) -> tree.Call:
        """Build the call of a function."""
        return tree.Call(_name(parts[0]), parts[2], parts[3].end)

    def variable(self, parts: Parts) -> tree.Variable:
        """Build data by its name."""
        token = parts[0]
        return tree.Variable(Name(token.text, token.start))

    def component(self, parts: Parts) -> tree.Component:
        """Build a component of a record."""
        return tree.Component(parts[0], _name(parts[2]))

    def index(self, parts: Parts) -> tree.Index:
        """Build an element of an array."""
        return tree.Index(parts[0], parts[2])

    def placeholder(self, parts: Parts) -> tree.Placeholder:
        """Build a placeholder."""
        return tree.Placeholder(parts[0].start, parts[0].text)


def _upper(token: Lexeme | None) -> str:
    return token.text.upper() if token is not None else ""


def _routine(
    scope: Lexeme | None,
    word: Lexeme,
    type_: Name | None,
    name: Lexeme,
    groups: list[tree.ParameterGroup],
    body: list[tree.Statement],
    handlers: list[tree.Handler],
    end: Lexeme,
) -> tree.Routine:
    start = (scope or word).start
    kind = word.text.upper()
    return tree.Routine(start, _upper(scope), kind, type_, _name(name), groups, body, handlers, end.end)
