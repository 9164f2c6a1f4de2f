"""Translation of modules to a program of Python: a function per routine, and a map of its lines to those of RAPID."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from daidalos.industry.rapid import tree
from daidalos.industry.rapid.checking import Checker
from daidalos.industry.rapid.expressions import ExpressionChecker
from daidalos.industry.rapid.parsing import Parsed
from daidalos.industry.rapid.reporting import Reporter
from daidalos.industry.rapid.runtime.errors import FatalError
from daidalos.industry.rapid.runtime.expressions import ExpressionTranslator
from daidalos.industry.rapid.runtime.names import (
    Frame,
    Place,
    global_name,
    jumps,
    labels,
    local_names,
    python_name,
    referenced_names,
)
from daidalos.industry.rapid.runtime.values import default_value, is_scalar
from daidalos.industry.rapid.symbols import (
    DataSymbol,
    Owned,
    RoutineSymbol,
    Scope,
    Type,
    symbol_of_data,
    symbol_of_parameter,
)

FILE = "<rapid>"


class Translation:
    """The program in Python.

    Attributes
    ----------
    lines
        Lines of Python; with `places`, the file and the line of RAPID that each is from.
    constants
        Values that do not change, by the names that the program has for them.
    """

    def __init__(self) -> None:
        self.lines: list[str] = []
        self.places: list[tuple[str, int]] = []
        self.constants: dict[str, Any] = {}

    def constant(self, value: Any) -> str:
        """Store a value, and return its name."""
        name = f"k_{len(self.constants)}"
        self.constants[name] = value
        return name

    def add(self, indent: int, text: str, place: tuple[str, int]) -> None:
        """Append a line."""
        self.lines.append("    " * indent + text)
        self.places.append(place)

    def text(self) -> str:
        """Return the whole program."""
        return "\n".join(self.lines) + "\n"


def translate(modules: Sequence[Parsed], checker: Checker, is_debugged: bool = False) -> Translation:
    """Return the program of modules that have no errors; for a debugger, with all local data in boxes."""
    result = Translation()
    for parsed in modules:
        for module in parsed.tree.modules:
            scope = checker.locals[id(module)]
            report = Reporter(parsed.source)
            expressions = ExpressionChecker(checker.type_table(scope), report, set(), lambda *_: None)
            translator = _ModuleTranslator(result, parsed, scope, expressions, is_debugged)
            for item in module.items:
                if isinstance(item, tree.Routine):
                    translator.translate(item)
    return result


class _ModuleTranslator:
    """Translates the routines of a module."""

    def __init__(
        self, result: Translation, parsed: Parsed, scope: Scope, checker: ExpressionChecker, is_debugged: bool
    ) -> None:
        self._is_debugged = is_debugged
        self._result = result
        self._source = parsed.source
        self._scope = scope
        self._checker = checker
        self._expressions = ExpressionTranslator(checker, result.constant)
        self._place = (self._source.file, 0)
        self._frame = Frame(set())
        self._handler = ""
        self._in_handler = False
        self._count = 0

    def translate(self, node: tree.Routine) -> None:
        """Translate a routine.

        Raises
        ------
        FatalError
            Where a statement cannot run, with ``file:line``.
        """
        try:
            self._translate(node)
        except FatalError as error:
            file, line = self._place
            raise FatalError(f"{file}:{line}: {error}") from None

    def _translate(self, node: tree.Routine) -> None:
        self._go_to(node.start)
        self._scope_of(node)
        parameters = [f"a_{python_name(one.name.key)}=None" for one in node.parameters()]
        self._add(0, f"def {global_name(self._owned(node))}({', '.join(parameters)}):")
        assigned = self._assigned_globals(node)
        if assigned:
            self._add(1, f"global {', '.join(sorted(assigned))}")
        self._bind_parameters(node)
        self._declare_locals(node)
        self._define_handlers(node)
        undo = next((one for one in node.handlers if one.kind == "UNDO"), None)
        if undo is None:
            self._body(node.body, 1)
        else:
            self._body_with_undo(node, undo)
        self._go_to(node.end - 1)
        if node.kind == "FUNC":
            self._add(1, f"_task.no_return({node.name.text!r})")
        else:
            self._add(1, "return None")

    # Local data

    def _owned(self, node: tree.Routine) -> Owned:
        owned = self._scope.find(node.name.key)
        assert owned is not None
        return owned

    def _scope_of(self, node: tree.Routine) -> None:
        scope = Scope(self._scope)
        for group in node.groups:
            for one in group.alternatives:
                if isinstance(one, tree.Parameter):
                    symbol = symbol_of_parameter(one, group.is_optional)
                    scope.names[one.name.key] = Owned(symbol, "", "", one.name)
        self._checker.scope = scope
        boxed = local_names(node) if self._is_debugged else referenced_names(node)
        self._frame = self._expressions.frame = Frame(boxed)
        self._handler = ""
        self._in_handler = False

    def _assigned_globals(self, node: tree.Routine) -> set[str]:
        """Return the scalars of modules that a routine assigns to."""
        found = set()
        bodies = [node.body, *(handler.body for handler in node.handlers)]
        local = {one.name.key for one in node.parameters()}
        local |= {one.name.key for one in tree.walk(bodies) if isinstance(one, tree.Data)}
        for one in tree.walk([node.body, *(handler.body for handler in node.handlers)]):
            if isinstance(one, tree.Assignment) and isinstance(one.target, tree.Variable):
                if one.target.name.key in local:
                    continue
                owned = self._scope.find(one.target.name.key)
                if owned is not None and isinstance(owned.symbol, DataSymbol) and self._is_scalar(owned.symbol.type):
                    found.add(global_name(owned))
                elif owned is None and one.target.name.key.startswith("reg"):
                    found.add(f"p_{one.target.name.key}")
        return found

    def _is_scalar(self, type_: Type) -> bool:
        return is_scalar(self._checker.types, type_)

    def _bind_parameters(self, node: tree.Routine) -> None:
        for group in node.groups:
            for one in group.alternatives:
                if not isinstance(one, tree.Parameter):
                    continue
                type_ = Type(one.type.key, one.dimensions)
                name, scalar = f"a_{python_name(one.name.key)}", self._is_scalar(type_)
                how = "reference" if one.mode and scalar else "local"
                if how == "local" and scalar and one.name.key in self._frame.boxed:
                    self._add(1, f"if {name} is not None: {name} = [{name}]")
                    how = "box"
                self._frame.places[one.name.key] = Place(how, name, type_, scalar, group.is_optional)
                self._frame.locals.append(name)

    def _declare_locals(self, node: tree.Routine) -> None:
        for one in tree.walk([node.body, *(handler.body for handler in node.handlers)]):
            if isinstance(one, tree.Data):
                self._go_to(one.start)
                self._declare_local(one)

    def _declare_local(self, node: tree.Data) -> None:
        symbol = symbol_of_data(node)
        scalar = self._is_scalar(symbol.type)
        how = "box" if scalar and node.name.key in self._frame.boxed else "local"
        name = f"v_{python_name(node.name.key)}"
        if node.value is not None:
            value = self._expressions.copy(node.value)
        elif scalar:
            value = repr(default_value(self._checker.types, symbol.type, []))
        else:
            sizes = ", ".join(f"int({self._expressions.read(one)})" for one in node.dimensions)
            value = f"_task.default({symbol.type.name!r}, [{sizes}])"
        self._checker.scope.names[node.name.key] = Owned(symbol, "", "", node.name)
        self._frame.places[node.name.key] = Place(how, name, symbol.type, scalar)
        self._frame.locals.append(name)
        self._add(1, f"{name} = [{value}]" if how == "box" else f"{name} = {value}")

    # Handlers

    def _define_handlers(self, node: tree.Routine) -> None:
        handler = next((one for one in node.handlers if one.kind == "ERROR"), None)
        if handler is None:
            return
        self._go_to(handler.start)
        self._add(1, "def _handler():")
        if self._frame.locals:
            self._add(2, f"nonlocal {', '.join(self._frame.locals)}")
        assigned = self._assigned_globals(node)
        if assigned:
            self._add(2, f"global {', '.join(sorted(assigned))}")
        self._in_handler = True
        self._body(handler.body, 2)
        self._in_handler = False
        self._add(2, "return None")
        numbers = ", ".join(self._expressions.read(one) for one in handler.numbers)
        self._handler = f"_handler, ({numbers}{',' if numbers else ''})"

    def _body_with_undo(self, node: tree.Routine, undo: tree.Handler) -> None:
        """Translate a routine whose UNDO handler runs where ExitCycle, or an error for a caller, leaves it."""
        self._add(1, "try:")
        self._body(node.body, 2)
        self._go_to(undo.start)
        self._add(1, "except (_ProgramEnd, *_RECOVERABLE) as _left:")
        handler, self._handler = self._handler, ""
        self._add(2, "if _task.is_undone(_left):")
        self._body(undo.body, 3)
        self._handler = handler
        self._add(2, "raise")

    # Statements

    def _go_to(self, offset: int) -> None:
        self._place = (self._source.file, self._source.place(offset)[0])

    def _add(self, indent: int, text: str) -> None:
        self._result.add(indent, text, self._place)

    def _guarded(self, indent: int, text: str) -> None:
        """Add a line that may fail; a failure goes to the error handler, which may have it tried again."""
        if not self._handler or self._in_handler:
            self._add(indent, text)
            return
        self._add(indent, "_tries = 0")
        self._add(indent, "while True:")
        self._add(indent + 1, "try:")
        self._add(indent + 2, text)
        if not text.startswith("return"):
            self._add(indent + 2, "break")
        self._add(indent + 1, "except _RECOVERABLE as _error:")
        self._add(indent + 2, f"_action = _task.recover(_error, _tries, {self._handler})")
        self._add(indent + 2, "_tries += 1")
        self._add(indent + 2, "if _action is _RETRY: continue")
        self._add(indent + 2, "if _action is _TRYNEXT: break")
        self._add(indent + 2, "return _action[0]")

    def _body(self, body: list[tree.Statement], indent: int) -> None:
        own = set(labels(body))
        if own & jumps(body):
            self._body_with_labels(body, indent)
            return
        count = len(self._result.lines)
        for one in body:
            self._statement(one, indent)
        if len(self._result.lines) == count:
            self._add(indent, "pass")

    def _body_with_labels(self, body: list[tree.Statement], indent: int) -> None:
        """Translate a list that is jumped into: parts between labels, run from the one that is jumped to."""
        self._count += 1
        at = f"_at_{self._count}"
        parts: list[tuple[str, list[tree.Statement]]] = [("", [])]
        for one in body:
            if isinstance(one, tree.Label):
                parts.append((one.name.key, []))
            else:
                parts[-1][1].append(one)
        positions = {name: index for index, (name, _) in enumerate(parts) if name}
        self._add(indent, f"{at} = 0")
        self._add(indent, "while True:")
        self._add(indent + 1, "try:")
        for index, (_, part) in enumerate(parts):
            self._add(indent + 2, f"if {at} <= {index}:")
            self._body(part, indent + 3)
        self._add(indent + 2, "break")
        self._add(indent + 1, "except _Jump as _jump:")
        self._add(indent + 2, f"{at} = {positions!r}.get(_jump.args[0])")
        self._add(indent + 2, f"if {at} is None: raise")

    def _statement(self, node: tree.Statement, indent: int) -> None:
        self._go_to(node.start)
        expressions = self._expressions
        match node:
            case tree.Assignment():
                self._assignment(node, indent)
            case tree.CallStatement():
                self._call(node, indent)
            case tree.LateCall():
                arguments = ", ".join(self._late_argument(one) for one in node.arguments)
                self._guarded(indent, f"_task.call_late({expressions.read(node.name)}, [{arguments}])")
            case tree.If():
                self._if(node, indent)
            case tree.For():
                self._for(node, indent)
            case tree.While():
                self._while(node, indent)
            case tree.Test():
                self._test(node, indent)
            case tree.Goto():
                self._add(indent, f"raise _Jump({node.label.key!r})")
            case tree.Return():
                self._return(node, indent)
            case tree.Raise():
                number = expressions.read(node.value) if node.value is not None else "None"
                self._guarded(indent, f"_task.raise_({number}, {self._in_handler})")
            case tree.Retry():
                self._add(indent, "return _RETRY")
            case tree.TryNext():
                self._add(indent, "return _TRYNEXT")
            case tree.Exit():
                self._add(indent, "raise _ProgramEnd('EXIT')")
            case tree.Connect():
                self._connect(node, indent)

    def _assignment(self, node: tree.Assignment, indent: int) -> None:
        text = self._expressions.assign(node.target, self._expressions.copy(node.value))
        is_safe = isinstance(node.target, tree.Variable) and isinstance(
            node.value, tree.Number | tree.String | tree.Boolean | tree.Literals
        )
        (self._add if is_safe else self._guarded)(indent, text)

    def _call(self, node: tree.CallStatement, indent: int) -> None:
        if node.name.key == "exitcycle":
            self._add(indent, "raise _ProgramEnd('ExitCycle')")
            return
        symbol = self._checker.symbol(node.name.key)
        assert isinstance(symbol, RoutineSymbol)
        if node.name.key == "waituntil":
            self._wait_until(node, symbol, indent)
            return
        self._guarded(indent, self._expressions.call(node.name, symbol, node.arguments))

    def _wait_until(self, node: tree.CallStatement, symbol: RoutineSymbol, indent: int) -> None:
        """Translate WaitUntil, whose condition is looked at again and again."""
        rest = [one for one in node.arguments if one.is_optional]
        condition = next(one for one in node.arguments if not one.is_optional)
        assert condition.value is not None
        inner = self._expressions.call(node.name, symbol, [condition, *rest])
        value = self._expressions.read(condition.value)
        self._guarded(indent, inner.replace(f"cond_={value}", f"cond_=lambda: {value}", 1))

    def _late_argument(self, argument: tree.Argument) -> str:
        name = argument.name.key if argument.name else None
        if argument.value is None:
            return f"({name!r}, {argument.is_optional}, True, True)"
        reference = self._expressions.reference(argument.value)
        return f"({name!r}, {argument.is_optional}, {self._expressions.copy(argument.value)}, {reference})"

    def _condition(self, node: tree.Expression, indent: int) -> str:
        """Return the expression of a condition; with a handler it is worked out on a line of its own."""
        text = self._expressions.read(node)
        if not self._handler or self._in_handler or isinstance(node, tree.Boolean):
            return text
        self._count += 1
        name = f"_c_{self._count}"
        self._add(indent, f"{name} = None")
        self._guarded(indent, f"{name} = {text}")
        return name

    def _if(self, node: tree.If, indent: int) -> None:
        is_guarded = bool(self._handler) and not self._in_handler
        word = "if"
        for branch in node.branches:
            self._go_to(branch.start)
            if is_guarded and word == "elif":
                self._add(indent, "else:")
                indent, word = indent + 1, "if"
            condition = self._condition(branch.condition, indent)
            if condition.startswith("_c_"):
                # Where the handler has gone on behind the condition, it is None, and no branch is taken.
                self._add(indent, f"if {condition} is None: pass")
                word = "elif"
            self._add(indent, f"{word} {condition}:")
            self._body(branch.body, indent + 1)
            word = "elif"
        if node.otherwise is not None:
            self._add(indent, "else:")
            self._body(node.otherwise, indent + 1)

    def _while(self, node: tree.While, indent: int) -> None:
        self._add(indent, "while True:")
        condition = self._condition(node.condition, indent + 1)
        if condition != "True":
            self._add(indent + 1, f"if not {condition}: break")
        self._body(node.body, indent + 1)

    def _for(self, node: tree.For, indent: int) -> None:
        parts = [self._expressions.read(node.first), self._expressions.read(node.last)]
        parts.append(self._expressions.read(node.step) if node.step is not None else "None")
        self._count += 1
        name = f"i_{python_name(node.name.key)}_{self._count}"
        self._add(indent, f"for {name} in _counted({', '.join(parts)}):")
        key, scope = node.name.key, self._checker.scope
        before = self._frame.places.get(key)
        self._checker.scope = Scope(scope, {key: Owned(DataSymbol(key, "loop", Type("num")), "", "", node.name)})
        self._frame.places[key] = Place("local", name, Type("num"), True)
        self._body(node.body, indent + 1)
        self._checker.scope = scope
        if before is not None:
            self._frame.places[key] = before
        else:
            del self._frame.places[key]

    def _test(self, node: tree.Test, indent: int) -> None:
        self._count += 1
        name = f"_t_{self._count}"
        self._add(indent, f"{name} = None")
        self._guarded(indent, f"{name} = {self._expressions.read(node.value)}")
        word = "if"
        if self._handler and not self._in_handler:
            self._add(indent, f"if {name} is None: pass")  # the handler has gone on behind ENDTEST
            word = "elif"
        cases = [case for case in node.cases if isinstance(case, tree.Case)]
        for case in cases:
            self._go_to(case.start)
            if case.values is not None:
                values = ", ".join(self._expressions.read(value) for value in case.values)
                self._add(indent, f"{word} {name} in ({values},):")
            else:
                self._add(indent, "else:" if word == "elif" else "if True:")
            self._body(case.body, indent + 1)
            word = "elif"

    def _return(self, node: tree.Return, indent: int) -> None:
        value = self._expressions.copy(node.value) if node.value is not None else "None"
        if self._in_handler:
            self._add(indent, f"return ({value},)")
        elif node.value is None or isinstance(node.value, tree.Number | tree.Boolean | tree.String):
            self._add(indent, f"return {value}")
        else:
            self._guarded(indent, f"return {value}")

    def _connect(self, node: tree.Connect, indent: int) -> None:
        owned = self._scope.find(node.trap.key)
        assert owned is not None
        target = self._expressions.reference(node.target)
        self._guarded(indent, f"_task.connect({target}, {global_name(owned)})")
