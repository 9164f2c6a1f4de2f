"""Costmap as a managed node."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from rclpy.lifecycle import LifecycleState, TransitionCallbackReturn
from rclpy.node import Node
from rclpy.task import Future
from rclpy.time import Time
from tf2_ros import TransformException, TransformListener

from daidalos.common.errors import UserError
from daidalos.common.parameters import parameter
from daidalos.mapping.grid import OccupancyGrid
from daidalos.mapping.scan import LaserScanData
from daidalos.navigation.contracts import Input, Layer, NavigationContext
from daidalos.navigation.costmap.costmap import Costmap
from daidalos.navigation.costmap.costmap_filter import FilterInfo
from daidalos.navigation.costmap.footprint import Footprint
from daidalos.navigation.costmap.layered_costmap import CostmapParameters, LayeredCostmap
from daidalos.navigation.costmap.observation import CloudData, RangeData
from daidalos.navigation.errors import NavigationError
from daidalos.navigation.extensions import COSTMAP_LAYERS
from daidalos.nodes.action_results import TransformFailed
from daidalos.nodes.conversions import pose2_of_transform
from daidalos.nodes.cycles import wait_until
from daidalos.nodes.managed import ManagedNode
from daidalos.nodes.nav2_costmap_2d._costmap_filters import (
    listen_to_filter_info,
    occupancy_grid,
    output_publisher,
    serve_toggle,
)
from daidalos.nodes.nav2_costmap_2d._costmap_interface import CostmapInterface
from daidalos.nodes.nav2_costmap_2d._sensor_inputs import SensorInputs
from daidalos.nodes.nav2_costmap_2d._transform_age import TransformAges
from daidalos.nodes.navigation_extensions import ExtensionMaker
from daidalos.nodes.parameters import declare, declare_without_effect
from daidalos.nodes.qos import LATCHED
from daidalos.nodes.transforms import BlockingBuffer
from daidalos.nodes.warming import warm_up_in_background
from daidalos.samples.fields import nanoseconds

_POLL_HZ = 20.0
_NEVER = Time(nanoseconds=1)
"""Time of a costmap that was never updated with all its inputs; zero would mean that the time is not given."""
_FIRST_UPDATE_S = 15.0
_DEFAULT_PLUGINS = {
    "static_layer": "nav2_costmap_2d::StaticLayer",
    "obstacle_layer": "nav2_costmap_2d::ObstacleLayer",
    "inflation_layer": "nav2_costmap_2d::InflationLayer",
}
_WITHOUT_EFFECT = {"always_send_full_costmap": "the whole costmap is always published"}


@dataclass(frozen=True)
class CostmapNodeParameters(CostmapParameters):
    """Parameters of a costmap node, by their Nav2 names."""

    global_frame: str = parameter("map", "Frame of the costmap.", not_empty=True, read_only=True)
    robot_base_frame: str = parameter("base_link", "Frame of the robot's base.", not_empty=True, read_only=True)
    update_frequency: float = parameter(
        5.0, "Updates per second, from the next activation on; 0 for none.", unit="Hz", minimum=0.0
    )
    publish_frequency: float = parameter(
        1.0, "Publications per second, from the next activation on; 0 for none.", unit="Hz", minimum=0.0
    )
    transform_tolerance: float = parameter(
        0.3, "Age of the robot's transform from which it is not used.", unit="s", above=0.0
    )
    robot_radius: float = parameter(0.1, "Radius of a round robot.", unit="m", above=0.0, read_only=True)
    footprint: str = parameter(
        "[]", "Corners of the robot as [[x, y], ...], in metres; [] for a round robot.", read_only=True
    )
    footprint_padding: float = parameter(
        0.01, "Distance by which the corners are moved outwards.", unit="m", minimum=0.0, read_only=True
    )
    plugins: tuple[str, ...] = parameter(
        tuple(_DEFAULT_PLUGINS), "Names of the layers, the lowest first.", unique=True, read_only=True
    )
    filters: tuple[str, ...] = parameter(
        (), "Names of the costmap filters, which are applied after the layers.", unique=True, read_only=True
    )
    map_topic: str = parameter("/map", "Topic of the map.", not_empty=True, read_only=True)


class CostmapTimedOut(TransformFailed):
    """Sensors, maps and transforms were waited for in vain."""


class CostmapOutdated(NavigationError):
    """The costmap no longer shows what is around the robot."""

    code = "CONTROLLER_TIMED_OUT"


class CostmapNode(ManagedNode):
    """Node that updates and publishes a costmap; Nav2's `Costmap2DROS`.

    Parameters of the node are Nav2's. They are taken from the process's arguments, such as a parameter file for
    the container, under the costmap's own name.

    Parameters
    ----------
    name : str
        Such as ``local_costmap``; the node is ``local_costmap/local_costmap``.
    parent : Node
        The server that the costmap is for.
    arguments : sequence of str
        Arguments of ROS for this node alone, after those of the process.

    Attributes
    ----------
    layered : LayeredCostmap
        The costmap; hold `lock` while using it.
    lock : RLock
    updated : builtin_interfaces/msg/Time
        When the costmap was last updated with all its inputs known.
    pose_problem : str
        Why `robot_pose` was None the last time.
    """

    def __init__(self, name: str, parent: Node, arguments: Sequence[str] = ()) -> None:
        self._outer_namespace = parent.get_namespace().rstrip("/")
        namespace = f"{self._outer_namespace}/{name}"
        sim_time = str(parent.get_parameter("use_sim_time").value).lower()
        # Transforms are where the server has them, also where it remaps them to its namespace.
        transforms = [
            arg for topic in ("/tf", "/tf_static") for arg in ("-r", f"{topic}:={parent.resolve_topic_name(topic)}")
        ]
        # The names are said again for the case that the process's arguments rename its nodes.
        super().__init__(
            name,
            context=parent.context,
            cli_args=[
                "-r", f"{name}:__node:={name}", "-r", f"{name}:__ns:={namespace}", "-p", f"use_sim_time:={sim_time}",
                *transforms, *arguments,
            ],
        )  # fmt: skip
        self.lock = threading.RLock()
        self._ages = TransformAges()
        self.layered: LayeredCostmap | None = None
        self.updated = _NEVER.to_msg()
        self._settings = p = declare(self, CostmapNodeParameters, reconfigure=self._reconfigure)
        self.global_frame, self.base_frame = p.global_frame, p.robot_base_frame
        self.footprint = Footprint.from_parameters(p.footprint, p.robot_radius, p.footprint_padding)
        self.buffer = BlockingBuffer(node=self)
        self._listener = TransformListener(self.buffer, self)
        self._sensors = SensorInputs(self, judges_repetition=p.rolling_window)
        self._compiled = Future()
        self._timers: list[Any] = []

    def _reconfigure(self, parameters: CostmapNodeParameters) -> None:
        self._settings = parameters

    # Transitions.

    def configure(self) -> None:
        """Make the layers, the subscriptions that they need and the publishers."""
        declare_without_effect(self, _WITHOUT_EFFECT)
        layers = [self._make_layer(name) for name in (*self._settings.plugins, *self._settings.filters)]
        for name in self._settings.filters:
            serve_toggle(self, name)
        self.layered = LayeredCostmap(self._settings, layers)
        kinds = [type(one) for layer in layers for one in (layer, *layer.contained)]
        self._compiled = warm_up_in_background("daidalos.navigation", self.get_logger(), kinds)
        self._publishers = [output_publisher(self, layer, one) for layer in layers for one in layer.outputs]
        self._interface = CostmapInterface(self)

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Start to update and publish."""
        self._timers = [
            self.create_timer(1.0 / frequency, callback)
            for frequency, callback in (
                (self._settings.update_frequency, self._update),
                (self._settings.publish_frequency, self._publish),
            )
            if frequency > 0.0
        ]
        return super().on_activate(state)

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Cease to update and publish."""
        for timer in self._timers:
            self.destroy_timer(timer)
        self._timers = []
        return super().on_deactivate(state)

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Clear the costs."""
        with self.lock:
            self.layered, self._updates, self.updated = None, 0, _NEVER.to_msg()
        return super().on_cleanup(state)

    # Layers.

    def outer_topic(self, topic: str) -> str:
        """Return the name of a topic of a layer; a relative one stands in the namespace of the server."""
        return topic if topic.startswith("/") else f"{self._outer_namespace}/{topic}"

    @property
    def extension_context(self) -> NavigationContext:
        """What layers, planners and controllers of the costmap may use."""
        return NavigationContext(
            footprint=self.footprint,
            frequency=self._settings.update_frequency,
            global_frame=self.global_frame,
            base_frame=self.base_frame,
            track_unknown_space=self._settings.track_unknown_space,
            locate=self._locate,
        )

    def _locate(self, frame: str) -> tuple[Any, float] | None:
        """Return the latest pose of a frame in the costmap's frame and its age [s], None while it is not known."""
        try:
            found, age = self._latest_transform(frame)
        except TransformFailed:
            return None
        return (np.zeros(3) if found is None else pose2_of_transform(found.transform)), age

    def _make_layer(self, name: str) -> Layer:
        maker = ExtensionMaker(self, self.extension_context)
        layer = maker.make(COSTMAP_LAYERS, name, _DEFAULT_PLUGINS.get(name, ""))
        listeners: dict[type, Callable[[Input], None]] = {
            OccupancyGrid: self._listen_to_map,
            LaserScanData: self._sensors.listen_to_scans,
            CloudData: self._sensors.listen_to_clouds,
            RangeData: self._sensors.listen_to_ranges,
            FilterInfo: partial(listen_to_filter_info, self),
        }
        for one in layer.inputs:
            listeners[one.type](one)
        return layer

    def _listen_to_map(self, listened: Input) -> None:
        from nav_msgs.msg import OccupancyGrid as GridMessage

        def take(message: Any) -> None:
            try:
                grid = occupancy_grid(message)
            except UserError as error:
                self.get_logger().error(str(error))
                return
            with self.lock:
                listened.take(grid)

        topic = listened.topic or self._settings.map_topic
        self.create_subscription(GridMessage, topic, take, LATCHED if listened.latched else 1)

    # Cycle.

    def robot_pose(self) -> Any | None:
        """Return the latest pose (x, y, yaw) of the robot in the costmap's frame.

        None while it is not known, or older than ``transform_tolerance``.
        """
        try:
            return self.pose_of(self.base_frame)
        except TransformFailed as problem:
            self.pose_problem = str(problem)
            return None

    def pose_of(self, frame: str) -> Any:
        """Return the latest pose (x, y, yaw) of a frame in the costmap's frame.

        Raises
        ------
        TransformFailed
            It is not known, or older than ``transform_tolerance``.
        """
        found, age = self._latest_transform(frame)
        if found is None:
            return np.zeros(3)
        if age > self._settings.transform_tolerance:
            raise TransformFailed(
                f"the transform from {frame} to {self.global_frame} is {age:.3g} s old, "
                f"longer than transform_tolerance {self._settings.transform_tolerance:g} s"
            )
        return pose2_of_transform(found.transform)

    def _latest_transform(self, frame: str) -> tuple[Any, float]:
        """Return the latest transform of a frame, None for the costmap's own, and its age [s]: 0 for static ones."""
        if frame == self.global_frame:
            return None, 0.0
        try:
            found = self.buffer.lookup_transform(self.global_frame, frame, Time())
        except TransformException as error:
            reason = "" if frame == self.base_frame else f": {error}"
            raise TransformFailed(f"there is no transform from {frame} to {self.global_frame}{reason}") from None
        stamp_ns = nanoseconds(found.header.stamp)
        if not stamp_ns:
            return found, 0.0
        return found, self._ages.age(frame, stamp_ns * 1e-9, self.get_clock().now().nanoseconds * 1e-9)

    def age_of_data(self, *frames: str) -> float:
        """Return how old the oldest input of a layer or transform of some frames is, as a share of what is allowed.

        Raises
        ------
        TransformFailed
            A transform is not known.
        """
        ages = [self._latest_transform(frame)[1] / max(self._settings.transform_tolerance, 1e-6) for frame in frames]
        now = self.get_clock().now().nanoseconds * 1e-9
        with self.lock:
            layers = self.layered.layers if self.layered is not None else ()
            ages += [layer.age_of_input(now) for layer in layers if layer.enabled]
        return max(ages, default=0.0)

    def require_current(self) -> None:
        """Check that the costmap shows what is around the robot.

        Raises
        ------
        CostmapOutdated
            A layer lacks an input.
        """
        missing = self._missing_input()
        if missing:
            raise CostmapOutdated(f"the {self.get_name()} is out of date: {missing}")

    async def until_current(self, node: Node, limit_s: float) -> None:
        """Wait until the map and the robot's place on it are known.

        Parameters
        ----------
        node : Node
            The node whose executor waits.
        limit_s : float
            How long [s] it may take once the algorithms are compiled; the very first update may take longer, as
            servers are active here before their costmaps have seen anything.

        Raises
        ------
        CostmapTimedOut
            It took longer.
        """
        await self._compiled
        limit_s = limit_s if self._is_complete else max(limit_s, _FIRST_UPDATE_S)
        if not await wait_until(self._is_current, node, _POLL_HZ, limit_s):
            raise CostmapTimedOut(f"the {self.get_name()} is not known yet: {self._missing_inputs()}")

    def _is_current(self) -> bool:
        return self._is_complete and not self._missing_input()

    @property
    def _is_complete(self) -> bool:
        """Whether it was updated with all its inputs since it was configured."""
        return bool(self.updated != _NEVER.to_msg())

    def _missing_input(self) -> str:
        """Return what the first layer that lacks an input lacks, in words."""
        now = self.get_clock().now().nanoseconds * 1e-9
        with self.lock:
            layers = self.layered.layers if self.layered is not None else ()
            used = (layer for layer in layers if layer.enabled)
            return next((missing for layer in used if (missing := layer.missing_input(now))), "")

    def _missing_inputs(self) -> str:
        if self.robot_pose() is None:
            return self.pose_problem
        return self._missing_input() or "it was not yet updated"

    _updates = 0
    pose_problem = ""

    def _update(self) -> None:
        if not self._compiled.done():
            return
        pose = self.robot_pose()
        if pose is None:
            self.get_logger().info(f"waiting for the robot's pose: {self.pose_problem}", throttle_duration_sec=5.0)
        if pose is None or self.layered is None:
            return
        with self.lock:
            now = self.get_clock().now()
            self.layered.update(pose, now.nanoseconds * 1e-9)
            self._updates += 1
            if not self._missing_input():
                self.updated = now.to_msg()
        for publish in self._publishers:
            publish()

    def snapshot(self) -> Costmap:
        """Return a copy of the costmap."""
        assert self.layered is not None
        with self.lock:
            return self.layered.costmap.copy()

    def _publish(self) -> None:
        if self._updates:
            self._interface.publish()
