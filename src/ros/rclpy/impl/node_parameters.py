"""The parameters of a node: declaring, setting, describing, and telling of changes."""

from __future__ import annotations

import copy
import math
import warnings
from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Any

from rclpy.exceptions import (
    InvalidParameterTypeException,
    InvalidParameterValueException,
    ParameterAlreadyDeclaredException,
    ParameterImmutableException,
    ParameterNotDeclaredException,
    ParameterUninitializedException,
)
from rclpy.parameter import PARAMETER_SEPARATOR_STRING, Parameter, ParameterType, parameter_value_to_python
from rclpy.validate_parameter_name import validate_parameter_name

if TYPE_CHECKING:
    from rcl_interfaces.msg import ListParametersResult, ParameterDescriptor, SetParametersResult

_REL_TOL = 1e-6
PreSet = Callable[[list[Parameter[Any]]], list[Parameter[Any]]]
OnSet = Callable[[list[Parameter[Any]]], "SetParametersResult"]
PostSet = Callable[[list[Parameter[Any]]], None]


class NodeParameters:
    """The part of `Node` that has to do with parameters."""

    PARAM_REL_TOL = _REL_TOL
    _parameters: dict[str, Parameter[Any]]
    _descriptors: dict[str, ParameterDescriptor]
    _parameter_overrides: dict[str, Parameter[Any]]
    _allow_undeclared_parameters: bool
    _pre_set_parameters_callbacks: list[PreSet]
    _on_set_parameters_callbacks: list[OnSet]
    _post_set_parameters_callbacks: list[PostSet]

    def _rcl_init_parameters(self, overrides: dict[str, Parameter[Any]], allow_undeclared: bool) -> None:
        self._parameters = {}
        self._descriptors = {}
        self._parameter_overrides = overrides
        self._allow_undeclared_parameters = allow_undeclared
        self._pre_set_parameters_callbacks = []
        self._on_set_parameters_callbacks = []
        self._post_set_parameters_callbacks = []

    def _rcl_publish_parameter_event(
        self, new: list[Parameter[Any]], changed: list[Parameter[Any]], deleted: list[Parameter[Any]]
    ) -> None:
        raise NotImplementedError

    # Declaring.

    def declare_parameter(
        self,
        name: str,
        value: Any = None,
        descriptor: ParameterDescriptor | None = None,
        ignore_override: bool = False,
    ) -> Parameter[Any]:
        """Declare a parameter.

        Parameters
        ----------
        name
            Its name.
        value
            Its initial value, or a `Parameter.Type` for a parameter without one.
        descriptor
            What is known of it: description, range, whether it is read-only or of changing type.
        ignore_override
            Whether a value from the command line or a file is to be ignored.

        Raises
        ------
        ParameterAlreadyDeclaredException, InvalidParameterException, InvalidParameterValueException,
        InvalidParameterTypeException, ValueError
            When it cannot be declared so.
        """
        from rcl_interfaces.msg import ParameterDescriptor

        entry = (name,) if value is None and descriptor is None else (name, value, descriptor or ParameterDescriptor())
        return self.declare_parameters("", [entry], ignore_override)[0]

    def declare_parameters(
        self,
        namespace: str,
        parameters: Sequence[tuple[Any, ...]],
        ignore_override: bool = False,
    ) -> list[Parameter[Any]]:
        """Declare several parameters, given as (name,), (name, value) or (name, value, descriptor).

        Raises
        ------
        TypeError
            When an entry is none of these.
        ValueError, ParameterException
            As in `declare_parameter`.
        """
        declared: list[Parameter[Any]] = []
        taken: list[str] = []
        descriptors: dict[str, ParameterDescriptor] = {}
        for index, entry in enumerate(parameters):
            name, value, descriptor = _unpacked(index, entry)
            bare = name
            if namespace:
                name = f"{namespace}{PARAMETER_SEPARATOR_STRING}{name}"
            validate_parameter_name(name)
            if name in self._descriptors:
                taken.append(name)
                continue
            overrides = self._parameter_overrides
            override = overrides.get(name) or overrides.get(bare)  # the bare name serves too, as in ROS 2
            if override is not None and not ignore_override:
                parameter = _overridden(Parameter(name, override.type_, override.value), value, descriptor)
            else:
                parameter = _initial(name, value, descriptor)
            declared.append(parameter)
            descriptors[name] = descriptor
        if taken:
            raise ParameterAlreadyDeclaredException(taken)
        self._rcl_set_declared(declared, descriptors)
        return [self._parameters[parameter.name] for parameter in declared]

    def _rcl_set_declared(self, declared: list[Parameter[Any]], descriptors: dict[str, ParameterDescriptor]) -> None:
        for parameter in declared:
            descriptor = descriptors[parameter.name]
            descriptor.name = parameter.name
            if parameter.type_ == ParameterType.NOT_SET:
                self._rcl_store(parameter, descriptor)
                continue
            result = self._rcl_check_value(parameter, descriptor)
            if result.successful:
                result = self._rcl_ask_callbacks([parameter])
            if not result.successful:
                raise InvalidParameterValueException(parameter.name, parameter.value, result.reason)
            self._rcl_store(parameter, descriptor)
        self._rcl_tell_set(
            [parameter for parameter in declared if parameter.type_ != ParameterType.NOT_SET], new=declared
        )

    def _rcl_store(self, parameter: Parameter[Any], descriptor: ParameterDescriptor) -> None:
        self._parameters[parameter.name] = parameter
        self._descriptors[parameter.name] = descriptor

    def undeclare_parameter(self, name: str) -> None:
        """Forget a parameter.

        Raises
        ------
        ParameterNotDeclaredException
            When it was not declared.
        ParameterImmutableException
            When it is read-only.
        """
        if name not in self._parameters:
            raise ParameterNotDeclaredException(name)
        if self._descriptors[name].read_only:
            raise ParameterImmutableException(name)
        del self._parameters[name]
        del self._descriptors[name]

    # Getting.

    def has_parameter(self, name: str) -> bool:
        """Tell whether a parameter was declared."""
        return name in self._parameters

    def get_parameter_types(self, names: list[str]) -> list[ParameterType]:
        """Return the types of parameters; see `get_parameter_type`."""
        if not all(isinstance(name, str) for name in names):
            raise TypeError("All names must be instances of type str")
        return [self.get_parameter_type(name) for name in names]

    def get_parameter_type(self, name: str) -> ParameterType:
        """Return a parameter's type.

        Raises
        ------
        ParameterNotDeclaredException
            When it was not declared and undeclared ones are not allowed.
        """
        if name in self._parameters:
            return self._parameters[name].type_
        if self._allow_undeclared_parameters:
            return ParameterType.NOT_SET
        raise ParameterNotDeclaredException(name)

    def get_parameters(self, names: list[str]) -> list[Parameter[Any]]:
        """Return parameters; see `get_parameter`."""
        if not all(isinstance(name, str) for name in names):
            raise TypeError("All names must be instances of type str")
        return [self.get_parameter(name) for name in names]

    def get_parameter(self, name: str) -> Parameter[Any]:
        """Return a parameter.

        Raises
        ------
        ParameterNotDeclaredException
            When it was not declared and undeclared ones are not allowed.
        ParameterUninitializedException
            When its type is fixed and it has no value yet.
        """
        parameter = self._parameters.get(name)
        if parameter is None:
            if self._allow_undeclared_parameters:
                return Parameter(name, ParameterType.NOT_SET, None)
            raise ParameterNotDeclaredException(name)
        if parameter.type_ == ParameterType.NOT_SET and not self._descriptors[name].dynamic_typing:
            raise ParameterUninitializedException(name)
        return parameter

    def get_parameter_or(self, name: str, alternative_value: Parameter[Any] | None = None) -> Parameter[Any]:
        """Return a parameter, or `alternative_value` when it was not declared or has no value."""
        if alternative_value is None:
            alternative_value = Parameter(name, ParameterType.NOT_SET)
        if not self.has_parameter(name) or self._parameters[name].type_ == ParameterType.NOT_SET:
            return alternative_value
        return self._parameters[name]

    def get_parameters_by_prefix(self, prefix: str) -> dict[str, Parameter[Any]]:
        """Return the parameters below a prefix, by the rest of their names."""
        start = f"{prefix}{PARAMETER_SEPARATOR_STRING}" if prefix else ""
        return {
            name.removeprefix(start): parameter
            for name, parameter in self._parameters.items()
            if name.startswith(start)
        }

    def list_parameters(self, prefixes: list[str], depth: int) -> ListParametersResult:
        """Return the names of parameters below prefixes, and the prefixes that occur among them.

        Parameters
        ----------
        prefixes
            All parameters where empty.
        depth
            How many further parts a name may have; 0 for any number.

        Raises
        ------
        TypeError, ValueError
            For prefixes that are no strings, and a negative depth.
        """
        from rcl_interfaces.msg import ListParametersResult
        from rcl_interfaces.srv import ListParameters

        if not isinstance(prefixes, list) or not all(isinstance(prefix, str) for prefix in prefixes):
            raise TypeError("The prefixes argument must be a list of strings")
        if not isinstance(depth, int):
            raise TypeError("The depth must be an integer")
        if depth < 0:
            raise ValueError("The depth must be greater than or equal to zero")
        recursive = depth == ListParameters.Request.DEPTH_RECURSIVE
        result = ListParametersResult()
        for name in self._parameters:
            if not _is_listed(name, prefixes, depth, recursive):
                continue
            result.names.append(name)
            prefix = name.rpartition(PARAMETER_SEPARATOR_STRING)[0]
            if prefix and prefix not in result.prefixes:
                result.prefixes.append(prefix)
        return result

    # Setting.

    def set_parameters(self, parameter_list: list[Parameter[Any]]) -> list[SetParametersResult]:
        """Set parameters one by one.

        Returns
        -------
        list of rcl_interfaces/msg/SetParametersResult
            Whether each was set, and if not, why.

        Raises
        ------
        ParameterNotDeclaredException
            When one was not declared and undeclared ones are not allowed; those before it are set.
        """
        results = []
        for parameter in parameter_list:
            self._rcl_check_declared([parameter])
            results.append(self._rcl_set_checked([parameter]))
        return results

    def set_parameters_atomically(self, parameter_list: list[Parameter[Any]]) -> SetParametersResult:
        """Set all of the parameters or none; see `set_parameters`."""
        self._rcl_check_declared(parameter_list)
        return self._rcl_set_checked(parameter_list)

    def _rcl_check_declared(self, parameters: Iterable[Parameter[Any]]) -> None:
        for parameter in parameters:
            if not isinstance(parameter, Parameter):
                raise TypeError("parameter must be instance of type 'rclpy.parameter.Parameter'")
        missing = [parameter.name for parameter in parameters if parameter.name not in self._parameters]
        if missing and not self._allow_undeclared_parameters:
            raise ParameterNotDeclaredException(missing)

    def _rcl_set_checked(self, parameters: list[Parameter[Any]]) -> SetParametersResult:
        from rcl_interfaces.msg import ParameterDescriptor, SetParametersResult

        for callback in self._pre_set_parameters_callbacks:
            modified = callback(parameters)
            if not modified:
                return SetParametersResult(
                    successful=False,
                    reason="parameter list cannot be empty, this might be due to pre_set_parameters_callback "
                    "modifying the original parameters list.",
                )
            parameters = modified
        for parameter in parameters:
            descriptor = self._descriptors.get(parameter.name) or ParameterDescriptor(dynamic_typing=True)
            result = self._rcl_check_change(parameter, descriptor)
            if not result.successful:
                return result
        result = self._rcl_ask_callbacks(parameters)
        if result.successful:
            self._rcl_commit(parameters)
        return result

    def _rcl_check_change(self, parameter: Parameter[Any], descriptor: ParameterDescriptor) -> SetParametersResult:
        from rcl_interfaces.msg import SetParametersResult

        if descriptor.read_only:
            return SetParametersResult(successful=False, reason=str(ParameterImmutableException(parameter.name)))
        if parameter.type_ == ParameterType.NOT_SET and not descriptor.dynamic_typing:
            return SetParametersResult(successful=False, reason="Static parameter cannot be undeclared")
        return self._rcl_check_value(parameter, descriptor)

    def _rcl_check_value(self, parameter: Parameter[Any], descriptor: ParameterDescriptor) -> SetParametersResult:
        from rcl_interfaces.msg import SetParametersResult

        expected = ParameterType(descriptor.type)
        if parameter.type_ == ParameterType.NOT_SET:
            return SetParametersResult(successful=True)
        if not descriptor.dynamic_typing and expected not in (ParameterType.NOT_SET, parameter.type_):
            reason = f"Wrong parameter type, expected 'Type.{expected.name}' got 'Type.{parameter.type_.name}'"
            return SetParametersResult(successful=False, reason=reason)
        reason = ""
        if parameter.type_ == ParameterType.INTEGER and descriptor.integer_range:
            reason = _integer_fault(parameter, descriptor.integer_range[0])
        elif parameter.type_ == ParameterType.DOUBLE and descriptor.floating_point_range:
            reason = _float_fault(parameter, descriptor.floating_point_range[0])
        return SetParametersResult(successful=not reason, reason=reason)

    def _rcl_ask_callbacks(self, parameters: list[Parameter[Any]]) -> SetParametersResult:
        from rcl_interfaces.msg import SetParametersResult

        for callback in self._on_set_parameters_callbacks:
            result = callback(parameters)
            if not result.successful:
                return result
        return SetParametersResult(successful=True)

    def _rcl_commit(self, parameters: list[Parameter[Any]]) -> None:
        from rcl_interfaces.msg import ParameterDescriptor

        new, changed, deleted = [], [], []
        for parameter in parameters:
            if parameter.type_ == ParameterType.NOT_SET:
                if parameter.name in self._parameters:
                    deleted.append(self._parameters.pop(parameter.name))
                    self._descriptors.pop(parameter.name)
                continue
            known = parameter.name in self._parameters
            was_set = known and self._parameters[parameter.name].type_ != ParameterType.NOT_SET
            (changed if was_set else new).append(parameter)
            self._parameters[parameter.name] = parameter
            if not known:
                self._descriptors[parameter.name] = ParameterDescriptor(name=parameter.name, dynamic_typing=True)
        self._rcl_publish_parameter_event(new, changed, deleted)
        for callback in self._post_set_parameters_callbacks:
            callback(parameters)

    def _rcl_tell_set(self, parameters: list[Parameter[Any]], new: list[Parameter[Any]]) -> None:
        self._rcl_publish_parameter_event([one for one in new if one.type_ != ParameterType.NOT_SET], [], [])
        if parameters:
            for callback in self._post_set_parameters_callbacks:
                callback(parameters)

    # Callbacks.

    def add_pre_set_parameters_callback(self, callback: PreSet) -> None:
        """Call ``callback(parameters) -> parameters`` before parameters are checked; it may change the list."""
        self._pre_set_parameters_callbacks.insert(0, callback)

    def add_on_set_parameters_callback(self, callback: OnSet) -> None:
        """Call ``callback(parameters) -> SetParametersResult`` before parameters are set; it may refuse."""
        self._on_set_parameters_callbacks.insert(0, callback)

    def add_post_set_parameters_callback(self, callback: PostSet) -> None:
        """Call ``callback(parameters)`` after parameters were set."""
        self._post_set_parameters_callbacks.insert(0, callback)

    def remove_pre_set_parameters_callback(self, callback: PreSet) -> None:
        """Undo `add_pre_set_parameters_callback`; ValueError when it was not added."""
        self._pre_set_parameters_callbacks.remove(callback)

    def remove_on_set_parameters_callback(self, callback: OnSet) -> None:
        """Undo `add_on_set_parameters_callback`; ValueError when it was not added."""
        self._on_set_parameters_callbacks.remove(callback)

    def remove_post_set_parameters_callback(self, callback: PostSet) -> None:
        """Undo `add_post_set_parameters_callback`; ValueError when it was not added."""
        self._post_set_parameters_callbacks.remove(callback)

    # Describing.

    def describe_parameter(self, name: str) -> ParameterDescriptor:
        """Return what is known of a parameter.

        Raises
        ------
        ParameterNotDeclaredException
            When it was not declared and undeclared ones are not allowed.
        """
        from rcl_interfaces.msg import ParameterDescriptor

        if name in self._descriptors:
            return self._descriptors[name]
        if self._allow_undeclared_parameters:
            return ParameterDescriptor()
        raise ParameterNotDeclaredException(name)

    def describe_parameters(self, names: list[str]) -> list[ParameterDescriptor]:
        """Return what is known of parameters; see `describe_parameter`."""
        return [self.describe_parameter(name) for name in names]

    def set_descriptor(self, name: str, descriptor: ParameterDescriptor, alternative_value: Any = None) -> Any:
        """Replace what is known of a parameter.

        Parameters
        ----------
        name
            Its name.
        descriptor
            The new descriptor.
        alternative_value
            A ``ParameterValue`` to set if the present one does not fit the new descriptor.

        Returns
        -------
        rcl_interfaces/msg/ParameterValue
            The parameter's value.

        Raises
        ------
        ParameterNotDeclaredException
            When it was not declared and undeclared ones are not allowed.
        ParameterImmutableException
            When it is read-only.
        InvalidParameterValueException
            When neither value fits the new descriptor.
        """
        if name not in self._descriptors:
            if self._allow_undeclared_parameters:
                return self.get_parameter(name).get_parameter_value()
            raise ParameterNotDeclaredException(name)
        if self._descriptors[name].read_only:
            raise ParameterImmutableException(name)
        current = self._parameters[name]
        fresh = copy.deepcopy(descriptor)
        fresh.name = name
        fresh.type = int(current.type_)
        if alternative_value is not None:
            from rcl_interfaces.msg import Parameter as ParameterMsg

            if not self._rcl_check_value(current, fresh).successful:
                current = Parameter.from_parameter_msg(ParameterMsg(name=name, value=alternative_value))
        result = self._rcl_check_value(current, fresh)
        if result.successful and current is not self._parameters[name]:
            result = self._rcl_ask_callbacks([current])
        if not result.successful:
            raise InvalidParameterValueException(name, current.value, result.reason)
        self._descriptors[name] = fresh
        if current is not self._parameters[name]:
            self._rcl_commit([current])
        return current.get_parameter_value()


def _unpacked(index: int, entry: Any) -> tuple[str, Any, Any]:
    """Return (name, value, descriptor) of a declaration."""
    from rcl_interfaces.msg import ParameterDescriptor

    if not isinstance(entry, tuple) or not 1 <= len(entry) <= 3:
        raise TypeError(
            f"Invalid parameter tuple length at index {index} in parameters list: {entry}; expecting 1 to 3"
        )
    name = entry[0]
    if not isinstance(name, str):
        raise TypeError(f"First element {name} at index {index} in parameters list is not a str.")
    value = entry[1] if len(entry) > 1 else None
    is_message = type(value).__name__ == "ParameterValue"
    if is_message:
        value = parameter_value_to_python(value)
    descriptor = copy.deepcopy(entry[2]) if len(entry) > 2 else None
    if descriptor is None:
        descriptor = ParameterDescriptor(dynamic_typing=value is None)
    if not isinstance(descriptor, ParameterDescriptor):
        raise TypeError(f"Third element {descriptor} at index {index} in parameters list is not a ParameterDescriptor.")
    if is_message and value is None and not descriptor.dynamic_typing:
        raise ValueError(f"Cannot declare the statically typed parameter '{name}' with a value that is not set")
    if len(entry) == 1:
        warnings.warn(
            f"Parameter '{name}' is declared by its name alone, which is deprecated: give it a default value, a type, "
            "or a descriptor with dynamic_typing=True",
            stacklevel=4,
        )
    return name, value, descriptor


def _initial(name: str, value: Any, descriptor: ParameterDescriptor) -> Parameter[Any]:
    """Return a declared parameter with its initial value; notes its type in the descriptor."""
    if isinstance(value, ParameterType):
        if value == ParameterType.NOT_SET:
            raise ValueError(f"Cannot declare parameter '{name}' as statically typed of type NOT_SET")
        if descriptor.dynamic_typing:
            raise ValueError("When declaring a parameter with a type, it cannot be of dynamic typing")
        descriptor.type = int(value)
        return Parameter(name, ParameterType.NOT_SET)
    if value is None and not descriptor.dynamic_typing and descriptor.type == ParameterType.NOT_SET:
        raise ValueError(
            f"Parameter '{name}' has neither a value nor a type; give one or set dynamic_typing in its descriptor"
        )
    parameter: Parameter[Any] = Parameter(name, value=value)
    if value is not None:
        if isinstance(value, (list, tuple)) and not value and descriptor.type >= ParameterType.BYTE_ARRAY:
            return Parameter(name, ParameterType(descriptor.type), value)
        descriptor.type = int(parameter.type_)
    return parameter


def _overridden(override: Parameter[Any], value: Any, descriptor: ParameterDescriptor) -> Parameter[Any]:
    """Return a declared parameter with a value from outside; notes its type in the descriptor."""
    if descriptor.dynamic_typing:
        return override
    expected = value if isinstance(value, ParameterType) else ParameterType.from_parameter_value(value)
    if expected == ParameterType.NOT_SET:
        expected = ParameterType(descriptor.type)
    override = _fitting(override, expected)
    descriptor.type = int(expected if expected != ParameterType.NOT_SET else override.type_)
    return override


def _fitting(parameter: Parameter[Any], expected: ParameterType) -> Parameter[Any]:
    """Return an override as the type that was declared.

    Raises
    ------
    InvalidParameterTypeException
        When it is of another type.
    """
    if expected in (ParameterType.NOT_SET, parameter.type_):
        return parameter
    if isinstance(parameter.value, (list, tuple)) and not parameter.value and expected >= ParameterType.BYTE_ARRAY:
        return Parameter(parameter.name, expected, parameter.value)
    raise InvalidParameterTypeException(parameter, expected)


def _is_listed(name: str, prefixes: list[str], depth: int, recursive: bool) -> bool:
    separator = PARAMETER_SEPARATOR_STRING
    if not prefixes:
        return recursive or name.count(separator) < depth
    for prefix in prefixes:
        if name == prefix:
            return True
        start = f"{prefix}{separator}"
        if name.startswith(start) and (recursive or name[len(start) :].count(separator) < depth):
            return True
    return False


def _integer_fault(parameter: Parameter[Any], allowed: Any) -> str:
    low, high = sorted((allowed.from_value, allowed.to_value))
    value = parameter.value
    if value in (low, high):
        return ""
    if not low < value < high:
        return f"Parameter {parameter.name} out of range. Min: {low}, Max: {high}, value: {value}"
    if allowed.step and (value - low) % allowed.step:
        return (
            f"The parameter value for {parameter.name} is not a valid step. Min: {low}, max: {high}, "
            f"value: {value}, step: {allowed.step}"
        )
    return ""


def _float_fault(parameter: Parameter[Any], allowed: Any) -> str:
    low, high = sorted((allowed.from_value, allowed.to_value))
    value = parameter.value
    if any(math.isclose(value, edge, rel_tol=_REL_TOL) for edge in (low, high)):
        return ""
    if not low < value < high:
        return f"Parameter {parameter.name} out of range Min: {low}, Max: {high}, value: {value}"
    if allowed.step:
        nearest = low + round((value - low) / allowed.step) * allowed.step
        if not math.isclose(value, nearest, rel_tol=_REL_TOL):
            return (
                f"The parameter value for {parameter.name} is not close enough to a valid step. Min: {low}, "
                f"max: {high}, value: {value}, step: {allowed.step}"
            )
    return ""
