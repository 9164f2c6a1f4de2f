"""`collision_monitor`: stops a robot or slows it down before obstacles, as a managed node of Nav2."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from rclpy.lifecycle import LifecycleState, TransitionCallbackReturn
from rclpy.parameter import Parameter
from tf2_ros import Buffer, TransformListener

from daidalos.common.arrays import Array
from daidalos.common.parameters import ParameterError, Parameters, parameter, per_name
from daidalos.common.suggestions import hint
from daidalos.navigation.collision_monitor import Zone, ZoneParameters
from daidalos.nodes.conversions import twist_message, velocity_of
from daidalos.nodes.managed import ManagedNode
from daidalos.nodes.nav2_collision_monitor._sources import Source, SourceParameters
from daidalos.nodes.parameters import declare, declare_without_effect
from daidalos.nodes.qos import LATCHED

_WITHOUT_EFFECT = {
    "allow_parameter_qos_overrides": "qualities of service follow qos_overrides wherever these are given",
    "bond_heartbeat_period": "there are no bonds; the lifecycle manager asks for states",
    "use_realtime_priority": "no thread of Python has a real-time priority",
}
"""Parameters of some of Nav2's releases that do nothing here, with the reason."""

_ACTIONS = {"stop": 1, "slowdown": 2, "approach": 3, "limit": 4, "none": 0}
_REPEAT_NS = 5_000_000_000
"""Time [ns] until a fault that lasts is logged again."""


@dataclass(frozen=True)
class CollisionMonitorParameters(Parameters):
    """Parameters of the node, by their Nav2 names."""

    base_frame_id: str = parameter("base_footprint", "Frame of the robot's base.", not_empty=True, read_only=True)
    odom_frame_id: str = parameter("odom", "Frame of the odometry.", not_empty=True, read_only=True)
    cmd_vel_in_topic: str = parameter("cmd_vel_smoothed", "Topic of commands.", not_empty=True, read_only=True)
    cmd_vel_out_topic: str = parameter("cmd_vel", "Topic of safe commands.", not_empty=True, read_only=True)
    enable_stamped_cmd_vel: bool = parameter(False, "Whether velocities are TwistStamped.", read_only=True)
    state_topic: str = parameter("", "Topic of the state; none where empty.", read_only=True)
    transform_tolerance: float = parameter(0.1, "Age that transforms may have.", unit="s", minimum=0.0)
    source_timeout: float = parameter(
        2.0, "Age of data that stops the robot; 0 for none.", unit="s", minimum=0.0, takes_integer=True
    )
    base_shift_correction: bool = parameter(
        True, "Whether the robot's motion since the data were measured is taken into account."
    )
    stop_pub_timeout: float = parameter(
        1.0, "Time after which a robot that is stopped is sent nothing.", unit="s", minimum=0.0
    )
    polygons: tuple[str, ...] = parameter((), "Names of the zones.", not_empty=True, unique=True, read_only=True)
    zones: Mapping[str, ZoneParameters] = per_name(ZoneParameters, by="polygons", at="")
    observation_sources: tuple[str, ...] = parameter(
        (), "Names of the sources.", not_empty=True, unique=True, read_only=True
    )
    sources: Mapping[str, SourceParameters] = per_name(SourceParameters, by="observation_sources", at="")

    def check(self) -> None:
        """Refuse zones with a source that does not exist: they would see nothing."""
        for name, zone in self.zones.items():
            for source in zone.sources_names:
                if source not in self.sources:
                    problem = f"names '{source}', which is no observation source{hint(source, self.sources)}"
                    raise ParameterError(f"{name}.sources_names", problem)


class CollisionMonitorNode(ManagedNode):
    """Node that passes velocities on as far as the zones around the robot are free.

    Its parameters are those of `CollisionMonitorParameters`.
    """

    def __init__(self, node_name: str = "collision_monitor", **kwargs: Any) -> None:
        super().__init__(node_name, **kwargs)
        self._buffer = Buffer(node=self)
        self._listener = TransformListener(self._buffer, self)
        self._is_enabled = True
        self._zones: dict[str, Zone] = {}
        self._sources: dict[str, Source] = {}
        self._stopped_ns: int | None = None
        self._state = ("", "")
        self._warned: dict[str, int] = {}
        declare_without_effect(self, _WITHOUT_EFFECT)

    def configure(self) -> None:
        """Create the zones, the sources and the topics."""
        from geometry_msgs.msg import PolygonStamped, Twist, TwistStamped
        from nav2_msgs.msg import CollisionMonitorState
        from nav2_msgs.srv import Toggle
        from visualization_msgs.msg import MarkerArray

        self._write_points_as_text()
        p = self._settings = declare(self, CollisionMonitorParameters, reconfigure=self._reconfigure)
        self._zones = {name: Zone(one) for name, one in p.zones.items()}
        self._sources = {name: Source(self, self._buffer, one) for name, one in p.sources.items()}
        self._shown: dict[str, Any] = {}
        for name, zone in p.zones.items():
            if zone.topic:
                qos = LATCHED if zone.polygon_subscribe_transient_local else 1
                self.create_subscription(PolygonStamped, zone.topic, partial(self._on_corners, name), qos)
            if zone.visualize:
                self._shown[name] = self.create_lifecycle_publisher(PolygonStamped, zone.polygon_pub_topic or name, 1)
        self._states: Any = None
        if p.state_topic:
            self._states = self.create_lifecycle_publisher(CollisionMonitorState, p.state_topic, 1)
        kind = TwistStamped if p.enable_stamped_cmd_vel else Twist
        self._markers: Any = self.create_lifecycle_publisher(MarkerArray, "~/collision_points_marker", 1)
        self._publisher: Any = self.create_lifecycle_publisher(kind, p.cmd_vel_out_topic, 1)
        self.create_subscription(kind, p.cmd_vel_in_topic, self._on_command, 1)
        self.create_service(Toggle, "~/toggle", self._on_toggle)

    def _reconfigure(self, parameters: CollisionMonitorParameters) -> None:
        self._settings = parameters
        for name, zone in self._zones.items():
            zone.parameters = parameters.zones[name]
        for name, source in self._sources.items():
            source.parameters = parameters.sources[name]

    def _write_points_as_text(self) -> None:
        """Replace given corners that are a list of numbers, as in Humble, by the text that later releases have."""
        for name, given in list(self._parameter_overrides.items()):
            if name.endswith(".points") and not isinstance(given.value, str):
                pairs = np.asarray(given.value, dtype=float)
                text = str(pairs.reshape(-1, 2).tolist() if len(pairs) % 2 == 0 else pairs.tolist())
                self._parameter_overrides[name] = Parameter(name, value=text)

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Pass velocities on, and publish the zones."""
        self._stopped_ns = None
        self._state = ("", "")
        outcome = super().on_activate(state)
        self._show_zones()
        return outcome

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Stop the robot, and pass nothing on any more."""
        self._publish(np.zeros(3), "")
        return super().on_deactivate(state)

    # Callbacks.

    def _on_toggle(self, request: Any, response: Any) -> Any:
        self._is_enabled = request.enable
        response.success = True
        response.message = f"the collision monitor is {'enabled' if request.enable else 'disabled'}"
        self.get_logger().info(response.message)
        return response

    def _on_corners(self, name: str, message: Any) -> None:
        corners = np.array([(one.x, one.y) for one in message.polygon.points], dtype=float)
        frame = message.header.frame_id
        if len(corners) < 3 or not np.isfinite(corners).all():
            self._warn(f"corners of zone '{name}' are ignored: they are not three or more finite points")
            return
        if frame not in ("", self._settings.base_frame_id):
            from rclpy.time import Time
            from tf2_ros import TransformException

            from daidalos.common.pose2 import transform_points
            from daidalos.nodes.conversions import pose2_of_transform

            try:
                time = Time.from_msg(message.header.stamp)
                found = self._buffer.lookup_transform(self._settings.base_frame_id, frame, time)
            except TransformException:
                try:
                    found = self._buffer.lookup_transform(self._settings.base_frame_id, frame, Time())
                except TransformException as error:
                    self._warn(f"corners of zone '{name}' are ignored: {error}")
                    return
            corners = transform_points(pose2_of_transform(found.transform), corners)
        self._zones[name].corners = corners

    def _on_command(self, message: Any) -> None:
        if not self.is_active:
            return
        is_stamped = self._settings.enable_stamped_cmd_vel
        twist = message.twist if is_stamped else message
        velocity = velocity_of(twist)
        frame = message.header.frame_id if is_stamped else ""
        if not np.isfinite(velocity).all():
            self._warn(f"a velocity command is not finite: {velocity.tolist()}; the robot is stopped")
            velocity = np.zeros(3)
        if not self._is_enabled:
            self._publish(velocity, frame)
            return
        ratio, zone, action = self._judge(velocity)
        self._tell(zone, action)
        self._publish(ratio * velocity, frame)
        self._show_zones()

    # Judging.

    def _judge(self, velocity: Array) -> tuple[float, str, str]:
        """Return the factor of a velocity, and the zone and the action that ask for it."""
        points = self._look()
        if isinstance(points, str):
            self._warn(f"the robot is stopped: {points}")
            return 0.0, "invalid source", "stop"
        found = (1.0, "", "none")
        for name, zone in self._zones.items():
            if not zone.parameters.enabled:
                continue
            sources = zone.parameters.sources_names or tuple(points)
            clouds = [points[one] for one in sources if one in points]
            verdict = zone.judge(velocity, np.concatenate([np.zeros((0, 2)), *clouds]))
            if verdict.reason:
                self._warn(f"the robot is stopped: zone '{name}': {verdict.reason}")
            if verdict.ratio < found[0]:
                found = (verdict.ratio, name, zone.parameters.action_type)
        return found

    def _look(self) -> dict[str, Array] | str:
        """Return the points of each source, or why one of them cannot be relied on."""
        p = self._settings
        odom = p.odom_frame_id if p.base_shift_correction else ""
        now_ns = self.get_clock().now().nanoseconds
        seen: dict[str, Array] = {}
        for name, source in self._sources.items():
            if not source.parameters.enabled:
                continue
            own = source.parameters.source_timeout
            timeout = p.source_timeout if np.isnan(own) else own
            points = source.points(now_ns, timeout, p.base_frame_id, odom, p.transform_tolerance)
            if not isinstance(points, str):
                seen[name] = points
            elif timeout > 0.0:
                return f"source '{name}' on '{source.parameters.topic}': {points}"
        self._show_points(seen)
        return seen

    # What is published.

    def _publish(self, velocity: Array, frame: str) -> None:
        now = self.get_clock().now()
        if velocity.any():
            self._stopped_ns = None
        elif self._stopped_ns is None:
            self._stopped_ns = now.nanoseconds
        elif now.nanoseconds - self._stopped_ns > 1e9 * self._settings.stop_pub_timeout:
            return
        is_stamped = self._settings.enable_stamped_cmd_vel
        self._publisher.publish(twist_message(velocity, frame if is_stamped else None, now.to_msg()))

    def _tell(self, zone: str, action: str) -> None:
        """Log and publish a state that is new."""
        if (zone, action) == self._state:
            return
        self._state = (zone, action)
        self.get_logger().info(f"{action} for {zone}" if zone else "the robot may go on")
        if self._states is not None:
            from nav2_msgs.msg import CollisionMonitorState

            self._states.publish(CollisionMonitorState(action_type=_ACTIONS[action], polygon_name=zone))

    def _show_zones(self) -> None:
        from geometry_msgs.msg import Point32, Polygon, PolygonStamped
        from std_msgs.msg import Header

        for name, publisher in self._shown.items():
            corners = self._zones[name].outline
            if corners is not None and publisher.get_subscription_count():
                header = Header(frame_id=self._settings.base_frame_id, stamp=self.get_clock().now().to_msg())
                points = [Point32(x=x, y=y) for x, y in corners.tolist()]
                publisher.publish(PolygonStamped(header=header, polygon=Polygon(points=points)))

    def _show_points(self, seen: Mapping[str, Array]) -> None:
        from geometry_msgs.msg import Point, Vector3
        from std_msgs.msg import ColorRGBA, Header
        from visualization_msgs.msg import Marker, MarkerArray

        if not self._markers.get_subscription_count():
            return
        header = Header(frame_id=self._settings.base_frame_id, stamp=self.get_clock().now().to_msg())
        markers = [
            Marker(
                header=header,
                ns=f"collision_points_{name}",
                type=Marker.POINTS,
                action=Marker.ADD,
                scale=Vector3(x=0.02, y=0.02),
                color=ColorRGBA(r=1.0, a=1.0),
                points=[Point(x=x, y=y) for x, y in points.tolist()],
            )
            for name, points in seen.items()
        ]
        self._markers.publish(MarkerArray(markers=markers))

    def _warn(self, text: str) -> None:
        """Log a fault, again only after a while where nothing but its numbers is new."""
        now_ns = self.get_clock().now().nanoseconds
        kind = re.sub(r"[-\d.]+", "", text)
        if not 0 <= now_ns - self._warned.get(kind, -_REPEAT_NS) < _REPEAT_NS:
            self._warned[kind] = now_ns
            self.get_logger().warning(text)


def main() -> int:
    """Run the node."""
    from daidalos.nodes.runner import run

    return run(CollisionMonitorNode)
