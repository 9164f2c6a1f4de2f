"""Occurrences of names in a module, and the declaration that each of them is of."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from daidalos.industry.rapid import predefined, tree
from daidalos.industry.rapid.checking import Checker
from daidalos.industry.rapid.expressions import ExpressionChecker
from daidalos.industry.rapid.parsing import Parsed
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


@dataclass(frozen=True)
class Target:
    """A declaration: file and offset of its name; a predefined name has no file.

    Attributes
    ----------
    node
        The declaration in the tree, where there is one.
    """

    file: str
    start: int
    text: str
    node: object = field(default=None, compare=False)


@dataclass(frozen=True)
class Occurrence:
    """A name in a text, and what it is of."""

    name: tree.Name
    target: Target


class Index:
    """All names of a module that can be resolved.

    Parameters
    ----------
    parsed
        The module.
    checker
        Checker of the program that it belongs to.
    """

    def __init__(self, parsed: Parsed, checker: Checker) -> None:
        self.occurrences: list[Occurrence] = []
        self.scopes: list[tuple[int, int, Scope]] = []
        """Start and end of routines and modules with what can be used there, the innermost last."""
        self._parsed = parsed
        self._checker = checker
        self._file = parsed.source.file
        self._labels: dict[str, tree.Name] = {}
        self._scope = checker.task
        for module in parsed.tree.modules:
            self._visit_module(module)
        if parsed.tree.fragment:
            self._expressions = self._make_expressions(checker.task)
            self._enter(Scope(checker.task), 0, len(parsed.source.text))
            self._visit_all(parsed.tree.fragment)

    def at(self, offset: int) -> Occurrence | None:
        """Return the occurrence at an offset, or that ends there."""
        touching = [one for one in self.occurrences if one.name.start <= offset <= one.name.end]
        return max(touching, key=lambda one: one.name.start, default=None)

    def scope_at(self, offset: int) -> Scope:
        """Return what can be used at an offset."""
        around = [scope for start, end, scope in self.scopes if start <= offset <= end]
        return around[-1] if around else self._checker.task

    def expressions_at(self, offset: int) -> ExpressionChecker:
        """Return a checker that knows the types of expressions at an offset."""
        scope = self.scope_at(offset)
        expressions = self._make_expressions(scope)
        expressions.scope = scope
        return expressions

    def _make_expressions(self, scope: Scope) -> ExpressionChecker:
        table = self._checker.type_table(scope)
        return ExpressionChecker(table, Reporter(self._parsed.source), set(), lambda *_: None)

    def _enter(self, scope: Scope, start: int, end: int) -> None:
        self.scopes.append((start, end, scope))
        self._scope = self._expressions.scope = scope

    def _visit_module(self, module: tree.Module) -> None:
        scope = self._checker.locals[id(module)]
        self._expressions = self._make_expressions(scope)
        self._enter(scope, module.start, module.end)
        self._add(module.name, Target(self._file, module.name.start, module.name.text, module))
        for item in module.items:
            self._scope = self._expressions.scope = scope
            if isinstance(item, tree.Routine):
                self._visit_routine(item, scope)
            elif isinstance(item, tree.Record):
                self._declare(item.name, item)
                for component in item.components:
                    self._use(component.type)
                    self._declare(component.name, component)
            elif isinstance(item, tree.Alias):
                self._declare(item.name, item)
                self._use(item.type)
            elif isinstance(item, tree.Data):
                self._visit_data(item)

    def _visit_routine(self, node: tree.Routine, module: Scope) -> None:
        self._declare(node.name, node)
        self._enter(Scope(module), node.start, node.end)
        if node.type is not None:
            self._use(node.type)
        for group in node.groups:
            for one in group.alternatives:
                if isinstance(one, tree.Parameter):
                    self._use(one.type)
                    self._local(one.name, symbol_of_parameter(one, group.is_optional), one)
        bodies = [node.body, *(handler.body for handler in node.handlers)]
        labels = [one for one in tree.walk(bodies) if isinstance(one, tree.Label)]
        self._labels = {one.name.key: one.name for one in labels}
        for handler in node.handlers:
            self._visit_all(handler.numbers)
        for body in bodies:
            self._visit_all(body)

    def _visit_data(self, node: tree.Data) -> None:
        self._use(node.type)
        self._declare(node.name, node)
        self._visit_all(node.dimensions)
        self._visit(node.value)

    def _visit_all(self, nodes: Sequence[object]) -> None:
        for node in nodes:
            self._visit(node)

    def _visit(self, node: object) -> None:
        match node:
            case tree.Data():
                self._local(node.name, symbol_of_data(node), node)
                self._visit_data(node)
            case tree.Variable():
                self._use(node.name)
            case tree.Component():
                self._visit(node.of)
                self._visit_component(node)
            case tree.Call() | tree.CallStatement():
                self._use(node.name)
                self._visit_arguments(node.name, node.arguments)
            case tree.LateCall():
                self._visit(node.name)
                self._visit_all([one.value for one in node.arguments])
            case tree.For():
                self._visit_for(node)
            case tree.Label():
                self._declare(node.name, node)
            case tree.Goto():
                label = self._labels.get(node.label.key)
                if label is not None:
                    self._add(node.label, Target(self._file, label.start, label.text))
            case tree.Connect():
                self._visit(node.target)
                self._use(node.trap)
            case tree.Name() | None:
                pass
            case _:
                self._visit_all(list(tree.children(node)))

    def _visit_for(self, node: tree.For) -> None:
        self._visit_all([node.first, node.last, node.step])
        around = self._scope
        self._enter(Scope(around), node.start, node.end)
        self._local(node.name, DataSymbol(node.name.text, "loop", Type("num"), node), node)
        self._declare(node.name, node)
        self._visit_all(node.body)
        self._scope = self._expressions.scope = around

    def _visit_component(self, node: tree.Component) -> None:
        type_ = self._expressions.type_of(node.of)
        symbol = self._expressions.types.find(self._expressions.types.base(type_).name) if type_ is not None else None
        record = symbol.node if symbol is not None else None
        if not isinstance(record, tree.Record):
            return
        for component in record.components:
            if component.name.key == node.name.key:
                self._add(
                    node.name, Target(self._file_of(record), component.name.start, component.name.text, component)
                )

    def _visit_arguments(self, name: tree.Name, arguments: Sequence[tree.Argument | tree.Placeholder]) -> None:
        owned = self._scope.find(name.key)
        routine = owned.symbol.node if owned is not None and isinstance(owned.symbol, RoutineSymbol) else None
        parameters = {one.name.key: one for one in routine.parameters()} if routine is not None else {}
        for argument in arguments:
            if isinstance(argument, tree.Placeholder):
                continue
            parameter = parameters.get(argument.name.key) if argument.name is not None else None
            if argument.name is not None and parameter is not None and owned is not None:
                target = Target(owned.file, parameter.name.start, parameter.name.text, parameter)
                self._add(argument.name, target)
            self._visit(argument.value)

    def _local(self, name: tree.Name, symbol: DataSymbol, node: object) -> None:
        self._scope.names.setdefault(name.key, Owned(symbol, self._file, "", name))
        if isinstance(node, tree.Parameter):
            self._declare(name, node)

    def _declare(self, name: tree.Name, node: object) -> None:
        self._add(name, Target(self._file, name.start, name.text, node))

    def _use(self, name: tree.Name) -> None:
        owned = self._scope.find(name.key)
        if owned is not None:
            node = getattr(owned.symbol, "node", None)
            self._add(name, Target(owned.file, owned.name.start, owned.name.text, node))
            return
        symbol = predefined.find(name.key)
        if symbol is not None:
            self._add(name, Target("", -1, symbol.name))

    def _add(self, name: tree.Name, target: Target) -> None:
        self.occurrences.append(Occurrence(name, target))

    def _file_of(self, record: tree.Record) -> str:
        scopes = [self._checker.task, *self._checker.locals.values()]
        found = (one for scope in scopes for one in scope.names.values() if one.name is record.name)
        return next((one.file for one in found), self._file)
