"""Services that list controllers, their types, hardware and interfaces."""

from __future__ import annotations

import threading
from typing import Any

from rclpy.callback_groups import CallbackGroup
from rclpy.node import Node

from daidalos.common.errors import UserError
from daidalos.common.extensions import listing, load
from daidalos.control.extensions import CONTROLLERS
from daidalos.control.manager import ControllerManager
from daidalos.nodes.controller_manager._reports import component_message, controller_message, interface_messages

_CHAINABLE = "controller_interface::ChainableControllerInterface"
_PLAIN = "controller_interface::ControllerInterface"


class ListingServices:
    """Offers what a manager has, below the name of its node.

    Parameters
    ----------
    node : Node
    manager : ControllerManager
    lock : RLock
        Held while the manager is used.
    group : CallbackGroup
    """

    def __init__(self, node: Node, manager: ControllerManager, lock: threading.RLock, group: CallbackGroup) -> None:
        from controller_manager_msgs import srv

        self._node = node
        self._manager = manager
        self._lock = lock
        for kind, name, answer in (
            (srv.ListControllers, "list_controllers", self._list_controllers),
            (srv.ListControllerTypes, "list_controller_types", self._list_types),
            (srv.ListHardwareComponents, "list_hardware_components", self._list_components),
            (srv.ListHardwareInterfaces, "list_hardware_interfaces", self._list_interfaces),
        ):
            node.create_service(kind, f"~/{name}", answer, callback_group=group)

    def _list_controllers(self, request: Any, response: Any) -> Any:
        with self._lock:
            response.controller = [controller_message(self._manager, name) for name in self._manager.controllers]
        return response

    def _list_types(self, request: Any, response: Any) -> Any:
        for extension in sorted(listing(CONTROLLERS)):
            try:
                cls = load(CONTROLLERS, extension)
            except UserError as error:
                self._node.get_logger().warning(str(error))
                continue
            response.types.append(extension.name)
            response.base_classes.append(_CHAINABLE if cls.chainable else _PLAIN)
        return response

    def _list_components(self, request: Any, response: Any) -> Any:
        with self._lock:
            response.component = [component_message(self._manager, name) for name in self._manager.components]
        return response

    def _list_interfaces(self, request: Any, response: Any) -> Any:
        with self._lock:
            response.command_interfaces, response.state_interfaces = interface_messages(self._manager)
        return response
