"""Base of the filters' nodes: topics, services and transforms around a Kalman filter."""

from __future__ import annotations

import heapq
import itertools
import math
from collections import deque
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
from geometry_msgs.msg import (
    AccelWithCovarianceStamped,
    PoseWithCovarianceStamped,
    TransformStamped,
    Twist,
    TwistStamped,
    TwistWithCovarianceStamped,
)
from nav_msgs.msg import Odometry
from rclpy.node import Node
from rclpy.time import Time
from robot_localization.srv import SetPose, ToggleFilterProcessing
from sensor_msgs.msg import Imu
from std_srvs.srv import Empty
from tf2_ros import Buffer, TransformBroadcaster, TransformException, TransformListener

from daidalos.common.arrays import Array
from daidalos.common.pose3 import Pose
from daidalos.localization.errors import LocalizationError
from daidalos.localization.filters.history import FilterHistory
from daidalos.localization.filters.kalman import Control, KalmanFilter, Measurement, square
from daidalos.localization.filters.model import ACCELERATION
from daidalos.nodes.parameters import declare, declare_without_effect
from daidalos.nodes.robot_localization._measurements import Converter, planar_measurement
from daidalos.nodes.robot_localization._parameters import (
    WITHOUT_EFFECT,
    FilterParameters,
    Input,
    declare_inputs,
)
from daidalos.nodes.scan_reports import ScanReports
from daidalos.samples.fields import seconds, time_message

_MESSAGES: dict[str, Any] = {
    "odom": Odometry,
    "pose": PoseWithCovarianceStamped,
    "twist": TwistWithCovarianceStamped,
    "imu": Imu,
}
MAX_AHEAD = 1.0
"""How far [s] ahead of the clock a measurement may be and wait for its time."""

_MAX_COMMANDS = 1000
"""How many commands are kept for measurements that come late."""

_SET_VARIANCE = 1e-6
"""Variance of the velocities and accelerations, which are zero, of a pose that was set."""


class FilterNode(Node):
    """Node that publishes ``odometry/filtered``.

    Parameters
    ----------
    name : str
    make : callable
        Returns a filter for its noise, initial state and covariance, whether the noise is scaled, and its control.
    """

    def __init__(self, name: str, make: Callable[..., KalmanFilter], **kwargs: Any) -> None:
        super().__init__(name, **kwargs)
        self._settings = p = declare(self, FilterParameters)
        declare_without_effect(self, WITHOUT_EFFECT)
        sources = declare_inputs(self)
        self._filter = make(
            square(p.process_noise_covariance, "process_noise_covariance"),
            np.array(p.initial_state),
            square(p.initial_estimate_covariance, "initial_estimate_covariance"),
            p.dynamic_process_noise_covariance,
            self._control(),
        )
        self._is_enabled, self._is_on = not p.disabled_at_startup, True
        self._reports = ScanReports(self)
        self._converters: list[Converter] = []
        self._order = itertools.count()
        self._history = FilterHistory(p.history_length) if p.smooth_lagged_data else None
        # As many as the history may need.
        self._commands: deque[tuple[float, Array]] = deque(maxlen=_MAX_COMMANDS if p.smooth_lagged_data else 1)
        self._forget()
        self._buffer = Buffer()
        self._listener = TransformListener(self._buffer, self)
        self._broadcaster = TransformBroadcaster(self)
        self._odometry = self.create_publisher(Odometry, "odometry/filtered", 10)
        self._acceleration = self.create_publisher(AccelWithCovarianceStamped, "accel/filtered", 10)
        for source in sources:
            self._listen(source)
        self._offer()
        if p.smooth_lagged_data and not p.history_length:
            self.get_logger().warning("smooth_lagged_data has no effect without a history_length above 0")
        self.create_timer(1.0 / p.frequency, self._cycle)

    def _control(self) -> Control | None:
        p = self._settings
        if not p.use_control:
            return None
        limits = (p.acceleration_limits, p.deceleration_limits, p.acceleration_gains, p.deceleration_gains)
        return Control(np.array(p.control_config), *(np.array(one) for one in limits))

    def _listen(self, source: Input) -> None:
        """Subscribe to an input."""
        converter = Converter(source, self._settings)
        self._converters.append(converter)
        callback = partial(self._on_measurement, source, converter)
        self.create_subscription(_MESSAGES[source.kind], source.topic, callback, source.queue_size)
        if not source.uses.any():
            self.get_logger().warning(f"{source.name}_config uses no variable of '{source.topic}'")

    def _offer(self) -> None:
        """Create what the filter is controlled by."""
        self.create_subscription(PoseWithCovarianceStamped, "set_pose", self._set_pose, 1)
        self.create_service(SetPose, "set_pose", self._on_set_pose)
        self.create_service(ToggleFilterProcessing, "toggle", self._on_toggle)
        self.create_service(Empty, "enable", self._on_enable)
        self.create_service(Empty, "reset", self._on_reset)
        if self._settings.use_control:
            kind = TwistStamped if self._settings.stamped_control else Twist
            self.create_subscription(kind, "cmd_vel", self._on_command, 10)

    @property
    def _now(self) -> float:
        return float(self.get_clock().now().nanoseconds) * 1e-9

    def _forget(self) -> None:
        """Forget everything measured."""
        self._filter.reset()
        self._waiting: list[tuple[float, int, str, Measurement]] = []
        self._times: dict[str, float] = {}
        self._set_at, self._cycle_at, self._published_at = -math.inf, -math.inf, -math.inf
        self._commands.clear()
        if self._history is not None:
            self._history.clear()
        for converter in self._converters:
            converter.forget()

    # Measurements.

    def _on_measurement(self, source: Input, converter: Converter, message: Any) -> None:
        if not (self._is_enabled and self._is_on):
            return
        time = seconds(message.header.stamp) or self._now
        if time < self._set_at:
            return
        if time > self._now + MAX_AHEAD:
            self._refuse(source, f"its stamp is more than {MAX_AHEAD:g} s ahead of the clock; see use_sim_time")
            return
        if time < self._times.get(source.name, -math.inf):
            self._refuse(source, "it is older than the one before it")
            return
        try:
            found = converter.convert(message, time, self._filter.state, partial(self._look_up, message.header.stamp))
        except (LocalizationError, TransformException) as error:
            self._refuse(source, str(error))
            return
        self._times[source.name] = time
        for one in found:
            heapq.heappush(self._waiting, (time, next(self._order), source.name, one))

    def _refuse(self, source: Input, why: str) -> None:
        text = f"a measurement of {source.name} ('{source.topic}') is not used: {why}"
        self._reports.report(text, text)

    def _look_up(self, stamp: Any, target: str, source: str) -> Pose:
        """Return the pose of a frame in another at a time, or the newest where that is not known."""
        if target == source:
            return Pose()
        try:
            found = self._buffer.lookup_transform(target, source, stamp)
        except TransformException:
            try:
                found = self._buffer.lookup_transform(target, source, Time())
            except TransformException:
                raise TransformException(f"there is no transform from '{source}' to '{target}'") from None
        shift, turn = found.transform.translation, found.transform.rotation
        return Pose((shift.x, shift.y, shift.z), (turn.x, turn.y, turn.z, turn.w))

    def _on_command(self, message: Any) -> None:
        twist = message.twist if self._settings.stamped_control else message
        linear, angular = twist.linear, twist.angular
        command = np.array([linear.x, linear.y, linear.z, angular.x, angular.y, angular.z])
        if not np.isfinite(command).all():
            self._reports.report("command", "a command on cmd_vel is not used: it is not finite")
            return
        stamp = seconds(message.header.stamp) if self._settings.stamped_control else 0.0
        self._commands.append((stamp or self._now, command))

    def _set_command(self, time: float) -> None:
        """Give the filter the command that counts at a time: the last one until then, else the first one."""
        if not self._commands:
            return
        sent, command = next((one for one in reversed(self._commands) if one[0] <= time), self._commands[0])
        timeout = self._settings.control_timeout
        is_old = 0 < timeout < time - sent
        self._filter.command = np.zeros(6) if is_old else command

    # The cycle.

    def _cycle(self) -> None:
        p, now = self._settings, self._now
        if now < self._cycle_at:
            self.get_logger().warning("time went back; the filter starts again")
            self._forget()
        self._cycle_at = now
        if not (self._is_enabled and self._is_on):
            return
        self._integrate(now)
        time = self._filter.time
        if time is None:
            return
        timeout = 1.0 / p.frequency if math.isnan(p.sensor_timeout) else p.sensor_timeout
        if now > time and (p.predict_to_current_time or now - time >= timeout):
            self._set_command(now)
            self._filter.predict_to(now)
            self._flatten()
        assert self._filter.time is not None
        if self._filter.time > self._published_at or p.permit_corrected_publication:
            self._publish(self._filter.time)

    def _integrate(self, now: float) -> None:
        """Take in the measurements up to now in the order of their times."""
        while self._waiting and self._waiting[0][0] <= now:
            self._rewind_to(self._waiting[0][0])
            time, _, name, measurement = heapq.heappop(self._waiting)
            self._set_command(time)
            if not self._filter.process(measurement):
                self._reports.report(f"{name} rejected", f"a measurement of {name} is beyond its rejection threshold")
            self._flatten()
            if self._history is not None:
                self._history.record(name, measurement, self._filter)

    def _rewind_to(self, time: float) -> None:
        """Set the filter back to a time before its own, where there is a history; what came since waits again."""
        if self._history is None or self._filter.time is None or time >= self._filter.time:
            return
        undone = self._history.rewind(self._filter, time)
        if undone is None:
            text = f"a measurement is {self._filter.time - time:.2f} s late, which history_length does not cover"
            self._reports.report("history", f"{text}: it corrects the present state")
            return
        for name, measurement in undone:
            heapq.heappush(self._waiting, (measurement.time, next(self._order), name, measurement))

    def _flatten(self) -> None:
        """Keep a robot on a plane there."""
        if self._settings.two_d_mode and self._filter.time is not None:
            self._filter.process(planar_measurement(self._filter.time))

    def _publish(self, time: float) -> None:
        self._published_at = time
        p, state, covariance = self._settings, self._filter.state, self._filter.covariance
        stamp = time_message(round(1e9 * time))
        x, y, z, roll, pitch, yaw = state[:6].tolist()
        pose = Pose.from_xyz_rpy((x, y, z), (roll, pitch, yaw))
        base = p.base_link_output_frame or p.base_link_frame
        message = Odometry(child_frame_id=base)
        message.header.stamp, message.header.frame_id = stamp, p.world
        _fill(message.pose.pose.position, pose.position)
        _fill(message.pose.pose.orientation, pose.orientation)
        _fill(message.twist.twist.linear, state[6:9].tolist())
        _fill(message.twist.twist.angular, state[9:12].tolist())
        message.pose.covariance = covariance[:6, :6].ravel()
        message.twist.covariance = covariance[6:12, 6:12].ravel()
        self._odometry.publish(message)
        if p.publish_acceleration:
            self._publish_acceleration(stamp, base)
        if p.publish_tf:
            self._publish_transform(time, pose, base)

    def _publish_acceleration(self, stamp: Any, base: str) -> None:
        message = AccelWithCovarianceStamped()
        message.header.stamp, message.header.frame_id = stamp, base
        _fill(message.accel.accel.linear, self._filter.state[ACCELERATION].tolist())
        covariance = np.zeros((6, 6))
        covariance[:3, :3] = self._filter.covariance[ACCELERATION, ACCELERATION]
        message.accel.covariance = covariance.ravel()
        self._acceleration.publish(message)

    def _publish_transform(self, time: float, pose: Pose, base: str) -> None:
        """Publish the pose of the base in odom, or that of odom in the map."""
        p, child = self._settings, base
        if p.world == p.map_frame:
            child = p.odom_frame
            try:
                pose = pose @ self._look_up(time_message(round(1e9 * time)), p.base_link_frame, p.odom_frame)
            except TransformException as error:
                self._reports.report("odometry", f"{p.map_frame} -> {p.odom_frame} is not published: {error}")
                return
        message = TransformStamped(child_frame_id=child)
        message.header.stamp = time_message(round(1e9 * (time + p.transform_time_offset)))
        message.header.frame_id = p.world
        _fill(message.transform.translation, pose.position)
        _fill(message.transform.rotation, pose.orientation)
        self._broadcaster.sendTransform(message)

    # Control of the filter.

    def _set_pose(self, message: Any) -> None:
        """Continue from a pose at rest, unless it cannot be used."""
        time = seconds(message.header.stamp) or self._now
        source = Input("pose", "pose", "set_pose", np.arange(15) < 6, *(False,) * 2, 1, *(math.inf,) * 3, *(False,) * 2)
        try:
            found = Converter(source, self._settings).convert(
                message, time, self._filter.state, partial(self._look_up, message.header.stamp)
            )
        except (LocalizationError, TransformException) as error:
            self.get_logger().error(f"a pose on set_pose is not used: {error}")
            return
        self._forget()
        self._filter.state[:] = 0.0
        self._filter.covariance = _SET_VARIANCE * np.eye(15)
        for one in found:
            self._filter.process(one)
        self._set_at = time

    def _on_set_pose(self, request: Any, response: Any) -> Any:
        self._set_pose(request.pose)
        return response

    def _on_toggle(self, request: Any, response: Any) -> Any:
        response.status = request.on != self._is_on
        if response.status:
            self._is_on = request.on
            self._waiting.clear()
        else:
            self.get_logger().warning(f"the filter is {'on' if request.on else 'off'} already")
        return response

    def _on_enable(self, _: Any, response: Any) -> Any:
        self._is_enabled = True
        return response

    def _on_reset(self, _: Any, response: Any) -> Any:
        self._forget()
        return response


def _fill(message: Any, values: Any) -> None:
    """Set x, y, z (and w) of a message."""
    for name, value in zip("xyzw", values, strict=False):
        setattr(message, name, value)
