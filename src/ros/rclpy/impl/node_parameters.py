"""The parameters of a node: declaring, getting and describing them."""

from __future__ import annotations

import copy
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from rclpy.exceptions import (
    InvalidParameterValueException,
    ParameterAlreadyDeclaredException,
    ParameterImmutableException,
    ParameterNotDeclaredException,
    ParameterUninitializedException,
)
from rclpy.impl.node_parameter_setting import NodeParameterSetting
from rclpy.impl.parameter_checks import REL_TOL, check_value
from rclpy.impl.parameter_declaration import initial, overridden, unpacked
from rclpy.parameter import PARAMETER_SEPARATOR_STRING, Parameter, ParameterType
from rclpy.validate_parameter_name import validate_parameter_name

if TYPE_CHECKING:
    from rcl_interfaces.msg import ListParametersResult, ParameterDescriptor


class NodeParameters(NodeParameterSetting):
    """The part of `Node` that has to do with parameters."""

    PARAM_REL_TOL = REL_TOL
    _parameter_overrides: dict[str, Parameter[Any]]

    def _rcl_init_parameters(self, overrides: dict[str, Parameter[Any]], allow_undeclared: bool) -> None:
        self._parameters = {}
        self._descriptors = {}
        self._parameter_overrides = overrides
        self._allow_undeclared_parameters = allow_undeclared
        self._pre_set_parameters_callbacks = []
        self._on_set_parameters_callbacks = []
        self._post_set_parameters_callbacks = []

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
            When an entry is not one of these.
        ValueError, ParameterException
            As in `declare_parameter`.
        """
        declared: list[Parameter[Any]] = []
        taken: list[str] = []
        descriptors: dict[str, ParameterDescriptor] = {}
        for index, entry in enumerate(parameters):
            name, value, descriptor = unpacked(index, entry)
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
                parameter = overridden(Parameter(name, override.type_, override.value), value, descriptor)
            else:
                parameter = initial(name, value, descriptor)
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
            result = check_value(parameter, descriptor)
            if result.successful:
                result = self._rcl_ask_callbacks([parameter])
            if not result.successful:
                raise InvalidParameterValueException(parameter.name, parameter.value, result.reason)
            self._rcl_store(parameter, descriptor)
        self._rcl_report_set(
            [parameter for parameter in declared if parameter.type_ != ParameterType.NOT_SET], new=declared
        )

    def _rcl_store(self, parameter: Parameter[Any], descriptor: ParameterDescriptor) -> None:
        self._parameters[parameter.name] = parameter
        self._descriptors[parameter.name] = descriptor

    def undeclare_parameter(self, name: str) -> None:
        """Remove a parameter.

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
        """Return whether a parameter was declared."""
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

            if not check_value(current, fresh).successful:
                current = Parameter.from_parameter_msg(ParameterMsg(name=name, value=alternative_value))
        result = check_value(current, fresh)
        if result.successful and current is not self._parameters[name]:
            result = self._rcl_ask_callbacks([current])
        if not result.successful:
            raise InvalidParameterValueException(name, current.value, result.reason)
        self._descriptors[name] = fresh
        if current is not self._parameters[name]:
            self._rcl_commit([current])
        return current.get_parameter_value()


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
