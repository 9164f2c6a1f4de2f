"""What AMCL's nodes share: scans, odometry and maps in; pose, particles and the transform to the odometry out."""

from __future__ import annotations

import math
import threading
from collections.abc import Callable
from typing import Any

import numpy as np
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.node import Node
from rclpy.qos import QoSProfile, qos_profile_sensor_data
from rclpy.task import Future
from rclpy.time import Time
from tf2_ros import TransformBroadcaster, TransformException, TransformListener

from daidalos.common.arrays import Array
from daidalos.common.errors import UserError
from daidalos.common.pose2 import between, compose
from daidalos.localization.amcl import DEFAULT_COVARIANCE, Amcl, Estimate
from daidalos.localization.errors import LocalizationError
from daidalos.mapping.grid import OccupancyGrid
from daidalos.mapping.scan import scan_problem
from daidalos.nodes.conversions import (
    grid_array,
    pose2_of,
    pose2_of_transform,
    pose_message,
    scan_data,
    transform_stamped,
)
from daidalos.nodes.hold_back import HoldBack
from daidalos.nodes.nav2_amcl._parameters import AmclParameters, listens_elsewhere
from daidalos.nodes.qos import LATCHED
from daidalos.nodes.scan_reports import LATE_NS, ScanReports
from daidalos.nodes.transforms import BlockingBuffer, SensorPoses
from daidalos.nodes.warming import warm_up_in_background
from daidalos.samples.fields import nanoseconds, time_message

MAX_SPEED, MAX_TURN = 10.0, 30.0
"""Speeds [m/s, rad/s] of odometry above which it is taken to have jumped."""

JUMP_DISTANCE, JUMP_ANGLE = 0.5, 1.0
"""Motion [m, rad] between two scans below which odometry is never taken to have jumped."""

TIME_BACK_NS = 1_000_000_000
"""How far [ns] behind the last scan a scan shows that time was set back."""

_WATCH_PERIOD = 0.5
_XY_YAW = (0, 1, 5)
"""Rows of a pose's covariance (6, 6) that hold x, y and yaw."""


class Localizer:
    """The filter between a node's topics, services and transforms.

    Parameters
    ----------
    node : Node
        Whose they are.
    settings : AmclParameters
    is_active : callable
        Returns whether scans are used at the moment.

    Attributes
    ----------
    last_pose : message or None
        The last pose, as published or as given.
    particles_wait_ns : int
        Least time [ns] between two publications of the particles.
    """

    def __init__(
        self,
        node: Node,
        settings: AmclParameters,
        is_active: Callable[[], bool],
    ) -> None:
        self._node, self._settings = node, settings
        self._is_active = is_active
        self._log = node.get_logger()
        self._reports = ScanReports(node)
        frames = f"{settings.global_frame_id} -> {settings.odom_frame_id}"
        self._hold_back = HoldBack(node.get_clock(), self._reports, frames)
        self._lock = threading.RLock()
        self._filter: Amcl | None = None
        self._grid: OccupancyGrid | None = None
        self._pose_is_known = False
        self._first_pose: tuple[Array, Array] | None = None
        self._wants_global = False
        self._last_scan_ns = 0
        self._last_odometry: Array | None = None
        self._waiting: tuple[int, Any] | None = None
        self.last_pose: Any = None
        self.particles_wait_ns = 0
        self._last_particles_ns = -math.inf
        self._create_publishers()
        self._buffer = BlockingBuffer()
        self._listener = TransformListener(self._buffer, node)
        self._broadcaster = TransformBroadcaster(node)
        self._inputs: list[Any] = []
        self._listen()
        self._timer = node.create_timer(_WATCH_PERIOD, self._watch)
        self._compiled: Future = warm_up_in_background("daidalos.localization", self._log)
        self._compiled.add_done_callback(lambda _: self.start())

    def _create_publishers(self) -> None:
        from geometry_msgs.msg import PoseArray, PoseWithCovarianceStamped
        from nav2_msgs.msg import ParticleCloud

        create = self._node.create_publisher
        self._pose_publisher = create(PoseWithCovarianceStamped, "amcl_pose", LATCHED)
        self._cloud_publisher = create(ParticleCloud, "particle_cloud", qos_profile_sensor_data)
        self._array_publisher = create(PoseArray, "particlecloud", 2)

    def _listen(self) -> None:
        """Subscribe to the topics that the parameters name."""
        from geometry_msgs.msg import PoseWithCovarianceStamped
        from nav_msgs.msg import OccupancyGrid as OccupancyGridMessage
        from sensor_msgs.msg import LaserScan

        for subscription in self._inputs:
            self._node.destroy_subscription(subscription)
        p, subscribe = self._settings, self._node.create_subscription
        self._sensor_poses = SensorPoses(self._buffer, p.base_frame_id, self._log)
        # A scan may wait for its odometry; the map and the services do not wait with it.
        scans = MutuallyExclusiveCallbackGroup()
        quality = QoSProfile(depth=5, reliability=qos_profile_sensor_data.reliability)
        self._inputs = [
            subscribe(LaserScan, p.scan_topic, self._on_scan, quality, callback_group=scans),
            subscribe(OccupancyGridMessage, p.map_topic, self.take_map, LATCHED),
            subscribe(PoseWithCovarianceStamped, "initialpose", self.take_initial_pose, 5),
        ]

    def destroy(self) -> None:
        """End the work that goes on without the node's entities."""
        self._node.destroy_timer(self._timer)
        self._listener.unregister()

    def reconfigure(self, settings: AmclParameters) -> None:
        """Continue with other parameters."""
        before, self._settings = self._settings, settings
        with self._lock:
            if self._filter is not None:
                self._filter.reconfigure(settings)
        if listens_elsewhere(before, settings):
            self._listen()

    def start(self) -> None:
        """Count the time without scans from now on."""
        self._reports.start()

    # Maps.

    @property
    def has_map(self) -> bool:
        """Whether there is a map."""
        return self._grid is not None

    def take_map(self, message: Any, *, replace: bool = False) -> bool:
        """Use a ``nav_msgs/msg/OccupancyGrid`` from now on, unless it cannot be used; return whether it is.

        Parameters
        ----------
        message
            The map.
        replace
            Whether it is used even if only the first one is wanted.
        """
        p, info = self._settings, message.info
        if self._grid is not None and p.first_map_only and not replace:
            return False
        try:
            cells = grid_array(message).copy()
        except UserError as error:
            self._log.error(str(error))
            return False
        if message.header.frame_id.lstrip("/") != p.global_frame_id.lstrip("/"):
            self._log.warning(
                f"the map is in the frame '{message.header.frame_id}', not in global_frame_id '{p.global_frame_id}'"
            )
        x, y, yaw = pose2_of(info.origin).tolist()
        # The message's resolution has 32 bits; the map's is what these say, such as 0.05.
        grid = OccupancyGrid(cells, float(str(np.float32(info.resolution))), (x, y, yaw))
        try:
            self._use_map(grid)
        except LocalizationError as error:
            self._log.error(f"a map is not used: {error}")
            return False
        self._log.info(f"Received a {info.width} X {info.height} map @ {info.resolution:.3f} m/pix")
        return True

    def _use_map(self, grid: OccupancyGrid) -> None:
        with self._lock:
            if self._filter is None:
                self._filter = Amcl(self._settings, grid)
            else:
                before = self._grid
                self._filter.set_map(grid)
                assert before is not None
                same_place = (before.resolution, before.origin) == (grid.resolution, grid.origin)
                if not same_place and self.last_pose is not None:
                    self._first_pose = (pose2_of(self.last_pose.pose.pose), DEFAULT_COVARIANCE)
                self._filter.request_nomotion_update()
            self._grid = grid
            self._begin_filter()

    # Where the robot starts.

    def take_initial_pose(self, message: Any) -> None:
        """Draw the particles around a ``geometry_msgs/msg/PoseWithCovarianceStamped``, unless it cannot be used."""
        frame, wanted = message.header.frame_id.lstrip("/"), self._settings.global_frame_id.lstrip("/")
        if frame != wanted:
            self._log.warning(f"an initial pose in the frame '{frame}' is ignored; it has to be in '{wanted}'")
            return
        pose, covariance = pose2_of(message.pose.pose), _covariance_of(message)
        if not (np.isfinite(pose).all() and np.isfinite(covariance).all()):
            self._log.error("an initial pose is ignored: it or its covariance is not finite")
            return
        with self._lock:
            if self._filter is not None and not self._filter.contains(pose):
                self._log.error(f"an initial pose is ignored: ({pose[0]:.2f}, {pose[1]:.2f}) m is outside of the map")
                return
            self.last_pose = message
            self._begin_at(self._moved_since(pose, message.header.stamp), self._usable(covariance))

    def take_saved_pose(self, pose: Array) -> None:
        """Draw the particles around a pose (x, y, yaw) with the default spread."""
        with self._lock:
            self._begin_at(pose, DEFAULT_COVARIANCE)

    def take_global_localization(self) -> None:
        """Draw the particles anywhere in the map."""
        with self._lock:
            self._wants_global, self._first_pose, self._pose_is_known = True, None, True
            self._begin_filter()

    def request_update(self) -> None:
        """Use the next scan even if the robot stands."""
        with self._lock:
            if self._filter is not None:
                self._filter.request_nomotion_update()

    def _begin_at(self, pose: Array, covariance: Array) -> None:
        self._first_pose, self._wants_global, self._pose_is_known = (pose, covariance), False, True
        self._begin_filter()

    def _begin_filter(self) -> None:
        """Draw the particles that were asked for, once there is a map."""
        if self._filter is None:
            return
        if self._wants_global:
            self._log.info("Initializing with uniform distribution")
            self._filter.global_localization()
        elif self._first_pose is not None:
            pose, covariance = self._first_pose
            self._log.info(f"Setting pose: {pose[0]:.3f} {pose[1]:.3f} {pose[2]:.3f}")
            self._filter.initialize(pose, covariance)
        self._wants_global, self._first_pose = False, None

    def _usable(self, covariance: Array) -> Array:
        """Return a covariance with a spread; that of a message that was not filled in has none."""
        if not covariance.any():
            return DEFAULT_COVARIANCE
        if np.linalg.eigvalsh(covariance).min() < -1e-9:
            self._log.warning("the covariance of an initial pose is not positive; the nearest that is one is used")
        return covariance

    def _moved_since(self, pose: Array, stamp: Any) -> Array:
        """Return a pose moved on by what odometry has done since it was given."""
        if not nanoseconds(stamp):
            return pose
        p = self._settings
        try:
            then = self._buffer.lookup_transform_core(p.odom_frame_id, p.base_frame_id, stamp)
            now = self._buffer.lookup_transform_core(p.odom_frame_id, p.base_frame_id, Time())
        except TransformException:
            return pose
        return compose(pose, between(pose2_of_transform(then.transform), pose2_of_transform(now.transform)))

    # Scans.

    async def _on_scan(self, scan: Any) -> None:
        self._reports.came()
        if not self._is_active() or not self._compiled.done() or not self._is_ready():
            return
        frame, p = scan.header.frame_id, self._settings
        mount = self._sensor_poses.mount(frame)
        if mount is None:
            self._refuse(frame, self._sensor_poses.missing(frame))
            return
        self._waiting = (self._reports.now_ns, scan)
        odometry = await self._buffer.transform_at(p.odom_frame_id, p.base_frame_id, scan.header.stamp)
        self._waiting = None
        if odometry is None:
            self._refuse(frame, f"{p.odom_frame_id} -> {p.base_frame_id} is not known at its time, but later")
            return
        data = scan_data(scan, mount)
        problem = scan_problem(data)
        if problem:
            self._refuse(frame, problem)
            return
        with self._lock:
            if self._filter is not None and self._is_active():
                self._use_scan(scan, data, pose2_of_transform(odometry.transform))

    def _is_ready(self) -> bool:
        """Return whether there are a map and a pose to begin with; report what is missing."""
        if self._filter is None:
            self._reports.report("map", f"waiting for a map on '{self._settings.map_topic}'")
        elif not self._pose_is_known:
            self._reports.report(
                "pose",
                "AMCL does not know where the robot is. Please set the initial pose: RViz's 2D Pose Estimate, "
                "the topic initialpose or the parameter set_initial_pose",
            )
        return self._filter is not None and self._pose_is_known

    def _refuse(self, frame: str, why: str) -> None:
        self._reports.report(why, f"a scan of '{frame}' is not used: {why}")

    def _use_scan(self, scan: Any, data: Any, odometry: Array) -> None:
        assert self._filter is not None
        stamp_ns = nanoseconds(scan.header.stamp)
        estimate = self._filter.update(odometry, data, odometry_jumped=self._jumped(stamp_ns, odometry))
        self._last_scan_ns, self._last_odometry = stamp_ns, odometry
        if estimate.updated:
            self._publish_pose(estimate, scan.header.stamp)
            self._publish_particles(estimate, stamp_ns)
        if estimate.lost:
            self._hold_back.begin(scan.header.frame_id)
        if self._settings.tf_broadcast and not self._hold_back.is_active:
            stamp = time_message(stamp_ns + round(1e9 * self._settings.transform_tolerance))
            frames = self._settings.global_frame_id, self._settings.odom_frame_id
            self._broadcaster.sendTransform(transform_stamped(estimate.map_to_odom, *frames, stamp))

    def _jumped(self, stamp_ns: int, odometry: Array) -> bool:
        """Return whether odometry moved as no robot can, or time went back, since the last scan."""
        before = self._last_odometry
        if before is None:
            return False
        if stamp_ns < self._last_scan_ns - TIME_BACK_NS:
            self._log.warning("time went back; the robot is looked for where it was and where odometry puts it")
            return True
        step = between(before, odometry)
        far, turn = math.hypot(float(step[0]), float(step[1])), abs(float(step[2]))
        passed = max(1e-9 * (stamp_ns - self._last_scan_ns), 0.0)
        if far <= max(JUMP_DISTANCE, MAX_SPEED * passed) and turn <= max(JUMP_ANGLE, MAX_TURN * passed):
            return False
        self._log.warning(
            f"odometry jumped by {far:.2f} m and {math.degrees(turn):.0f} degrees in {passed:.2f} s; the robot is "
            "looked for where it was and where odometry puts it"
        )
        return True

    def _watch(self) -> None:
        """Report a scan that waits for its odometry in vain, and that no scans come."""
        if not self._is_active() or not self._compiled.done():
            return
        p, waiting = self._settings, self._waiting
        if waiting is not None and self._reports.now_ns - waiting[0] > LATE_NS:
            try:
                self._buffer.lookup_transform_core(p.odom_frame_id, p.base_frame_id, waiting[1].header.stamp)
            except TransformException as error:
                self._refuse(waiting[1].header.frame_id, f"waiting for its odometry: {error}")
        elif waiting is None and self._reports.is_silent():
            topic = self._node.resolve_topic_name(p.scan_topic)
            count = self._node.count_publishers(topic)
            self._reports.report("silence", f"no scan comes on '{topic}', which has {count} publishers")

    # What is published.

    def _publish_pose(self, estimate: Estimate, stamp: Any) -> None:
        from geometry_msgs.msg import PoseWithCovariance, PoseWithCovarianceStamped
        from std_msgs.msg import Header

        covariance = np.zeros((6, 6))
        covariance[np.ix_(_XY_YAW, _XY_YAW)] = estimate.covariance
        pose = pose_message(estimate.pose)
        pose.position.z = self._settings.initial_pose.z
        message = PoseWithCovarianceStamped(
            header=Header(frame_id=self._settings.global_frame_id, stamp=stamp),
            pose=PoseWithCovariance(pose=pose, covariance=covariance.ravel()),
        )
        self.last_pose = message
        self._pose_publisher.publish(message)

    def _publish_particles(self, estimate: Estimate, stamp_ns: int) -> None:
        """Publish the particles on the topics that have subscribers, not more often than is wanted."""
        if 0 <= stamp_ns - self._last_particles_ns < self.particles_wait_ns:
            return
        self._last_particles_ns = stamp_ns
        from std_msgs.msg import Header

        cloud, array = self._cloud_publisher.handle.has_subscribers, self._array_publisher.handle.has_subscribers
        if not (cloud or array):
            return
        header = Header(frame_id=self._settings.global_frame_id, stamp=time_message(stamp_ns))
        poses = [pose_message(one) for one in estimate.particles]
        if cloud:
            from nav2_msgs.msg import Particle, ParticleCloud

            weights = estimate.weights.tolist()
            particles = [Particle(pose=pose, weight=weight) for pose, weight in zip(poses, weights, strict=True)]
            self._cloud_publisher.publish(ParticleCloud(header=header, particles=particles))
        if array:
            from geometry_msgs.msg import PoseArray

            self._array_publisher.publish(PoseArray(header=header, poses=poses))


def _covariance_of(message: Any) -> Array:
    """Return the covariance (3, 3) of x, y and yaw."""
    matrix = np.array(message.pose.covariance, dtype=np.float64).reshape(6, 6)
    chosen: Array = matrix[np.ix_(_XY_YAW, _XY_YAW)]
    return 0.5 * (chosen + chosen.T)
