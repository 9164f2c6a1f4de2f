"""Setting a node's parameters, with the callbacks before and afterwards."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

from rclpy.exceptions import ParameterNotDeclaredException
from rclpy.impl.parameter_checks import check_change
from rclpy.parameter import Parameter, ParameterType

if TYPE_CHECKING:
    from rcl_interfaces.msg import ParameterDescriptor, SetParametersResult

PreSet = Callable[[list[Parameter[Any]]], list[Parameter[Any]]]
OnSet = Callable[[list[Parameter[Any]]], "SetParametersResult"]
PostSet = Callable[[list[Parameter[Any]]], None]


class NodeParameterSetting:
    """The part of `Node` that sets its parameters."""

    _parameters: dict[str, Parameter[Any]]
    _descriptors: dict[str, ParameterDescriptor]
    _allow_undeclared_parameters: bool
    _pre_set_parameters_callbacks: list[PreSet]
    _on_set_parameters_callbacks: list[OnSet]
    _post_set_parameters_callbacks: list[PostSet]

    def _rcl_publish_parameter_event(
        self, new: list[Parameter[Any]], changed: list[Parameter[Any]], deleted: list[Parameter[Any]]
    ) -> None:
        raise NotImplementedError

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
            self._rcl_check_declared(parameters)
        for parameter in parameters:
            descriptor = self._descriptors.get(parameter.name) or ParameterDescriptor(dynamic_typing=True)
            result = check_change(parameter, descriptor)
            if not result.successful:
                return result
        result = self._rcl_ask_callbacks(parameters)
        if result.successful:
            self._rcl_commit(parameters)
        return result

    def _rcl_ask_callbacks(self, parameters: list[Parameter[Any]]) -> SetParametersResult:
        from rcl_interfaces.msg import SetParametersResult

        for callback in self._on_set_parameters_callbacks:
            result = callback(parameters)
            if not result.successful:
                return result
        return SetParametersResult(successful=True)

    def _rcl_commit(self, parameters: list[Parameter[Any]]) -> None:
        from rcl_interfaces.msg import ParameterDescriptor

        new: list[Parameter[Any]] = []
        changed: list[Parameter[Any]] = []
        deleted: list[Parameter[Any]] = []
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

    def _rcl_report_set(self, parameters: list[Parameter[Any]], new: list[Parameter[Any]]) -> None:
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
        """Remove a callback that `add_pre_set_parameters_callback` added; raise ValueError when it was not."""
        self._pre_set_parameters_callbacks.remove(callback)

    def remove_on_set_parameters_callback(self, callback: OnSet) -> None:
        """Remove a callback that `add_on_set_parameters_callback` added; raise ValueError when it was not."""
        self._on_set_parameters_callbacks.remove(callback)

    def remove_post_set_parameters_callback(self, callback: PostSet) -> None:
        """Remove a callback that `add_post_set_parameters_callback` added; raise ValueError when it was not."""
        self._post_set_parameters_callbacks.remove(callback)
