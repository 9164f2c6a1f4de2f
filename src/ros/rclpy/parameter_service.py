"""The services by which others get and set a node's parameters."""

from __future__ import annotations

import weakref
from typing import TYPE_CHECKING, Any

from rclpy.exceptions import ParameterNotDeclaredException, ParameterUninitializedException
from rclpy.parameter import Parameter
from rclpy.qos import qos_profile_parameters

if TYPE_CHECKING:
    from rclpy.node import Node

TOPIC_SEPARATOR_STRING = "/"


class ParameterService:
    """Services ``describe_parameters``, ``get_parameters`` and the others of a node."""

    def __init__(self, node: Node) -> None:
        from rcl_interfaces.srv import (
            DescribeParameters,
            GetParameters,
            GetParameterTypes,
            ListParameters,
            SetParameters,
            SetParametersAtomically,
        )

        self._node_weak_ref = weakref.ref(node)
        for name, kind, callback in (
            ("describe_parameters", DescribeParameters, self._describe_parameters_callback),
            ("get_parameters", GetParameters, self._get_parameters_callback),
            ("get_parameter_types", GetParameterTypes, self._get_parameter_types_callback),
            ("list_parameters", ListParameters, self._list_parameters_callback),
            ("set_parameters", SetParameters, self._set_parameters_callback),
            ("set_parameters_atomically", SetParametersAtomically, self._set_parameters_atomically_callback),
        ):
            node.create_service(kind, f"~/{name}", callback, qos_profile=qos_profile_parameters)

    def _describe_parameters_callback(self, request: Any, response: Any) -> Any:
        try:
            response.descriptors = self._get_node().describe_parameters(request.names)
        except ParameterNotDeclaredException:
            response.descriptors = []
        return response

    def _get_parameters_callback(self, request: Any, response: Any) -> Any:
        node = self._get_node()
        try:
            response.values = [node.get_parameter(name).get_parameter_value() for name in request.names]
        except (ParameterNotDeclaredException, ParameterUninitializedException):
            response.values = []
        return response

    def _get_parameter_types_callback(self, request: Any, response: Any) -> Any:
        try:
            response.types = [int(kind) for kind in self._get_node().get_parameter_types(request.names)]
        except ParameterNotDeclaredException:
            response.types = []
        return response

    def _list_parameters_callback(self, request: Any, response: Any) -> Any:
        node = self._get_node()
        try:
            response.result = node.list_parameters(request.prefixes, request.depth)
        except (TypeError, ValueError) as error:
            node.get_logger().warning(f"Failed to list parameters: {error}")
        return response

    def _set_parameters_callback(self, request: Any, response: Any) -> Any:
        node = self._get_node()
        response.results = [self._set([message], node.set_parameters_atomically) for message in request.parameters]
        return response

    def _set_parameters_atomically_callback(self, request: Any, response: Any) -> Any:
        response.result = self._set(request.parameters, self._get_node().set_parameters_atomically)
        return response

    def _set(self, messages: Any, setter: Any) -> Any:
        from rcl_interfaces.msg import SetParametersResult

        try:
            return setter([Parameter.from_parameter_msg(message) for message in messages])
        except ParameterNotDeclaredException:
            # ROS 2 names no parameter here, and programs compare the text.
            return SetParametersResult(successful=False, reason=str(ParameterNotDeclaredException([])))
        except (TypeError, ValueError) as error:
            return SetParametersResult(successful=False, reason=str(error))

    def _get_node(self) -> Node:
        node = self._node_weak_ref()
        if node is None:
            raise ReferenceError("Expected valid node weak reference")
        return node
