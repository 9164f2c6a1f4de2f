"""Parameters of nodes and their plugins, from the classes in which the libraries declare them.

`declare` makes ROS parameters with descriptors, checks the values from files and the command line, and passes changes
at run time on. `warn_of_undeclared` names given parameters that nothing declared.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field
from dataclasses import replace as with_changes
from difflib import get_close_matches
from functools import partial
from typing import TYPE_CHECKING, Any, TypeVar
from weakref import WeakKeyDictionary

from rclpy.node import Node
from rclpy.parameter import Parameter

from daidalos.common.errors import Location
from daidalos.common.parameters import Constraints, Leaf, ParameterError, Parameters, build, replace
from daidalos.common.suggestions import near

if TYPE_CHECKING:
    from rcl_interfaces.msg import ParameterDescriptor, SetParametersResult

S = TypeVar("S", bool, int, float, str)
T = TypeVar("T", bound=Parameters)

_SCALARS = {
    bool: Parameter.Type.BOOL,
    int: Parameter.Type.INTEGER,
    float: Parameter.Type.DOUBLE,
    str: Parameter.Type.STRING,
}
_ARRAYS = {
    bool: Parameter.Type.BOOL_ARRAY,
    int: Parameter.Type.INTEGER_ARRAY,
    float: Parameter.Type.DOUBLE_ARRAY,
    str: Parameter.Type.STRING_ARRAY,
}
_MAX_INTEGER = 2**63 - 1
_LIKENESS_IN_SHARED_SECTIONS = 0.9
"""Likeness from which a name below ``/**`` is reported as misspelt; others may be meant for other nodes."""


@dataclass(eq=False)
class _Group:
    """Parameters that were declared together.

    Parameters
    ----------
    prefix : str
        What their names begin with, with the dot.
    values : Parameters
    names : frozenset of str
        Without the prefix.
    reconfigure : callable or None
    """

    prefix: str
    values: Any
    names: frozenset[str]
    reconfigure: Callable[[Any], None] | None


@dataclass(eq=False)
class _NodeParameters:
    """Declared parameters of a node, and the names that were warned of."""

    groups: dict[tuple[str, type], _Group] = field(default_factory=dict)
    warned: set[str] = field(default_factory=set)


_of_nodes: WeakKeyDictionary[Node, _NodeParameters] = WeakKeyDictionary()


def declare(
    node: Node,
    kind: type[T],
    prefix: str = "",
    reconfigure: Callable[[T], None] | None = None,
    defaults: Mapping[str, Any] | None = None,
) -> T:
    """Declare the parameters of a class and return their values.

    What is declared already keeps its value, so that a lifecycle node may do this whenever it is configured.

    Parameters
    ----------
    node : Node
        Whose parameters they are.
    kind : type
        Of parameters.
    prefix : str
        Put before the names, with a dot.
    reconfigure : callable or None
        Called with checked new values; it may raise `ParameterError` or another exception to
        refuse them. Without it all of them are read-only.
    defaults : mapping or None
        Defaults that are known only now, by name.

    Raises
    ------
    ParameterError
        When a given value is of the wrong type or not allowed; the message says where it was given.
    """
    if node not in _of_nodes:
        _of_nodes[node] = _NodeParameters()
        node.add_on_set_parameters_callback(partial(_on_set_parameters, _of_nodes[node]))
    before = f"{prefix}." if prefix else ""
    names: list[str] = []

    def get(leaf: Leaf) -> Any:
        names.append(leaf.name)
        if defaults is not None and leaf.name in defaults:
            leaf = with_changes(leaf, default=defaults[leaf.name])
        return _value(node, leaf, before, leaf.constraints.read_only or reconfigure is None)

    try:
        values = build(kind, get)
    except ParameterError as error:
        raise _located(node, f"{before}{error.name}", error.problem) from None
    _of_nodes[node].groups[prefix, kind] = _Group(before, values, frozenset(names), reconfigure)
    return values


def declare_one(node: Node, name: str, default: S, description: str, **constraints: Any) -> S:
    """Declare a read-only parameter whose name depends on others, and return its value.

    Parameters
    ----------
    node : Node
        Whose parameter it is.
    name : str
    default : bool, int, float or str
    description : str
    **constraints
        Of `Constraints`.

    Raises
    ------
    ParameterError
        When the given value is of the wrong type or not allowed.
    """
    leaf = Leaf(name, default, type(default), False, Constraints(description, read_only=True, **constraints))
    try:
        value: S = _value(node, leaf, "", read_only=True)
        leaf.check(value)
    except ParameterError as error:
        raise _located(node, name, error.problem) from None
    return value


def declare_name(node: Node, name: str, default: str, description: str) -> str:
    """Declare a read-only parameter that names a class or file, and return its value; see `declare_one`."""
    return declare_one(node, name, default, description, not_empty=True)


def given_below(node: Node, group: str) -> list[str]:
    """Return the names of given parameters below a group, without its name."""
    return [name.removeprefix(f"{group}.") for name in node._parameter_overrides if name.startswith(f"{group}.")]


def declare_given(node: Node, names: Collection[str] | None = None) -> None:
    """Declare the parameters that are given to a node and not declared, or those of some names among them."""
    given = [
        (name, one.value)
        for name, one in node._parameter_overrides.items()
        if not node.has_parameter(name) and (names is None or name in names)
    ]
    node.declare_parameters("", given, ignore_override=True)


def declare_without_effect(node: Node, reasons: Mapping[str, str]) -> None:
    """Declare those of some parameters that are given to a node, and name them once with why they have no effect.

    Parameters
    ----------
    node : Node
        Whose parameters they are.
    reasons : mapping
        Why a parameter has no effect, by its name.
    """
    from rcl_interfaces.msg import ParameterDescriptor

    named: dict[str, list[str]] = {}
    for name, reason in reasons.items():
        given = node._parameter_overrides.get(name)
        if given is not None and not node.has_parameter(name):
            descriptor = ParameterDescriptor(description=f"No effect: {reason}.")
            node.declare_parameter(name, given.value, descriptor, ignore_override=True)
            named.setdefault(reason, []).append(name)
    for reason, names in named.items():
        node.get_logger().info(f"without effect: {', '.join(names)}: {reason}")


def typed_value(node: Node, name: str, default: Any) -> Any:
    """Return the value of a parameter of any name, which has the type of a default; the default where it is not set.

    Raises
    ------
    ParameterError
        When it is of another type.
    """
    value = node.get_parameter(name).value if node.has_parameter(name) else None
    if value is None:
        return default
    is_array = isinstance(default, tuple)
    leaf = Leaf(name, default, str if is_array else type(default), is_array, Constraints(""))
    try:
        return leaf.typed([value] if is_array and isinstance(value, str) else value)
    except ParameterError as error:
        raise _located(node, name, error.problem) from None


def location_of(node: Node, name: str) -> Location:
    """Return where a parameter's value was given."""
    given = node._rcl_given.get(name)
    found = given.location if given is not None else Location()
    return Location(found.file, found.line, name)


def warn_of_undeclared(node: Node) -> None:
    """Warn of parameters that files and the command line give to a node, and that nothing declared.

    What is given to many nodes at once is only warned of where it is spelled nearly like a parameter of this node.
    """
    state = _of_nodes.get(node)
    if state is None:
        return
    unknown = [
        one
        for one in node._rcl_given.values()
        if not node.has_parameter(one.name) and one.name not in state.warned and not _is_for_all_nodes(one.name)
    ]
    missing = [name for name in node._parameters if name not in node._rcl_given]
    unused: dict[str, list[str]] = {}
    for one in unknown:
        is_shared = "*" in one.node
        found = get_close_matches(one.name, missing, 1, _LIKENESS_IN_SHARED_SECTIONS) if is_shared else None
        found = near(one.name, missing) if found is None else found
        if found:
            node.get_logger().warning(
                f"{one.location}: parameter '{one.name}' of {node.get_fully_qualified_name()} is not declared; "
                f"did you mean '{found[0]}'?"
            )
        elif not is_shared:
            line = f" (line {one.location.line})" if one.location.line is not None else ""
            unused.setdefault(str(one.location.file), []).append(f"{one.name}{line}")
    for file, names in unused.items():
        name = node.get_fully_qualified_name()
        node.get_logger().warning(
            f"{file}: parameters of {name} that are not declared and have no effect: {', '.join(names)}"
        )
    state.warned.update(one.name for one in unknown)


def descriptor_of(leaf: Leaf, read_only: bool = False) -> ParameterDescriptor:
    """Return a parameter's descriptor: type, range, and what it does, with the unit in brackets at the end."""
    from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor

    constraints = leaf.constraints
    descriptor = ParameterDescriptor(
        type=int((_ARRAYS if leaf.is_array else _SCALARS)[leaf.type].value),
        description=f"{constraints.description}{f' [{constraints.unit}]' if constraints.unit else ''}",
        additional_constraints=constraints.text,
        read_only=read_only or constraints.read_only,
    )
    if not constraints.is_bounded or leaf.is_array or not math.isfinite(leaf.default):
        return descriptor
    if constraints.text == Constraints("", minimum=constraints.minimum, maximum=constraints.maximum).text:
        descriptor.additional_constraints = ""  # the range says the same
    lows = [bound for bound in (constraints.minimum, constraints.above) if bound is not None]
    highs = [bound for bound in (constraints.maximum, constraints.below) if bound is not None]
    if leaf.type is int:
        low, high = (
            max((int(one) for one in lows), default=-_MAX_INTEGER - 1),
            min(map(int, highs), default=_MAX_INTEGER),
        )
        descriptor.integer_range = [IntegerRange(from_value=low, to_value=high, step=1)]
    else:
        low_value, high_value = float(max(lows, default=-math.inf)), float(min(highs, default=math.inf))
        descriptor.floating_point_range = [FloatingPointRange(from_value=low_value, to_value=high_value)]
    return descriptor


def _value(node: Node, leaf: Leaf, before: str, read_only: bool) -> Any:
    """Return a parameter's value, after declaring it where that was not done."""
    name = f"{before}{leaf.name}"
    if node.has_parameter(name):
        return leaf.typed(node.get_parameter(name).value, integers=False)
    given = node._parameter_overrides.get(name)
    value = leaf.default
    if given is not None:
        value = leaf.typed(given.value, integers=False)
        leaf.check(value)
    declared = list(value) if leaf.is_array else value
    node.declare_parameter(name, declared, descriptor_of(leaf, read_only), ignore_override=True)
    return value


def _located(node: Node, name: str, problem: str) -> ParameterError:
    given = node._rcl_given.get(name)
    text = f"of {node.get_fully_qualified_name()} {problem}"
    return ParameterError(name, text, given.location if given is not None else None)


def _on_set_parameters(state: _NodeParameters, parameters: list[Parameter[Any]]) -> SetParametersResult:
    """Check new values, all of them before any is passed on."""
    from rcl_interfaces.msg import SetParametersResult

    changed: list[tuple[_Group, Any]] = []
    for one in state.groups.values():
        changes = {
            parameter.name.removeprefix(one.prefix): parameter.value
            for parameter in parameters
            if parameter.name.startswith(one.prefix) and parameter.name.removeprefix(one.prefix) in one.names
        }
        if changes:
            try:
                changed.append((one, replace(one.values, changes)))
            except ParameterError as error:
                reason = str(ParameterError(f"{one.prefix}{error.name}", error.problem))
                return SetParametersResult(successful=False, reason=reason)
    for one, values in changed:
        try:
            if one.reconfigure is not None:
                one.reconfigure(values)
        except Exception as error:  # a plugin of the user's may raise anything
            return SetParametersResult(successful=False, reason=str(error) or type(error).__name__)
        one.values = values
    return SetParametersResult(successful=True)


def _is_for_all_nodes(name: str) -> bool:
    """Return whether a parameter is one that every node may be given, declared or not."""
    return name == "use_sim_time" or name.startswith(("qos_overrides.", "start_type_description_service"))
