"""The protocol with all operations."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping
from typing import Any, ClassVar

from rclpy.node import Node

from rosbridge_library.capabilities.action_feedback import ActionFeedback
from rosbridge_library.capabilities.action_result import ActionResult
from rosbridge_library.capabilities.advertise import Advertise
from rosbridge_library.capabilities.advertise_action import AdvertiseAction
from rosbridge_library.capabilities.advertise_service import AdvertiseService
from rosbridge_library.capabilities.call_service import CallService
from rosbridge_library.capabilities.defragmentation import Defragment
from rosbridge_library.capabilities.png import Png
from rosbridge_library.capabilities.publish import Publish
from rosbridge_library.capabilities.send_action_goal import SendActionGoal
from rosbridge_library.capabilities.service_response import ServiceResponse
from rosbridge_library.capabilities.subscribe import Subscribe
from rosbridge_library.capabilities.unadvertise_action import UnadvertiseAction
from rosbridge_library.capabilities.unadvertise_service import UnadvertiseService
from rosbridge_library.capability import Capability
from rosbridge_library.protocol import Protocol


class RosbridgeProtocol(Protocol):
    """A client with all operations.

    Parameters
    ----------
    client_id, node_handle
        See `Protocol`.
    parameters
        ``fragment_size``, ``delay_between_messages``, ``fragment_timeout``, ``unregister_timeout`` and
        ``default_call_service_timeout``, where they are not the default ones.
    """

    rosbridge_capabilities: ClassVar[tuple[Callable[[Protocol], Capability], ...]] = (
        CallService,
        Advertise,
        Publish,
        Subscribe,
        Defragment,
        Png,
        AdvertiseService,
        ServiceResponse,
        UnadvertiseService,
        AdvertiseAction,
        ActionFeedback,
        ActionResult,
        SendActionGoal,
        UnadvertiseAction,
    )

    def __init__(self, client_id: Hashable, node_handle: Node, parameters: Mapping[str, Any] | None = None) -> None:
        self.parameters = parameters
        super().__init__(client_id, node_handle)
        for kind in self.rosbridge_capabilities:
            self.add_capability(kind)
