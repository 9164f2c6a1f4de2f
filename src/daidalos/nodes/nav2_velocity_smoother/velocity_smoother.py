"""`velocity_smoother`: keeps commanded velocities within a robot's limits, as a managed node of Nav2."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from rclpy.lifecycle import LifecycleState, TransitionCallbackReturn

from daidalos.common.arrays import Array
from daidalos.common.parameters import parameter
from daidalos.navigation.velocity_smoother import MeasuredVelocity, VelocitySmoother, VelocitySmootherParameters
from daidalos.nodes.conversions import twist_message, velocity_of
from daidalos.nodes.managed import ManagedNode
from daidalos.nodes.parameters import declare, declare_without_effect
from daidalos.samples.fields import nanoseconds, seconds

_WITHOUT_EFFECT = {
    "allow_parameter_qos_overrides": "qualities of service follow qos_overrides wherever these are given",
    "bond_heartbeat_period": "there are no bonds; the lifecycle manager asks for states",
    "use_realtime_priority": "no thread of Python has a real-time priority",
}
"""Parameters of some of Nav2's releases that do nothing here, with the reason."""

_REPEAT_S = 5.0
"""Time [s] until a fault that lasts is logged again."""


@dataclass(frozen=True)
class VelocitySmootherNodeParameters(VelocitySmootherParameters):
    """Parameters of the node: those of the smoother, and what it listens to and publishes."""

    odom_topic: str = parameter("odom", "Topic of the odometry, for CLOSED_LOOP.", not_empty=True, read_only=True)
    odom_duration: float = parameter(
        0.1, "Time over which velocities of the odometry are averaged.", unit="s", minimum=0.0
    )
    enable_stamped_cmd_vel: bool = parameter(False, "Whether velocities are TwistStamped.", read_only=True)
    stamp_smoothed_velocity_with_smoothing_time: bool = parameter(
        False, "Whether smoothed velocities have the time of the smoothing instead of their command's stamp."
    )


class VelocitySmootherNode(ManagedNode):
    """Node that takes commands from ``cmd_vel`` and publishes smooth ones on ``cmd_vel_smoothed``.

    Its parameters are those of `VelocitySmootherNodeParameters`.
    """

    def __init__(self, node_name: str = "velocity_smoother", **kwargs: Any) -> None:
        super().__init__(node_name, **kwargs)
        self._settings = declare(self, VelocitySmootherNodeParameters, reconfigure=self._reconfigure)
        declare_without_effect(self, _WITHOUT_EFFECT)
        self._smoother = VelocitySmoother(self._settings)
        self._measured = MeasuredVelocity(self._settings.odom_duration)
        self._header: Any = None
        self._timer: Any = None

    def _reconfigure(self, parameters: VelocitySmootherNodeParameters) -> None:
        is_other_rate = parameters.smoothing_frequency != self._settings.smoothing_frequency
        self._settings = self._smoother.parameters = parameters
        self._measured.duration = parameters.odom_duration
        if is_other_rate and self._timer is not None:
            self._start()

    def configure(self) -> None:
        """Create the topics."""
        from geometry_msgs.msg import Twist, TwistStamped
        from nav_msgs.msg import Odometry

        is_stamped = self._settings.enable_stamped_cmd_vel
        kind, take = (TwistStamped, self._on_stamped) if is_stamped else (Twist, self._on_command)
        self._publisher: Any = self.create_lifecycle_publisher(kind, "cmd_vel_smoothed", 1)
        self.create_subscription(kind, "cmd_vel", take, 1)
        self.create_subscription(Odometry, self._settings.odom_topic, self._on_odometry, 10)

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Publish velocities from now on, beginning with a robot that stands and has no command."""
        self._smoother = VelocitySmoother(self._settings)
        self._start()
        return super().on_activate(state)

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Stop the robot if it moves, and publish nothing any more."""
        self.destroy_timer(self._timer)
        self._timer = None
        if self._smoother.is_moving:
            self._publish(np.zeros(3))
        return super().on_deactivate(state)

    def _start(self) -> None:
        if self._timer is not None:
            self.destroy_timer(self._timer)
        self._timer = self.create_timer(1.0 / self._settings.smoothing_frequency, self._smooth)

    @property
    def _now(self) -> float:
        return 1e-9 * self.get_clock().now().nanoseconds

    # Callbacks.

    def _on_stamped(self, message: Any) -> None:
        self._header = message.header
        self._take(message.twist, seconds(message.header.stamp) if nanoseconds(message.header.stamp) else self._now)

    def _on_command(self, message: Any) -> None:
        self._take(message, self._now)

    def _take(self, twist: Any, stamp: float) -> None:
        """Take a command that was given at a time [s]; one that is already too old changes nothing."""
        if not self.is_active:
            return
        velocity = velocity_of(twist)
        if not np.isfinite(velocity).all():
            self.get_logger().error(
                f"a velocity command is not finite: {velocity.tolist()}; the robot is stopped",
                throttle_duration_sec=_REPEAT_S,
            )
        age = self._now - stamp
        if age > self._settings.velocity_timeout:
            self.get_logger().warning(
                f"a velocity command is {age:.1f} s old and ignored: velocity_timeout is "
                f"{self._settings.velocity_timeout:g} s",
                throttle_duration_sec=_REPEAT_S,
            )
            return
        self._smoother.command(velocity, min(stamp, self._now))

    def _on_odometry(self, message: Any) -> None:
        velocity = velocity_of(message.twist.twist)
        if not np.isfinite(velocity).all():
            self.get_logger().warning(
                f"a velocity of the odometry is not finite and ignored: {velocity.tolist()}",
                throttle_duration_sec=_REPEAT_S,
            )
            return
        self._measured.add(velocity, self._now)

    def _smooth(self) -> None:
        now = self._now
        measured = self._measured.at(now) if self._settings.feedback == "CLOSED_LOOP" else None
        if measured is None and self._settings.feedback == "CLOSED_LOOP":
            self.get_logger().warning(
                f"there is no odometry on '{self._settings.odom_topic}': the last commands are taken for the velocity",
                throttle_duration_sec=_REPEAT_S,
            )
        velocity = self._smoother.step(now, measured)
        if velocity is not None:
            self._publish(velocity)

    def _publish(self, velocity: Array) -> None:
        if not self._settings.enable_stamped_cmd_vel:
            self._publisher.publish(twist_message(velocity, None, None))
            return
        now = self.get_clock().now().to_msg()
        is_own = self._settings.stamp_smoothed_velocity_with_smoothing_time or self._header is None
        frame = "" if self._header is None else self._header.frame_id
        self._publisher.publish(twist_message(velocity, frame, now if is_own else self._header.stamp))


def main() -> int:
    """Run the node."""
    from daidalos.nodes.runner import run

    return run(VelocitySmootherNode)
