"""Translation of expressions and arguments of RAPID to expressions of Python."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from daidalos.industry.rapid import predefined, tree
from daidalos.industry.rapid.arguments import bind
from daidalos.industry.rapid.expressions import ExpressionChecker, root_of
from daidalos.industry.rapid.lexing import number_value, string_value
from daidalos.industry.rapid.literals import parse_literals
from daidalos.industry.rapid.runtime.errors import FatalError
from daidalos.industry.rapid.runtime.names import Frame, Place, global_name, python_name
from daidalos.industry.rapid.runtime.registry import find_routine
from daidalos.industry.rapid.runtime.values import is_scalar
from daidalos.industry.rapid.symbols import DataSymbol, RoutineSymbol, Type
from daidalos.industry.rapid.types import CONFIGURED

_PYTHON = {"=": "==", "<>": "!=", "AND": "and", "OR": "or", "XOR": "!="}
_VECTORS = {"+": "_vector_sum", "-": "_vector_difference"}


class ExpressionTranslator:
    """Translates expressions of a module.

    Parameters
    ----------
    checker
        Knows the types of expressions, and the scope.
    constant
        Stores a value that does not change, and returns the expression of it.
    """

    def __init__(self, checker: ExpressionChecker, constant: Callable[[Any], str]) -> None:
        self._checker = checker
        self._constant = constant
        self.types = checker.types
        self.frame: Frame | None = None

    def type_of(self, node: tree.Expression) -> Type:
        """Return the type of an expression, ``any`` where it is not known."""
        return self._checker.type_of(node) or Type("any")

    def place(self, name: tree.Name) -> Place | None:
        """Return how data is reached; None where it is not data of the program."""
        if self.frame is not None and name.key in self.frame.places:
            return self.frame.places[name.key]
        owned = self._checker.scope.find(name.key)
        if owned is not None and isinstance(owned.symbol, DataSymbol):
            type_ = owned.symbol.type
            return Place("global", global_name(owned), type_, is_scalar(self.types, type_))
        symbol = predefined.find(name.key)
        if isinstance(symbol, DataSymbol) and symbol.type.name not in CONFIGURED:
            return Place("global", f"p_{name.key}", symbol.type, is_scalar(self.types, symbol.type))
        return None

    def read(self, node: tree.Expression) -> str:
        """Return the Python expression of a value, which may be shared with data of the program."""
        match node:
            case tree.Number():
                return repr(number_value(node.text))
            case tree.String():
                return repr(string_value(node.text))
            case tree.Boolean():
                return repr(node.value)
            case tree.Literals():
                return self._constant(parse_literals(node.text))
            case tree.Aggregate():
                return f"[{', '.join(self.copy(item) for item in node.items)}]"
            case tree.Variable():
                return self._variable(node)
            case tree.Component():
                return f"{self._record(node.of)}[{self._component(node)}]"
            case tree.Index():
                return self._index(node)
            case tree.Call():
                return self._call(node)
            case tree.Unary():
                return self._unary(node)
            case tree.Binary():
                return self._binary(node)
        raise FatalError(f"{getattr(node, 'text', node)} is still to be replaced")

    def copy(self, node: tree.Expression) -> str:
        """Return the Python expression of a value that is shared with nothing."""
        text = self.read(node)
        if isinstance(node, tree.Number | tree.String | tree.Boolean | tree.Binary | tree.Unary | tree.Aggregate):
            return text
        if isinstance(node, tree.Call) or is_scalar(self.types, self.type_of(node)):
            return text
        return f"_copied({text})"

    def reference(self, node: tree.Expression) -> str:
        """Return what a routine gets that may change data: a reference of a scalar, else the data itself."""
        if isinstance(node, tree.Variable):
            place = self.place(node.name)
            if place is None:
                return repr(node.name.text)
            return place.reference() if place.is_scalar else place.read()
        if not is_scalar(self.types, self.type_of(node)):
            return self.read(node)
        if isinstance(node, tree.Component):
            return f"({self.read(node.of)}, {self._component(node)})"
        if isinstance(node, tree.Index):
            array, last = self._array(node)
            return f"({array}, {last})"
        return f"([{self.read(node)}], 0)"

    def assign(self, target: tree.Expression, value: str) -> str:
        """Return the statement that assigns the text of a value."""
        if isinstance(target, tree.Variable):
            place = self.place(target.name)
            if place is None:
                raise FatalError(f"'{target.name.text}' is a signal; SetDO, SetGO or SetAO sets it, not ':='")
            if not place.is_scalar:
                return f"{place.read()}[:] = {value}"
            left = {"box": f"{place.name}[0]", "reference": f"{place.name}[0][{place.name}[1]]"}
            return f"{left.get(place.how, place.name)} = {value}"
        return f"{self.read(target)} = {value}"

    def _variable(self, node: tree.Variable) -> str:
        if node.name.key == "errno":
            return "_task.errno"
        if node.name.key == "intno":
            return "_task.intno"
        place = self.place(node.name)
        if place is None:
            return f"_task.signal({node.name.text!r})"
        if place.type.name.startswith("signal"):
            return f"_task.signal({place.read()})"
        return place.read()

    def _record(self, node: tree.Expression) -> str:
        return self.read(node)

    def _component(self, node: tree.Component) -> int:
        type_ = self.type_of(node.of)
        components = self.types.components(type_)
        if components is None:
            raise FatalError(f"the components of {type_} are not known, so '{node.name.text}' cannot be used")
        return [name for name, _ in components].index(node.name.key)

    def _array(self, node: tree.Index) -> tuple[str, str]:
        """Return the array of the last index, and that index."""
        text = self.read(node.of)
        parts = [self._index_text(index) for index in node.indices]
        return text + "".join(f"[{one}]" for one in parts[:-1]), parts[-1]

    def _index(self, node: tree.Index) -> str:
        array, last = self._array(node)
        return f"{array}[{last}]"

    def _index_text(self, node: tree.Expression) -> str:
        if isinstance(node, tree.Number) and node.text.isdigit() and int(node.text) > 0:
            return str(int(node.text) - 1)
        return f"_index({self.read(node)})"

    def _unary(self, node: tree.Unary) -> str:
        operand = self.read(node.operand)
        if node.operator == "NOT":
            return f"(not {operand})"
        if self.types.base(self.type_of(node.operand)).name == "pos":
            return f"_scaled({operand}, {node.operator}1.0)"
        return f"({node.operator}{operand})"

    def _binary(self, node: tree.Binary) -> str:
        left, right = self.read(node.left), self.read(node.right)
        operator = node.operator
        if operator in ("DIV", "MOD"):
            return f"_{operator.lower()}({left}, {right})"
        types = [self.types.base(self.type_of(one)).name for one in (node.left, node.right)]
        if operator in _PYTHON:
            return f"({left} {_PYTHON[operator]} {right})"
        if "string" in types:
            return f"_text({left} + {right})"
        if "pos" in types and operator in _VECTORS:
            return f"{_VECTORS[operator]}({left}, {right})"
        if operator == "*" and types[0] == "orient":
            return f"_quaternion_product({left}, {right})"
        if "pos" in types:
            if types[0] == types[1] or isinstance(node.left, tree.Literals) or isinstance(node.right, tree.Literals):
                return f"_cross({left}, {right})"
            if types[0] == "pos":
                return f"_scaled({left}, {'1.0 / ' if operator == '/' else ''}{right})"
            return f"_scaled({right}, {left})"
        return f"({left} {operator} {right})"

    # Calls

    def _call(self, node: tree.Call) -> str:
        if node.name.key in ("present", "isvar", "ispers", "type", "argname"):
            return self._about(node)
        symbol = self._checker.symbol(node.name.key)
        assert isinstance(symbol, RoutineSymbol)
        return self.call(node.name, symbol, node.arguments)

    def _about(self, node: tree.Call) -> str:
        """Translate functions that are about data, not about its value."""
        value = next(one.value for one in node.arguments if one.value is not None)
        root = root_of(value)
        if node.name.key == "present":
            place = self.place(root.name) if root is not None else None
            return f"({place.name} is not None)" if place is not None else "True"
        if node.name.key == "argname":
            return repr(root.name.text if root is not None else "")
        if node.name.key == "type":
            return repr(self.types.base(self.type_of(value)).name)
        symbol = self._checker.symbol(root.name.key) if root is not None else None
        kind = symbol.kind if isinstance(symbol, DataSymbol) else ""
        return repr(kind == ("PERS" if node.name.key == "ispers" else "VAR"))

    def call(self, name: tree.Name, symbol: RoutineSymbol, arguments: Sequence[tree.Argument]) -> str:
        """Return the Python expression of a call."""
        if symbol.node is None and find_routine(name.key) is None:
            return f"_task.unknown({symbol.name!r})"
        given = bind(symbol.groups or [], arguments, self._checker.zone_left_out(symbol, arguments)).given
        owned = self._checker.scope.find(name.key)
        if owned is not None and symbol.node is not None:
            parts = [f"a_{python_name(one.name.key)}={self._argument(one, argument, True)}" for one, argument in given]
            return f"{global_name(owned)}({', '.join(parts)})"
        parts = ["_task", *(f"{one.name.key}_={self._argument(one, argument, False)}" for one, argument in given)]
        return f"b_{name.key}({', '.join(parts)})"

    def _argument(self, parameter: tree.Parameter, argument: tree.Argument, is_own: bool) -> str:
        value = argument.value
        if value is None:
            return "True"
        if argument.is_conditional:
            root = root_of(value)
            place = self.place(root.name) if root is not None else None
            by_reference = bool(parameter.mode) and place is not None and place.is_scalar
            return place.hand_on(by_reference) if place is not None else self.read(value)
        name = parameter.type.key
        is_signal = name in CONFIGURED or (name == "any" and parameter.name.key in ("signal", "fromsignal", "tosignal"))
        if is_signal and isinstance(value, tree.Variable):
            place = self.place(value.name)
            return place.read() if place is not None else repr(value.name.text)
        if name == "syncident" and not is_own and isinstance(value, tree.Variable):
            return repr(value.name.key)  # tasks meet by its name
        if parameter.mode in ("VAR", "PERS", "INOUT"):
            return self.reference(value)
        return self.copy(value) if is_own else self.read(value)
