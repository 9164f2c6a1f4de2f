"""Source of ROS time: the system, or ``/clock`` if the parameter ``use_sim_time`` is true."""

from __future__ import annotations

import weakref
from typing import TYPE_CHECKING, Any

from rclpy.clock import ROSClock
from rclpy.impl.entities import SubscriptionHandle
from rclpy.impl.lazy_reexport import lazy_reexport
from rclpy.parameter import Parameter
from rclpy.qos import QoSProfile, ReliabilityPolicy

if TYPE_CHECKING:
    from rclpy.node import Node

CLOCK_TOPIC = "/clock"
USE_SIM_TIME_NAME = "use_sim_time"


class TimeSource:
    """Source of the time of a node's clocks.

    The time that a simulator publishes takes effect on the thread that receives it: clocks show it, and
    sleepers wake, whether or not anybody spins the node.
    """

    def __init__(self, *, node: Node | None = None) -> None:
        self._clock_sub: SubscriptionHandle | None = None
        self._node_weak_ref: weakref.ref[Node] | None = None
        self._associated_clocks: list[ROSClock] = []
        self._last_ns = 0
        self._ros_time_is_active = False
        if node is not None:
            self.attach_node(node)

    @property
    def ros_time_is_active(self) -> bool:
        """Whether time comes from ``/clock``."""
        return self._ros_time_is_active

    @ros_time_is_active.setter
    def ros_time_is_active(self, enabled: bool) -> None:
        if self._ros_time_is_active == enabled:
            return
        self._ros_time_is_active = enabled
        for clock in self._associated_clocks:
            clock._set_ros_time_is_active(enabled)
        if enabled:
            self._subscribe_to_clock_topic()
        else:
            self._unsubscribe()

    def _subscribe_to_clock_topic(self) -> None:
        node = self._get_node()
        if self._clock_sub is not None or node is None:
            return
        from rosgraph_msgs.msg import Clock

        qos = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
        self._clock_sub = SubscriptionHandle(node.handle, Clock, node.resolve_topic_name(CLOCK_TOPIC), qos)
        self._clock_sub.set_sink(self.clock_callback)

    def _unsubscribe(self) -> None:
        subscription, self._clock_sub = self._clock_sub, None
        if subscription is not None:
            subscription.destroy_when_not_in_use()

    def attach_node(self, node: Node) -> None:
        """Follow a node's parameter ``use_sim_time``; it is declared if need be.

        Raises
        ------
        TypeError
            When `node` is no `Node`.
        """
        from rclpy.node import Node

        if not isinstance(node, Node):
            raise TypeError("Node must be of type rclpy.node.Node")
        if self._node_weak_ref is not None:
            self.detach_node()
        self._node_weak_ref = weakref.ref(node)
        if not node.has_parameter(USE_SIM_TIME_NAME):
            node.declare_parameter(USE_SIM_TIME_NAME, False)
        parameter = node.get_parameter(USE_SIM_TIME_NAME)
        if parameter.type_ == Parameter.Type.BOOL:
            self.ros_time_is_active = parameter.value
        elif parameter.type_ != Parameter.Type.NOT_SET:
            node.get_logger().error(
                f"Invalid type for parameter '{USE_SIM_TIME_NAME}' {parameter.type_!r} should be bool"
            )
        node.add_on_set_parameters_callback(self._on_parameter_event)

    def detach_node(self) -> None:
        """Stop following the node."""
        self._unsubscribe()
        self._node_weak_ref = None
        self._ros_time_is_active = False

    def attach_clock(self, clock: ROSClock) -> None:
        """Set a clock from now on.

        Raises
        ------
        ValueError
            When it is not a ROS clock.
        """
        if not isinstance(clock, ROSClock):
            raise ValueError("Only clocks with type ROS_TIME can be attached.")
        clock.handle.set_override_ns(self._last_ns)
        clock._set_ros_time_is_active(self.ros_time_is_active)
        self._associated_clocks.append(clock)

    def clock_callback(self, msg: Any) -> None:
        """Set the clocks to the time in a ``rosgraph_msgs/msg/Clock``; a negative time is logged and ignored."""
        nanoseconds = msg.clock.sec * 1_000_000_000 + msg.clock.nanosec
        if nanoseconds < 0:
            node = self._node_weak_ref() if self._node_weak_ref is not None else None
            if node is not None:
                node.get_logger().warning(f"ignored the negative time {nanoseconds} ns on {CLOCK_TOPIC}", once=True)
            return
        self._last_ns = nanoseconds
        for clock in self._associated_clocks:
            clock._handle.set_override_ns(nanoseconds)

    def _on_parameter_event(self, parameter_list: list[Parameter[Any]]) -> Any:
        from rcl_interfaces.msg import SetParametersResult

        for parameter in parameter_list:
            if parameter.name != USE_SIM_TIME_NAME:
                continue
            if parameter.type_ != Parameter.Type.BOOL:
                return SetParametersResult(
                    successful=False, reason=f"{USE_SIM_TIME_NAME} parameter set to something besides a bool"
                )
            self.ros_time_is_active = parameter.value
        return SetParametersResult(successful=True)

    def _get_node(self) -> Node | None:
        return self._node_weak_ref() if self._node_weak_ref is not None else None


if not TYPE_CHECKING:
    __getattr__ = lazy_reexport(
        __name__,
        {"rcl_interfaces.msg": ("ParameterEvent", "SetParametersResult"), "rclpy.clock": ("Clock",)},
    )
