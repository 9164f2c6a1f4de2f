"""Parameters: a name with a typed value."""

from __future__ import annotations

import array
from collections.abc import Sequence
from enum import IntEnum
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from rclpy.impl.lazy_reexport import lazy_reexport

if TYPE_CHECKING:
    from rcl_interfaces.msg import Parameter as ParameterMsg
    from rcl_interfaces.msg import ParameterValue

PARAMETER_SEPARATOR_STRING = "."
_INTEGER_TYPECODES = "bBhHiIlLqQ"

T = TypeVar("T")


class ParameterType(IntEnum):
    """Types of parameters, with the values of ``rcl_interfaces/msg/ParameterType``."""

    NOT_SET = 0
    BOOL = 1
    INTEGER = 2
    DOUBLE = 3
    STRING = 4
    BYTE_ARRAY = 5
    BOOL_ARRAY = 6
    INTEGER_ARRAY = 7
    DOUBLE_ARRAY = 8
    STRING_ARRAY = 9

    @classmethod
    def from_parameter_value(cls, parameter_value: Any) -> ParameterType:
        """Return the type of a Python value.

        Raises
        ------
        TypeError
            When no parameter can hold it.
        """
        if parameter_value is None:
            return cls.NOT_SET
        for kind, name in ((bool, "BOOL"), (int, "INTEGER"), (float, "DOUBLE"), (str, "STRING")):
            if isinstance(parameter_value, kind):
                return cls[name]
        if isinstance(parameter_value, (list, tuple, array.array)):
            return cls._of_sequence(parameter_value)
        raise TypeError(
            f"The given value is not one of the allowed types '{parameter_value}': bool, int, float, str, "
            "or a list of one of these or of bytes"
        )

    @classmethod
    def _of_sequence(cls, values: Any) -> ParameterType:
        if isinstance(values, array.array):
            return cls.INTEGER_ARRAY if values.typecode in _INTEGER_TYPECODES else cls.DOUBLE_ARRAY
        for kind, name in (
            (bytes, "BYTE_ARRAY"), (bool, "BOOL_ARRAY"), (int, "INTEGER_ARRAY"), (float, "DOUBLE_ARRAY"),
            (str, "STRING_ARRAY"),
        ):  # fmt: skip
            if all(isinstance(value, kind) for value in values):
                return cls[name]
        raise TypeError(f"The given value is not a list of one of the allowed types '{values}'.")

    def check(self, parameter_value: Any) -> bool:
        """Return whether a value is of this type; an empty list is of every list type."""
        if isinstance(parameter_value, (list, tuple, array.array)) and len(parameter_value) == 0:
            return self >= ParameterType.BYTE_ARRAY
        try:
            return self == ParameterType.from_parameter_value(parameter_value)
        except TypeError:
            return False


_FIELDS = {
    ParameterType.BOOL: "bool_value",
    ParameterType.INTEGER: "integer_value",
    ParameterType.DOUBLE: "double_value",
    ParameterType.STRING: "string_value",
    ParameterType.BYTE_ARRAY: "byte_array_value",
    ParameterType.BOOL_ARRAY: "bool_array_value",
    ParameterType.INTEGER_ARRAY: "integer_array_value",
    ParameterType.DOUBLE_ARRAY: "double_array_value",
    ParameterType.STRING_ARRAY: "string_array_value",
}


class Parameter(Generic[T]):
    """A parameter.

    Parameters
    ----------
    name
        Its name.
    type_
        Its type; taken from the value where None.
    value
        Its value.

    Raises
    ------
    TypeError
        When `type_` is not a parameter type, or no parameter can hold the value.
    ValueError
        When type and value do not agree.
    """

    Type = ParameterType
    STANDS_FOR = "rcl_interfaces/msg/Parameter"

    def __init__(self, name: str, type_: ParameterType | None = None, value: Any = None) -> None:
        if type_ is None:
            type_ = ParameterType.from_parameter_value(value)
        if not isinstance(type_, ParameterType):
            raise TypeError(f"type must be an instance of '{ParameterType!r}'")
        if not type_.check(value):
            raise ValueError(f"Type '{type_}' and value '{value}' do not agree")
        self._type_ = type_
        self._name = name
        self._value = value

    @classmethod
    def from_parameter_msg(cls, param_msg: ParameterMsg) -> Parameter[Any]:
        """Return the parameter that a message holds.

        Raises
        ------
        TypeError
            When the message states a type that does not exist.
        """
        try:
            kind = ParameterType(param_msg.value.type)
        except ValueError:
            raise TypeError(f"type_ of '{param_msg.value.type}' cannot be handled") from None
        return cls(param_msg.name, kind, parameter_value_to_python(param_msg.value))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Parameter):
            return False
        return (self.name, self.type_, self.value) == (other.name, other.type_, other.value)

    def __hash__(self) -> int:
        return hash((self.name, self.type_))

    def __repr__(self) -> str:
        return f"Parameter(name={self._name!r}, type={self._type_.name}, value={self._value!r})"

    @property
    def name(self) -> str:
        """Its name."""
        return self._name

    @property
    def type_(self) -> ParameterType:
        """Its type."""
        return self._type_

    @property
    def value(self) -> Any:
        """Its value."""
        return self._value

    def get_parameter_value(self) -> ParameterValue:
        """Return the value as a ``rcl_interfaces/msg/ParameterValue``."""
        from rcl_interfaces.msg import ParameterValue

        message = ParameterValue(type=int(self._type_))
        field = _FIELDS.get(self._type_)
        if field:
            setattr(message, field, self._value)
        return message

    def to_parameter_msg(self) -> ParameterMsg:
        """Return the parameter as a ``rcl_interfaces/msg/Parameter``."""
        from rcl_interfaces.msg import Parameter as ParameterMsg

        return ParameterMsg(name=self._name, value=self.get_parameter_value())


def get_parameter_value(string_value: str) -> ParameterValue:
    """Return the value that YAML text, such as ``[1, 2]``, means; text that means nothing else is a string."""
    from rclpy.impl.parameter_file import parse_value

    try:
        value = parse_value(string_value) if string_value.strip() else string_value
        return Parameter("_", value=value).get_parameter_value()
    except (ValueError, TypeError):
        return Parameter("_", value=string_value).get_parameter_value()


def parameter_value_to_python(parameter_value: ParameterValue) -> Any:
    """Return the Python value that a message holds.

    Raises
    ------
    RuntimeError
        When it states a type that does not exist.
    """
    if parameter_value.type == ParameterType.NOT_SET:
        return None
    try:
        value = getattr(parameter_value, _FIELDS[ParameterType(parameter_value.type)])
    except (ValueError, KeyError):
        raise RuntimeError(f"unexpected parameter type {parameter_value.type}") from None
    return value.tolist() if isinstance(value, array.array) else value


def parameter_dict_from_yaml_file(
    parameter_file: str,
    use_wildcard: bool = False,
    target_nodes: list[str] | None = None,
    namespace: str = "",
) -> dict[str, ParameterMsg]:
    """Read a parameter file.

    Parameters
    ----------
    parameter_file
        Its path.
    use_wildcard
        Whether names with ``*`` in the file mean the target nodes too.
    target_nodes
        Full names of the nodes whose parameters are wanted; all of them where None.
    namespace
        Put before every name in the result.

    Returns
    -------
    dict
        ``rcl_interfaces/msg/Parameter`` by parameter name.

    Raises
    ------
    OSError
        When the file cannot be opened.
    RuntimeError
        When the file holds nothing for the targets, or no parameters.
    """
    from rclpy.impl.parameter_file import ParameterFileError, read_file

    with open(parameter_file, "rb"):
        """Raises OSError."""
    try:
        entries = read_file(parameter_file)
    except ParameterFileError as error:
        raise RuntimeError(f"{parameter_file}: {error}") from None
    targets = [name if name.startswith("/") else f"/{name}" for name in target_nodes or ()]
    found: dict[str, Any] = {}
    for wildcards in (True, False):  # what is said of a node by its name outweighs wildcards
        found |= {
            name: value
            for node, name, value, _ in entries
            if ("*" in node) is wildcards and _is_wanted(node, targets, use_wildcard)
        }
    if targets and not found and not any(_is_wanted(node, targets, use_wildcard) for node, *_ in entries):
        raise RuntimeError(f"Param file does not contain any valid parameters for {', '.join(targets)}")
    prefix = f"{namespace}{PARAMETER_SEPARATOR_STRING}" if namespace else ""
    return {prefix + name: Parameter(prefix + name, value=value).to_parameter_msg() for name, value in found.items()}


def _is_wanted(node: str, targets: Sequence[str], use_wildcard: bool) -> bool:
    from rclpy.impl.parameter_file import node_matches

    if "*" in node:
        return use_wildcard and (not targets or any(node_matches(node, target) for target in targets))
    return not targets or any(node_matches(node, target) for target in targets)


if not TYPE_CHECKING:
    __getattr__ = lazy_reexport(__name__, {"rcl_interfaces.msg": ("ParameterValue",)})
