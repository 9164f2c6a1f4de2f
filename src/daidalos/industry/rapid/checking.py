"""Semantic check of the modules of a task: what a controller finds when it links a program."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from daidalos.industry.rapid import predefined, tree
from daidalos.industry.rapid.declarations import DeclarationChecker
from daidalos.industry.rapid.expressions import ExpressionChecker
from daidalos.industry.rapid.parsing import Parsed
from daidalos.industry.rapid.problems import Problem
from daidalos.industry.rapid.reporting import Reporter
from daidalos.industry.rapid.routines import RoutineChecker
from daidalos.industry.rapid.symbols import (
    Owned,
    Scope,
    Symbol,
    TypeSymbol,
    symbol_of_data,
    symbol_of_routine,
    symbol_of_type,
)
from daidalos.industry.rapid.types import TypeTable

MAX_PROBLEMS = 500


class Checker:
    """Check of modules that see each other's names.

    Parameters
    ----------
    modules
        The modules as they were parsed.
    signals
        Names of signals that the controller's configuration declares.
    is_complete
        Whether these are all modules of the program; beside one that cannot be read, unknown names are warnings.
    """

    def __init__(self, modules: Sequence[Parsed], signals: Iterable[str] = (), is_complete: bool = True) -> None:
        self.modules = modules
        self._is_complete = is_complete
        self.task = Scope()
        self.locals: dict[int, Scope] = {}
        self._reporters = {parsed.source.file: Reporter(parsed.source) for parsed in modules}
        self._configured = {name.lower() for name in signals}
        self._unknown: list[tuple[Reporter, tree.Name, Scope, str]] = []
        for parsed in modules:
            self._declare(parsed)

    def check(self) -> dict[str, list[Problem]]:
        """Return all problems by file, syntax errors included, in the order of the text."""
        for parsed in self.modules:
            self._check_module(parsed)
        self._report_unknown()
        return {
            parsed.source.file: sorted({*parsed.problems, *self._reporters[parsed.source.file].problems})[:MAX_PROBLEMS]
            for parsed in self.modules
        }

    def type_table(self, scope: Scope) -> TypeTable:
        """Return the data types that are known in a scope."""

        def lookup(key: str) -> TypeSymbol | None:
            owned = scope.find(key)
            if owned is not None and isinstance(owned.symbol, TypeSymbol):
                return owned.symbol
            return predefined.find_type(key)

        return TypeTable(lookup)

    def _declare(self, parsed: Parsed) -> None:
        report = self._reporters[parsed.source.file]
        for module in parsed.tree.modules:
            local = self.locals[id(module)] = Scope(self.task)
            for item in module.items:
                if isinstance(item, tree.Placeholder):
                    continue
                owned = Owned(_symbol(item), parsed.source.file, module.name.text, item.name, item.scope)
                scope = local if item.scope == "LOCAL" else self.task
                first = scope.names.setdefault(item.name.key, owned)
                clash = first if first is not owned else self._other(scope, local, owned)
                if clash is not None:
                    where = (
                        f"line {self._line(clash)}" if clash.file == owned.file else f"{clash.file}:{self._line(clash)}"
                    )
                    text = item.name.text
                    report.error(item.name.start, f"'{text}' is declared twice; the first is in {where}", len(text))

    def _other(self, scope: Scope, local: Scope, owned: Owned) -> Owned | None:
        """Return a declaration of the same name in the same module, in its other scope."""
        if scope is local:
            found = self.task.names.get(owned.name.key)
            return found if found is not None and found.module == owned.module else None
        return local.names.get(owned.name.key)

    def _line(self, owned: Owned) -> int:
        return self._reporters[owned.file].line(owned.name.start)

    def _check_module(self, parsed: Parsed) -> None:
        report = self._reporters[parsed.source.file]
        for module in parsed.tree.modules:
            scope = self.locals[id(module)]
            expressions = self._expressions(report, scope)
            declarations = DeclarationChecker(expressions, report)
            routines = RoutineChecker(expressions, declarations, report)
            declarations.check_length(module.name)
            for item in module.items:
                expressions.scope = scope
                if isinstance(item, tree.Placeholder):
                    report.error(item.start, f"{item.text} is still to be replaced by a declaration", len(item.text))
                elif isinstance(item, tree.Routine):
                    routines.check(item, scope)
                else:
                    declarations.check(item)
        if parsed.tree.fragment:
            expressions = self._expressions(report, Scope(self.task), is_fragment=True)
            RoutineChecker(expressions, DeclarationChecker(expressions, report), report).check_fragment(
                parsed.tree.fragment
            )

    def _expressions(self, report: Reporter, scope: Scope, is_fragment: bool = False) -> ExpressionChecker:
        def undeclared(name: tree.Name, scope: Scope, what: str) -> None:
            # A fragment has its data elsewhere; routines that no controller knows are still worth a word.
            if what or not is_fragment:
                self._unknown.append((report, name, scope, what))

        expressions = ExpressionChecker(self.type_table(scope), report, self._configured, undeclared)
        expressions.scope = scope
        return expressions

    def _report_unknown(self) -> None:
        """Report names that are not declared, each once in a module, unless the configuration may declare them."""
        reported: set[tuple[int, str]] = set()
        for report, name, scope, what in self._unknown:
            key = (id(report), name.key)
            if key in reported or (name.key in self._configured and not what):
                continue
            reported.add(key)
            hint = report.hint(name.text, scope.visible() | predefined.names())
            message = f"{what}'{name.text}' is not declared"
            if self._is_complete:
                report.error(name.start, message + hint, len(name.text))
            else:
                report.warning(name.start, f"{message} in the modules that can be read{hint}", len(name.text))


def check(modules: Sequence[Parsed], signals: Iterable[str] = (), is_complete: bool = True) -> dict[str, list[Problem]]:
    """Return the problems of modules that are loaded together, by file; the arguments are those of `Checker`."""
    return Checker(modules, signals, is_complete).check()


def _symbol(item: tree.Data | tree.Alias | tree.Record | tree.Routine) -> Symbol:
    if isinstance(item, tree.Data):
        return symbol_of_data(item)
    return symbol_of_routine(item) if isinstance(item, tree.Routine) else symbol_of_type(item)
