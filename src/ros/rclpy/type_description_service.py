"""The service that describes the types of a node's interfaces."""

from __future__ import annotations

import weakref
from typing import TYPE_CHECKING, Any

from rclpy.exceptions import ParameterAlreadyDeclaredException
from rclpy.parameter import Parameter
from rclpy.qos import qos_profile_services_default

if TYPE_CHECKING:
    from rclpy.node import Node

START_TYPE_DESCRIPTION_SERVICE_PARAM = "start_type_description_service"
TOPIC_SEPARATOR_STRING = "/"


class TypeDescriptionService:
    """Service ``get_type_description`` of a node, unless the parameter of that name is false."""

    def __init__(self, node: Node) -> None:
        from rcl_interfaces.msg import ParameterDescriptor

        self._node_weak_ref = weakref.ref(node)
        self._service: Any = None
        name = START_TYPE_DESCRIPTION_SERVICE_PARAM
        descriptor = ParameterDescriptor(
            description="If enabled, start the ~/get_type_description service.", read_only=True
        )
        try:
            parameter = node.declare_parameter(name, True, descriptor)
        except ParameterAlreadyDeclaredException:
            parameter = node.get_parameter(name)
        if parameter.type_ != Parameter.Type.BOOL:
            node.get_logger().error(f"Invalid type '{parameter.type_.name}' for parameter '{name}', should be 'BOOL'")
            return
        if parameter.value:
            self._start(node)

    def _start(self, node: Node) -> None:
        from type_description_interfaces.srv import GetTypeDescription

        self._service = node.create_service(
            GetTypeDescription,
            "~/get_type_description",
            self._describe,
            qos_profile=qos_profile_services_default,
        )

    def _describe(self, request: Any, response: Any) -> Any:
        from rclpy.impl.type_descriptions import fill_response

        return fill_response(request, response)

    def destroy(self) -> None:
        """Stop serving."""
        node = self._node_weak_ref()
        if self._service is not None and node is not None:
            node.destroy_service(self._service)
        self._service = None
