"""Check of routines: parameters, statements, labels, handlers and the flow of control."""

from __future__ import annotations

from collections.abc import Sequence

from daidalos.industry.rapid import flow, tree
from daidalos.industry.rapid.declarations import DeclarationChecker
from daidalos.industry.rapid.expressions import ExpressionChecker, root_of
from daidalos.industry.rapid.listings import broken_lines
from daidalos.industry.rapid.reporting import Reporter
from daidalos.industry.rapid.symbols import (
    DataSymbol,
    Owned,
    RoutineSymbol,
    Scope,
    Type,
    symbol_of_data,
    symbol_of_parameter,
)
from daidalos.industry.rapid.types import BOOL, NUM, STRING

_FIXED = {"CONST": "a constant", "loop": "the counter of a loop"}


class RoutineChecker:
    """Checks the routines of a module."""

    def __init__(self, expressions: ExpressionChecker, declarations: DeclarationChecker, report: Reporter) -> None:
        self._expressions = expressions
        self._declarations = declarations
        self._report = report
        self._routine: tree.Routine | None = None
        self._handler = ""
        self._labels: list[set[str]] = []

    def check(self, node: tree.Routine, module: Scope) -> None:
        """Check a routine."""
        self._routine = node
        self._declarations.check_length(node.name)
        scope = Scope(module)
        self._expressions.scope = scope
        if node.type is not None:
            self._declarations.check_type(node.type)
        for group in node.groups:
            for parameter in group.alternatives:
                self._declare_parameter(parameter, group.is_optional, scope)
        self._check_listing(node.body)
        self._check_body(node.body)
        for handler in node.handlers:
            self._handler = handler.kind
            for number in handler.numbers:
                self._expressions.check(number, NUM)
            self._check_body(handler.body)
        self._handler = ""
        self._check_flow(node)

    def check_fragment(self, body: Sequence[tree.Statement]) -> None:
        """Check statements that stand in no module."""
        self._check_listing(body)
        self._check_body(body)

    def _declare_parameter(self, parameter: tree.Parameter | tree.Placeholder, is_optional: bool, scope: Scope) -> None:
        if isinstance(parameter, tree.Placeholder):
            text = parameter.text
            self._report.error(parameter.start, f"{text} is still to be replaced by a parameter", len(text))
            return
        self._declarations.check_type(parameter.type)
        if parameter.type.key == "switch" and not is_optional:
            self._report.error(parameter.name.start, f"the switch '{parameter.name.text}' has to be optional: \\switch")
        self._declare(scope, parameter.name, symbol_of_parameter(parameter, is_optional))

    def _declare(self, scope: Scope, name: tree.Name, symbol: DataSymbol) -> None:
        self._declarations.check_length(name)
        first = scope.names.get(name.key)
        if first is not None:
            line = self._report.line(first.name.start)
            self._report.error(
                name.start, f"'{name.text}' is declared twice; the first is in line {line}", len(name.text)
            )
            return
        scope.names[name.key] = Owned(symbol, self._report.source.file, "", name)

    def _check_flow(self, node: tree.Routine) -> None:
        for body in (node.body, *(handler.body for handler in node.handlers)):
            for statement, cause in flow.unreachable(body):
                line = self._report.line(cause.start)
                self._report.error(statement.start, f"this is never reached, after line {line}", runs=True)
        if node.kind != "FUNC" or not flow.goes_on(node.body):
            return
        name = node.name
        if not any(isinstance(one, tree.Return | tree.Raise) for one in flow.statements(node.body)):
            self._report.error(name.start, f"the function '{name.text}' has no RETURN", len(name.text))
        else:
            self._report.warning(name.start, f"the function '{name.text}' can end without RETURN", len(name.text))

    # Statements

    def _check_listing(self, body: Sequence[tree.Statement]) -> None:
        for start, message in broken_lines(self._report.source, body):
            self._report.warning(start, message)

    def _check_body(self, body: Sequence[tree.Statement]) -> None:
        self._labels.append(set())
        for statement in body:
            if isinstance(statement, tree.Label):
                if any(statement.name.key in labels for labels in self._labels):
                    self._error(statement.name, f"there is a label '{statement.name.text}' already")
                self._labels[-1].add(statement.name.key)
        is_declaring = True
        for statement in body:
            if isinstance(statement, tree.Data):
                self._check_local_data(statement, is_declaring and len(self._labels) == 1)
            else:
                is_declaring = False
                self._check_statement(statement)
        self._labels.pop()

    def _check_local_data(self, node: tree.Data, is_at_start: bool) -> None:
        if node.scope:
            self._report.error(node.start, f"data of a routine cannot be {node.scope}", len(node.scope))
        if node.kind == "PERS":
            self._report.error(node.start, "data of a routine cannot be PERS; declare it in the module", 4)
        if not is_at_start:
            self._report.error(
                node.start, "data of a routine are declared before its first instruction", len(node.kind)
            )
        self._declarations.check_data(node)
        self._declare(self._expressions.scope, node.name, symbol_of_data(node))

    def _check_statement(self, node: tree.Statement) -> None:
        expressions = self._expressions
        match node:
            case tree.Assignment():
                self._check_assignment(node)
            case tree.CallStatement():
                self._check_call(node)
            case tree.LateCall():
                expressions.check(node.name, STRING)
                expressions.check_values(node.arguments)
            case tree.If():
                for branch in node.branches:
                    expressions.check(branch.condition, BOOL)
                    self._check_body(branch.body)
                if node.otherwise is not None:
                    self._check_body(node.otherwise)
            case tree.While():
                expressions.check(node.condition, BOOL)
                self._check_body(node.body)
            case tree.For():
                self._check_for(node)
            case tree.Test():
                self._check_test(node)
            case tree.Goto():
                if not any(node.label.key in labels for labels in self._labels):
                    self._error(node.label, f"there is no label '{node.label.text}' here or around this block")
            case tree.Return():
                self._check_return(node)
            case tree.Raise():
                if node.value is not None:
                    expressions.check(node.value, Type("errnum"))
                elif self._handler != "ERROR":
                    self._report.error(node.start, "RAISE needs an error number outside of an error handler", 5)
            case tree.Retry() | tree.TryNext():
                if self._handler != "ERROR":
                    word = "RETRY" if isinstance(node, tree.Retry) else "TRYNEXT"
                    self._report.error(node.start, f"{word} stands in error handlers only", len(word))
            case tree.Connect():
                self._check_connect(node)
            case tree.Placeholder():
                self._report.error(node.start, f"{node.text} is still to be replaced by an instruction", len(node.text))

    def _check_assignment(self, node: tree.Assignment) -> None:
        expressions = self._expressions
        type_ = None
        root = root_of(node.target)
        if isinstance(node.target, tree.Placeholder) or root is None:
            expressions.type_of(node.target)
        else:
            type_ = expressions.type_of(node.target)
            symbol = expressions.symbol(root.name.key)
            if isinstance(symbol, DataSymbol) and symbol.kind in _FIXED:
                self._error(root.name, f"'{symbol.name}' is {_FIXED[symbol.kind]} and cannot be assigned to")
        if type_ is not None:
            named = expressions.types.find(expressions.types.base(type_).name)
            if named is not None and named.kind == "opaque":
                what = (
                    "its signal is set by SetDO, SetGO or SetAO"
                    if type_.name.startswith("signal")
                    else "it has no value"
                )
                self._report.error(node.start, f"data of type {type_} cannot be assigned to; {what}")
                type_ = None
        expressions.check(node.value, type_)

    def _check_call(self, node: tree.CallStatement) -> None:
        symbol = self._expressions.symbol(node.name.key)
        if isinstance(symbol, RoutineSymbol) and symbol.kind == "PROC":
            self._expressions.check_arguments(node.name, symbol, node.arguments)
            return
        if symbol is None:
            self._expressions.note_undeclared(node.name, "procedure ")
        elif isinstance(symbol, RoutineSymbol):
            what = "a function; its result has to be used" if symbol.kind == "FUNC" else "a trap and cannot be called"
            self._error(node.name, f"'{node.name.text}' is {what}")
        else:
            self._error(node.name, f"'{node.name.text}' is no procedure")
        self._expressions.check_values(node.arguments)

    def _check_for(self, node: tree.For) -> None:
        for one in (node.first, node.last, node.step):
            if one is not None:
                self._expressions.check(one, NUM)
        self._declarations.check_length(node.name)
        around = self._expressions.scope
        self._expressions.scope = Scope(around)
        self._declare(self._expressions.scope, node.name, DataSymbol(node.name.text, "loop", NUM, node))
        self._check_body(node.body)
        self._expressions.scope = around

    def _check_test(self, node: tree.Test) -> None:
        type_ = self._expressions.type_of(node.value)
        if type_ is not None:
            type_ = self._expressions.types.as_value(type_)
        defaults = 0
        for case in node.cases:
            if isinstance(case, tree.Placeholder):
                self._report.error(case.start, f"{case.text} is still to be replaced by a case", len(case.text))
                continue
            if defaults:
                self._report.error(case.start, "nothing can follow DEFAULT", 4)
            defaults += case.values is None
            for value in case.values or ():
                self._expressions.check(value, None if type_ is None or type_.name == "literal" else type_)
            self._check_body(case.body)

    def _check_return(self, node: tree.Return) -> None:
        routine = self._routine
        if routine is not None and routine.kind == "FUNC" and routine.type is not None and self._handler != "UNDO":
            if node.value is None:
                self._report.error(node.start, f"RETURN of a function needs a value of type {routine.type.text}", 6)
            else:
                self._expressions.check(node.value, Type(routine.type.key))
        elif node.value is not None:
            what = {"PROC": "a procedure", "TRAP": "a trap"}.get(routine.kind if routine else "", "this")
            self._report.error(node.value.start, f"RETURN of {what} has no value")
            self._expressions.check(node.value, None)

    def _check_connect(self, node: tree.Connect) -> None:
        self._expressions.check(node.target, Type("intnum"))
        symbol = self._expressions.symbol(node.trap.key)
        if symbol is None:
            self._expressions.note_undeclared(node.trap, "trap ")
        elif not isinstance(symbol, RoutineSymbol) or symbol.kind != "TRAP":
            self._error(node.trap, f"'{node.trap.text}' is no trap")

    def _error(self, name: tree.Name, message: str) -> None:
        self._report.error(name.start, message, len(name.text))
