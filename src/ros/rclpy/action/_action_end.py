"""Common base of action clients and servers: three services, feedback and status."""

from __future__ import annotations

import threading
from types import GenericAlias
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, Self

from rclpy.callback_groups import CallbackGroup
from rclpy.impl.entities import ClientHandle, PublisherHandle, ServiceEndHandle, ServiceHandle, SubscriptionHandle
from rclpy.impl.errors import InvalidHandle
from rclpy.impl.node_graph import checked_name
from rclpy.impl.ready import ReadyHook
from rclpy.qos import QoSProfile
from rclpy.type_support import check_is_valid_action_type
from rclpy.waitable import Waitable

if TYPE_CHECKING:
    from rclpy.clock import Clock
    from rclpy.node import Node
    from rclpy.service_introspection import ServiceIntrospectionState


class ActionQoS(NamedTuple):
    """Quality of service of an action's parts."""

    goal: QoSProfile
    cancel: QoSProfile
    result: QoSProfile
    feedback: QoSProfile
    status: QoSProfile


class ActionEnd(Waitable):
    """One end of an action.

    Parameters
    ----------
    node, action_type, action_name, callback_group
        As the user gave them.
    service_end
        What to make of the three services: `ClientHandle` or `ServiceHandle`.
    topic_end
        What to make of feedback and status: `SubscriptionHandle` or `PublisherHandle`.
    qos
        Quality of service of all five.
    """

    __class_getitem__: ClassVar[Any] = classmethod(GenericAlias)
    role: str
    """What it is, in words."""
    _services: tuple[ServiceEndHandle, ...]

    def __init__(
        self,
        node: Node,
        action_type: Any,
        action_name: str,
        callback_group: CallbackGroup | None,
        service_end: type[ClientHandle] | type[ServiceHandle],
        topic_end: type[SubscriptionHandle] | type[PublisherHandle],
        qos: ActionQoS,
    ) -> None:
        super().__init__(node.default_callback_group if callback_group is None else callback_group)
        check_is_valid_action_type(action_type)
        self._action_node = node
        self._action_type = action_type
        self._action_name = action_name
        self._lock = threading.RLock()
        self._rcl_hook = ReadyHook(self)
        self._destroyed = False
        self._logger = node.get_logger().get_child(self.role.replace(" ", "_"))
        impl = action_type.Impl
        with node.handle as handle:
            base = f"{checked_name(handle, action_name, is_service=False)}/_action"
            self._goal_end = service_end(handle, impl.SendGoalService, f"{base}/send_goal", qos.goal)
            self._cancel_end = service_end(handle, impl.CancelGoalService, f"{base}/cancel_goal", qos.cancel)
            self._result_end = service_end(handle, impl.GetResultService, f"{base}/get_result", qos.result)
            self._feedback_end = topic_end(handle, impl.FeedbackMessage, f"{base}/feedback", qos.feedback)
            self._status_end = topic_end(handle, impl.GoalStatusMessage, f"{base}/status", qos.status)
        self._services = (self._goal_end, self._cancel_end, self._result_end)

    @property
    def action_type(self) -> Any:
        """Class of the action."""
        return self._action_type

    def configure_introspection(
        self, clock: Clock, service_event_qos_profile: QoSProfile, introspection_state: ServiceIntrospectionState
    ) -> None:
        """Publish events of the action's three services; see `Service.configure_introspection`."""
        impl = self._action_type.Impl
        kinds = (impl.SendGoalService, impl.CancelGoalService, impl.GetResultService)
        for service, kind in zip(self._services, kinds, strict=True):
            service.configure_introspection(clock, kind, service_event_qos_profile, introspection_state)

    def destroy(self) -> None:
        """Call or serve no more; goals that are not over end as they are."""
        if self._destroyed:
            return
        self._destroyed = True
        for handle in (*self._services, self._feedback_end, self._status_end):
            handle.destroy_when_not_in_use()
        if self in list(self._action_node.waitables):
            self._action_node.remove_waitable(self)

    def __enter__(self) -> Self:
        if self._destroyed:
            raise InvalidHandle(f"the {self.role} was destroyed")
        return self

    def __exit__(self, *exception: object) -> None:
        """Do nothing."""
