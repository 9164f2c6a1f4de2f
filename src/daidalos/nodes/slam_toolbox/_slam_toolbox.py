"""Base of slam_toolbox's nodes: map and robot pose from scans and odometry."""

from __future__ import annotations

import threading
from collections import deque
from typing import Any, ClassVar

import numpy as np
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.clock import Clock, ClockType
from rclpy.duration import Duration
from rclpy.lifecycle import LifecycleState, TransitionCallbackReturn
from rclpy.logging import LoggingSeverity
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.task import Future

from daidalos.mapping.errors import MappingError
from daidalos.nodes.conversions import (
    grid_message,
    pose2_of_transform,
    pose_message,
    scan_data,
    transform_stamped,
)
from daidalos.nodes.hold_back import HoldBack
from daidalos.nodes.managed import ManagedNode
from daidalos.nodes.parameters import declare, declare_without_effect
from daidalos.nodes.qos import LATCHED
from daidalos.nodes.scan_reports import LATE_NS, ScanReports
from daidalos.nodes.slam_toolbox._graph_markers import graph_markers
from daidalos.nodes.slam_toolbox._moved_scans import MovedScans
from daidalos.nodes.slam_toolbox._parameters import WITHOUT_EFFECT, SlamToolboxParameters
from daidalos.nodes.slam_toolbox._saved_graphs import SavedGraphs
from daidalos.nodes.warming import warm_up_in_background
from daidalos.samples.fields import nanoseconds, time_message

_SCANS_A_MAP = 100
"""Scans that one publication of the map may move to where a loop closure wants them."""

_AUTOSTART = 1.0
"""Time [s] after which a node that nobody configures starts by itself, as before it had a lifecycle."""

_WATCH_PERIOD = 0.5
"""Time [s] between looks at scans that wait for their transform."""


class SlamToolbox(ManagedNode):
    """Node that publishes ``map``, ``pose`` and the transform from ``map_frame`` to ``odom_frame``.

    Its parameters are those of its `kind`. Without the parameter ``use_lifecycle_manager`` it configures and
    activates itself.
    """

    kind: ClassVar[type[SlamToolboxParameters]] = SlamToolboxParameters
    keeps_every_scan: ClassVar[bool] = False
    """Whether scans wait for their turn; otherwise newer ones take the place of older ones."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("slam_toolbox", **kwargs)
        from tf2_ros import TransformBroadcaster, TransformListener

        from daidalos.nodes.transforms import BlockingBuffer, SensorPoses

        self.settings = p = declare(self, self.kind, reconfigure=self._reconfigure)
        # Launch files that give it, even as false, change the state themselves.
        is_managed = p.use_lifecycle_manager or "use_lifecycle_manager" in self._parameter_overrides
        declare_without_effect(self, WITHOUT_EFFECT)
        for name in ("paused_new_measurements", "paused_processing", "interactive_mode"):
            self.declare_parameter(name, value=False)
        self._apply_logging()
        self.slam: Any = None
        self.ready: Future = Future()
        """Done when the algorithms are compiled and scans are processed."""
        self._saved: Any = None
        self.lock = threading.Lock()
        self._reports = ScanReports(self)
        self._hold_back = HoldBack(
            self.get_clock(), self._reports, f"{self.settings.map_frame} -> {self.settings.odom_frame}"
        )
        self._waiting: deque[tuple[int, Any]] = deque(maxlen=None if self.keeps_every_scan else p.scan_queue_size)
        self._current: tuple[int, Any] | None = None
        self._timers_of_activity: list[Any] = []
        self._buffer = BlockingBuffer(Duration(seconds=p.tf_buffer_duration))
        self._listener = TransformListener(self._buffer, self)
        self._sensor_poses = SensorPoses(self._buffer, p.base_frame, self.get_logger())
        self._broadcaster = TransformBroadcaster(self)
        self._moved_scans: MovedScans | None = None
        self._steady = Clock(clock_type=ClockType.STEADY_TIME)
        self._compiled = warm_up_in_background("daidalos.mapping", self.get_logger())
        self._start_timer = None if is_managed else self.create_timer(_AUTOSTART, self._autostart, clock=self._steady)

    # Start and end.

    def _autostart(self) -> None:
        assert self._start_timer is not None
        self.destroy_timer(self._start_timer)
        self._start_timer = None
        if self.current_state.label == "unconfigured" and self.trigger_configure() == TransitionCallbackReturn.SUCCESS:
            self.trigger_activate()

    def configure(self) -> None:
        """Read the saved map, and create publishers, services and the subscription of scans."""
        from geometry_msgs.msg import PoseWithCovarianceStamped
        from nav_msgs.msg import MapMetaData, OccupancyGrid
        from nav_msgs.srv import GetMap
        from sensor_msgs.msg import LaserScan
        from slam_toolbox.srv import Pause, Reset, SaveMap
        from visualization_msgs.msg import MarkerArray

        p = self.settings
        graphs = SavedGraphs(self)
        self._saved = graphs.load(p.map_file_name) if p.map_file_name else None
        self._scans, self.drawn_keys = 0, -1
        self.map_to_odom: Any = None
        self._map_publisher = self.create_publisher(OccupancyGrid, p.map_name, LATCHED)
        self._metadata_publisher = self.create_publisher(MapMetaData, f"{p.map_name}_metadata", LATCHED)
        self._pose_publisher = self.create_publisher(PoseWithCovarianceStamped, "pose", 10)
        self._graph_publisher = self.create_publisher(MarkerArray, "slam_toolbox/graph_visualization", 1)
        qos = QoSProfile(depth=p.scan_queue_size, reliability=ReliabilityPolicy.BEST_EFFORT)
        self.create_subscription(LaserScan, p.scan_topic, self._on_scan, qos)
        self.create_service(GetMap, "slam_toolbox/dynamic_map", self._on_get_map)
        self.create_service(Pause, "slam_toolbox/pause_new_measurements", self._on_pause)
        self.create_service(Reset, "slam_toolbox/reset", self._on_reset)
        if p.use_map_saver:
            self.create_service(SaveMap, "slam_toolbox/save_map", self._on_save)
        self._moved_scans = MovedScans(self)
        self.ready = Future()
        self._compiled.add_done_callback(self._begin)

    def _begin(self, compiled: Future) -> None:
        """Start to process scans."""
        compiled.result()
        with self.lock:
            self.slam = self.new_slam(self._saved)
            if self._saved is not None:
                self._put_robot()
        self._saved = None
        self._reports.start()
        self.get_logger().info("ready for scans")
        self.ready.set_result(None)

    def new_slam(self, saved: Any = None) -> Any:
        """Return the library's object of a new map, or of a saved one."""
        from daidalos.mapping.slam import Slam

        slam = Slam(self.settings, saved)
        # Where every scan is used they wait for the loops, so that the same scans give the same map.
        slam.defers_closing = not self.keeps_every_scan
        return slam

    def _put_robot(self) -> None:
        """Set where the robot starts in the map, by the parameters: at a pose, or where the map begins."""
        p = self.settings
        if p.map_start_pose:
            self.slam.start_at(p.map_start_pose)
        elif p.map_start_at_dock:
            self.slam.start_at_first()
        else:
            self.slam.start_at((0.0, 0.0, 0.0))

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Start to work on scans and to publish."""
        p = self.settings
        self._reports.start()
        scans, transforms = MutuallyExclusiveCallbackGroup(), MutuallyExclusiveCallbackGroup()
        # A scan may wait for its odometry; the map and the services do not wait with it.
        self._pump = self.create_timer(0.0, self._work, scans, clock=self._steady)
        self._closing = self.create_timer(0.0, self._close_loops, MutuallyExclusiveCallbackGroup(), clock=self._steady)
        self._timers_of_activity = [
            self._pump,
            self._closing,
            self.create_timer(p.map_update_interval, self._publish_map),
            self.create_timer(_WATCH_PERIOD, self._watch, clock=self._steady),
        ]
        if p.transform_publish_period > 0.0:
            timer = self.create_timer(p.transform_publish_period, self._publish_transform, transforms)
            self._timers_of_activity.append(timer)
        return super().on_activate(state)

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Stop to work on scans and to publish."""
        for timer in self._timers_of_activity:
            self.destroy_timer(timer)
        self._timers_of_activity = []
        self._waiting.clear()
        return super().on_deactivate(state)

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Forget the map."""
        if self._moved_scans is not None:
            self._moved_scans.close()
            self._moved_scans = None
        with self.lock:
            self.slam = None
        return super().on_cleanup(state)

    def _reconfigure(self, parameters: SlamToolboxParameters) -> None:
        self.settings = parameters
        self._apply_logging()
        if self.slam is not None:
            with self.lock:
                self.slam.reconfigure(parameters)

    def _apply_logging(self) -> None:
        if self.settings.debug_logging:
            self.get_logger().set_level(LoggingSeverity.DEBUG)

    # Scans.

    def resume(self) -> None:
        """Go on with the scans that wait."""
        if self.is_active:
            self._pump.reset()

    def _on_scan(self, scan: Any) -> None:
        self._reports.came()
        if not self.is_active or self.is_set("paused_new_measurements"):
            return
        self._scans += 1
        if self._scans % self.settings.throttle_scans:
            return
        self._waiting.append((self._reports.now_ns, scan))
        self._pump.reset()

    async def _work(self) -> None:
        """Work on the scan that has waited longest."""
        self._pump.cancel()
        if self.slam is None or not self._waiting or self.is_set("paused_processing"):
            return
        self._current = self._waiting.popleft()
        try:
            await self._process(self._current[1])
        finally:
            self._current = None
        if self._waiting:
            self.resume()

    async def _process(self, scan: Any) -> None:
        p, frame = self.settings, scan.header.frame_id
        mount = self._sensor_poses.mount(frame)
        if mount is None:
            why = self._sensor_poses.missing(frame)
            self._reports.report(f"mount {frame}", f"scans of '{frame}' are not used: {why}")
            return
        odometry = await self._buffer.transform_at(p.odom_frame, p.base_frame, scan.header.stamp)
        if odometry is None:
            text = f"a scan of '{frame}' is not used: {p.odom_frame} -> {p.base_frame} is known for later times only"
            self._reports.report("late", text)
            return
        with self.lock:
            if self.slam is None:
                return
            data = scan_data(scan, mount)
            result = self.slam.add_scan(nanoseconds(scan.header.stamp), data, pose2_of_transform(odometry.transform))
            self.map_to_odom = self.slam.map_to_odom if self.slam.key_count else None
            self._after_scan(result)
        if self.slam.closing_is_due:
            self._closing.reset()
        if not result.fits:
            self._hold_back.begin(frame)
        if result.problem:
            self._reports.report(result.problem.split(":")[0], f"a scan of '{frame}': {result.problem}")
        if result.matched or result.added:
            self._publish_pose(result, scan.header.stamp)

    def _close_loops(self) -> None:
        """Close loops of the newest key scan beside the scans that come meanwhile."""
        self._closing.cancel()
        with self.lock:
            slam = self.slam
            snapshot = None if slam is None else slam.snapshot_to_close()
        if snapshot is None:
            return
        correction = slam.find_correction(snapshot)
        with self.lock:
            if self.slam is not slam:
                return
            _, has_moved = slam.apply(correction)
            if has_moved:
                self.map_to_odom = slam.map_to_odom
        if slam.closing_is_due and self.is_active:
            self._closing.reset()

    def _after_scan(self, result: Any) -> None:
        """Do what a kind of node does after each scan, with the lock held."""

    def _watch(self) -> None:
        """Report a scan that waits for its odometry in vain, and that no scans come."""
        p = self.settings
        if self._current is not None and self._reports.now_ns - self._current[0] > LATE_NS:
            scan = self._current[1]
            _, why = self._buffer.can_transform_core(p.odom_frame, p.base_frame, scan.header.stamp)
            text = f"scans of '{scan.header.frame_id}' wait for the transform {p.odom_frame} -> {p.base_frame}"
            self._reports.report("odometry", f"{text}: {why or 'it has just come'}")
        if self._reports.is_silent() and not self.is_set("paused_new_measurements"):
            publishers = self.count_publishers(p.scan_topic)
            self._reports.report("silence", f"no scans come on {p.scan_topic}, which has {publishers} publishers")

    def _publish_pose(self, result: Any, stamp: Any) -> None:
        if not self._pose_publisher.get_subscription_count():
            return
        from geometry_msgs.msg import PoseWithCovarianceStamped

        message = PoseWithCovarianceStamped()
        message.header.stamp, message.header.frame_id = stamp, self.settings.map_frame
        message.pose.pose = pose_message(result.pose)
        covariance = np.zeros((6, 6))
        planar = result.covariance
        covariance[:2, :2] = self.settings.position_covariance_scale * planar[:2, :2]
        covariance[5, 5] = self.settings.yaw_covariance_scale * planar[2, 2]
        message.pose.covariance = covariance.ravel()
        self._pose_publisher.publish(message)

    def _publish_transform(self) -> None:
        if self.map_to_odom is None or self._hold_back.is_active:
            return
        # Stamped ahead, as slam_toolbox does: those who ask for "now" need not wait for the next one.
        stamp = time_message(self.get_clock().now().nanoseconds + round(1e9 * self.settings.transform_timeout))
        frames = self.settings.map_frame, self.settings.odom_frame
        self._broadcaster.sendTransform(transform_stamped(self.map_to_odom, *frames, stamp))

    # The map.

    def _map_message(self) -> Any:
        with self.lock:
            grid = self.slam.grid(_SCANS_A_MAP)
        stamp = self.get_clock().now().to_msg()
        return grid_message(grid.data, grid.resolution, grid.origin, self.settings.map_frame, stamp)

    def _publish_map(self) -> None:
        if self.slam is None:
            return
        self._publish_graph()
        with self.lock:  # after a loop closure the grid goes on changing although no scan is added
            if self.slam.key_count == self.drawn_keys and not self.slam.render(0):
                return
        self.drawn_keys = self.slam.key_count
        message = self._map_message()
        if message.info.width and message.info.height:
            self._map_publisher.publish(message)
            self._metadata_publisher.publish(message.info)

    def _publish_graph(self) -> None:
        if self._graph_publisher.get_subscription_count() and not self.is_set("interactive_mode"):
            self.publish_graph(with_scans=True)

    def publish_graph(self, *, with_scans: bool) -> None:
        """Publish the pose graph's edges, and its key scans where they cannot be moved."""
        with self.lock:
            poses, edges = self.slam.key_poses, self.slam.edges
        stamp = self.get_clock().now().to_msg()
        markers = graph_markers(poses, edges, self.settings.map_frame, stamp, with_scans=with_scans)
        self._graph_publisher.publish(markers)

    def _on_get_map(self, request: Any, response: Any) -> Any:
        if self.slam is not None:
            response.map = self._map_message()
        return response

    def _on_save(self, request: Any, response: Any) -> Any:
        from daidalos.mapping.map_file import save_map

        name = request.name.data or "map"
        if self.slam is None or not self.slam.key_count:
            self.get_logger().warning("there is no map to be saved yet")
            response.result = response.RESULT_NO_MAP_RECEIEVD
            return response
        with self.lock:
            grid = self.slam.grid()
        try:
            save_map(grid, name)
        except (OSError, MappingError) as error:
            self.get_logger().error(f"cannot save the map: {error}")
            response.result = response.RESULT_UNDEFINED_FAILURE
            return response
        response.result = response.RESULT_SUCCESS
        self.get_logger().info(f"saved the map to {name}.pgm and {name}.yaml")
        return response

    # What kinds of nodes differ in.

    def refusal_to_save(self) -> str:
        """Return why the pose graph is not saved now, an empty string where it is."""
        return ""

    def refusal_to_load(self, request: Any) -> str:
        """Return why a pose graph is not loaded like that, an empty string where it is."""
        if request.match_type in (request.START_AT_FIRST_NODE, request.START_AT_GIVEN_POSE):
            return ""
        if request.match_type == request.LOCALIZE_AT_POSE:
            return "match_type 3 (LOCALIZE_AT_POSE) needs a node that localizes; here it is 1 or 2"
        return f"expected match_type 1 (first node) or 2 (given pose), found {request.match_type}"

    def allows_interaction(self) -> bool:
        """Return whether this kind of node has an interactive mode."""
        return True

    def use(self, slam: Any) -> None:
        """Take a map in place of the one that there was."""
        with self.lock:
            self.slam = slam
            self.map_to_odom = None
            self.drawn_keys = -1
            if self._moved_scans is not None:
                self._moved_scans.forget()
            self._waiting.clear()

    # Pauses and beginning anew.

    def is_set(self, flag: str) -> bool:
        """Return the value of a parameter that is true or false."""
        return bool(self.get_parameter(flag).value)

    def set_flag(self, flag: str, value: bool) -> None:
        """Set a parameter that is true or false."""
        from rclpy.parameter import Parameter

        self.set_parameters([Parameter(flag, value=value)])

    def _on_pause(self, request: Any, response: Any) -> Any:
        paused = not self.is_set("paused_new_measurements")
        self.set_flag("paused_new_measurements", paused)
        self.get_logger().info("new scans are ignored" if paused else "new scans are used")
        response.status = True
        return response

    def _on_reset(self, request: Any, response: Any) -> Any:
        if self.slam is not None:
            self.use(self.new_slam())
        if request.pause_new_measurements:
            self.set_flag("paused_new_measurements", value=True)
        response.result = response.RESULT_SUCCESS
        self.get_logger().info("began with an empty map")
        return response
