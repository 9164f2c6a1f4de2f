"""Exceptions of the public interface."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rclpy.impl.errors import InvalidHandle as InvalidHandle

if TYPE_CHECKING:
    from rclpy.parameter import Parameter


class NotInitializedException(Exception):
    """rclpy was used before it was initialized."""

    def __init__(self, message: str | None = None) -> None:
        text = "rclpy.init() has not been called"
        super().__init__(f"{text}: {message}" if message else text)


class NoTypeSupportImportedException(Exception):
    """A message class lacks what is needed to send it."""

    def __init__(self) -> None:
        super().__init__("no type_support imported")


class NameValidationException(ValueError):
    """A name breaks ROS 2's rules."""

    def __init__(self, name_type: str, name: str, error_msg: str, invalid_index: int) -> None:
        text = f"Invalid {name_type}: {error_msg}:\n  '{name}'\n   {' ' * invalid_index}^"
        super().__init__(text)
        self.name_type = name_type
        self.name = name
        self.error_msg = error_msg
        self.invalid_index = invalid_index


class InvalidNamespaceException(NameValidationException):
    """A namespace breaks the rules."""

    def __init__(self, name: str, error_msg: str, invalid_index: int) -> None:
        super().__init__("namespace", name, error_msg, invalid_index)


class InvalidNodeNameException(NameValidationException):
    """A node name breaks the rules."""

    def __init__(self, name: str, error_msg: str, invalid_index: int) -> None:
        super().__init__("node name", name, error_msg, invalid_index)


class InvalidTopicNameException(NameValidationException):
    """A topic name breaks the rules."""

    def __init__(self, name: str, error_msg: str, invalid_index: int) -> None:
        super().__init__("topic name", name, error_msg, invalid_index)


class InvalidServiceNameException(NameValidationException):
    """A service name breaks the rules."""

    def __init__(self, name: str, error_msg: str, invalid_index: int) -> None:
        super().__init__("service name", name, error_msg, invalid_index)


class ParameterException(Exception):
    """Base of what goes wrong with parameters."""

    def __init__(self, error_msg: str, parameters: str | list[str] | tuple[str, ...]) -> None:
        super().__init__(f"{error_msg}: {parameters}")


class ParameterNotDeclaredException(ParameterException):
    """An undeclared parameter was used."""

    def __init__(self, parameters: str | list[str]) -> None:
        super().__init__("Invalid access to undeclared parameter(s)", parameters)


class ParameterAlreadyDeclaredException(ParameterException):
    """A parameter was declared twice."""

    def __init__(self, parameters: str | list[str]) -> None:
        super().__init__("Parameter(s) already declared", parameters)


class InvalidParameterException(ParameterException):
    """A parameter's name breaks the rules."""

    def __init__(self, parameter_name: str) -> None:
        super().__init__("Invalid parameter name", parameter_name)


class InvalidParameterTypeException(ParameterException):
    """A parameter has another type than was declared."""

    def __init__(self, desired_parameter: Parameter[Any], expected_type: Any) -> None:
        super().__init__(
            f"Trying to set parameter '{desired_parameter.name}' to '{desired_parameter.value}' of type "
            f"'{desired_parameter.type_.name}', expecting type '{getattr(expected_type, 'name', expected_type)}'",
            desired_parameter.name,
        )


class InvalidParameterValueException(ParameterException):
    """A parameter's value was refused."""

    def __init__(self, parameter: str, value: Any, reason: str) -> None:
        super().__init__(
            f"Invalid parameter value ({value}) for parameter. Reason: {reason}"
            if reason
            else f"Invalid parameter value ({value}) for parameter",
            parameter,
        )


class ParameterImmutableException(ParameterException):
    """A read-only parameter was set or undeclared."""

    def __init__(self, parameter_name: str) -> None:
        super().__init__("Attempted to modify read-only parameter", parameter_name)


class ParameterUninitializedException(ParameterException):
    """A statically typed parameter was read before it had a value."""

    def __init__(self, parameter_name: str) -> None:
        super().__init__("The parameter is not initialized", parameter_name)


class ExternalShutdownException(Exception):
    """The context was shut down, for instance by Ctrl-C."""

    def __init__(self) -> None:
        super().__init__("The context was shut down")


class TimeSourceChangedError(RuntimeError):
    """A simulator began or ceased to give the time while somebody slept."""

    def __init__(self) -> None:
        super().__init__("The source of time has changed")


class ROSInterruptException(Exception):
    """A wait was ended by a shutdown."""

    def __init__(self) -> None:
        super().__init__("rclpy.shutdown() has been called")
