"""A robot with a lidar in a flat world around a localization node, on a stage that the test steps."""

from __future__ import annotations

import math
from array import array
from typing import Any

import numpy as np
import pytest
from geometry_msgs.msg import PoseWithCovarianceStamped
from nav_msgs.msg import OccupancyGrid
from sensor_msgs.msg import LaserScan
from tf2_msgs.msg import TFMessage

from daidalos.common.kernels import warm_up
from daidalos.common.pose2 import compose, wrap
from daidalos.nodes.conversions import grid_message, pose2_of, pose2_of_transform, pose_message, transform_stamped
from localization.wandering import Wanderer, map_of
from navigation.flat_world import FlatRobot, arena
from nodes.stepped import LATCHED, Stage

START = np.array([1.5, 1.5, 0.3])
WORLD = arena()
MAP = map_of(WORLD, 8.0, 6.0)
SENSOR_POSE = (-0.064, 0.0, 0.0)


@pytest.fixture(scope="session")
def compiled() -> None:
    """Compile the kernels of localization."""
    warm_up("daidalos.localization")


class Walk:
    """A robot that wanders, its scans and transforms, and what a localization node publishes."""

    def __init__(self, stage: Stage, start: np.ndarray = START) -> None:
        self.stage = stage
        self.robot = FlatRobot(WORLD, start.copy(), beams=180, max_range=12.0, seed=1, sensor_pose=SENSOR_POSE)
        self.wanderer = Wanderer(self.robot, 1)
        self.odometry = np.zeros(3)
        self.map_to_odom: list[Any] = []
        self.poses = stage.collect(PoseWithCovarianceStamped, "amcl_pose", LATCHED)
        self._transforms = stage.node.create_publisher(TFMessage, "/tf", 100)
        self._scans = stage.node.create_publisher(LaserScan, "scan", 10)
        self._maps = stage.node.create_publisher(OccupancyGrid, "map", LATCHED)
        stage.node.create_subscription(TFMessage, "/tf", self._take_transforms, 100)
        mount = transform_stamped(SENSOR_POSE, "base_footprint", "laser", stage.stamp)
        stage.publish("/tf_static", TFMessage(transforms=[mount]), LATCHED)

    def _take_transforms(self, message: TFMessage) -> None:
        self.map_to_odom += [one for one in message.transforms if one.header.frame_id == "map"]

    def publish_map(self, grid: Any = MAP, frame: str = "map") -> None:
        """Publish a map."""
        message = grid_message(grid.data, grid.resolution, grid.origin[:2], frame, self.stage.stamp)
        message.info.origin = pose_message(grid.origin)
        self._maps.publish(message)
        self.stage.step()

    def guess(self, pose: Any, frame: str = "map", covariance: Any = (0.25, 0.25, 0.07)) -> None:
        """Publish an initial pose, as RViz does."""
        message = PoseWithCovarianceStamped()
        message.header.frame_id = frame
        message.pose.pose = pose_message(pose)
        for index, value in zip((0, 7, 35), covariance, strict=True):
            message.pose.covariance[index] = value
        self.stage.publish("initialpose", message)
        self.stage.step()

    def look(self, *, with_odometry: bool = True, **changes: Any) -> None:
        """Publish odometry and a scan at a new time; `changes` are those of the scan."""
        self.stage.step(0.1)
        if with_odometry:
            moved = transform_stamped(self.odometry, "odom", "base_footprint", self.stage.stamp)
            self._transforms.publish(TFMessage(transforms=[moved]))
        seen = self.robot.scan()
        scan = LaserScan(
            angle_min=seen.angle_min,
            angle_increment=seen.angle_increment,
            range_min=seen.range_min,
            range_max=seen.range_max,
            ranges=array("f", np.asarray(seen.ranges).tolist()),
        )
        scan.header.stamp, scan.header.frame_id = self.stage.stamp, "laser"
        for name, value in changes.items():
            setattr(scan, name, value)
        self._scans.publish(scan)
        self.stage.step(0.02)

    def walk(self, steps: int) -> None:
        """Drive on, with a scan at each step."""
        for _ in range(steps):
            self.odometry, _, _ = self.wanderer.step()
            self.look()

    def carry(self, pose: Any) -> None:
        """Put the robot elsewhere; its odometry does not notice."""
        self.wanderer.carry(pose)

    @property
    def found(self) -> np.ndarray:
        """The robot's pose by the last transform."""
        return compose(pose2_of_transform(self.map_to_odom[-1].transform), self.odometry)

    def error(self) -> tuple[float, float]:
        """Return how far off the last transform is [m, rad]."""
        away = self.found - self.robot.pose
        return math.hypot(*away[:2]), abs(float(wrap(away[2])))

    def published(self) -> np.ndarray:
        """Return the last published pose."""
        return pose2_of(self.poses[-1].pose.pose)
