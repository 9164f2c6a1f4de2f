"""The collision monitor's managed node, with a robot that drives towards a wall."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from geometry_msgs.msg import (
    Point32,
    Polygon,
    PolygonInstance,
    PolygonInstanceStamped,
    PolygonStamped,
    Twist,
    Vector3,
)
from nav2_msgs.msg import CollisionMonitorState
from nav2_msgs.srv import Toggle
from rcl_interfaces.msg import Log
from rclpy.lifecycle import TransitionCallbackReturn
from rclpy.parameter import Parameter
from sensor_msgs.msg import LaserScan, PointCloud2, Range
from sensor_msgs_py.point_cloud2 import create_cloud_xyz32
from std_msgs.msg import Header
from visualization_msgs.msg import MarkerArray

from daidalos.nodes.nav2_collision_monitor.collision_monitor import CollisionMonitorNode
from daidalos.samples.fields import time_message
from nodes.stepped import Stage

pytestmark = pytest.mark.timeout(120)
Set = Callable[[dict[str, Any]], Stage]
STOP = {"type": "circle", "radius": 0.5, "action_type": "stop", "min_points": 3}
KINDS = {"scan": LaserScan, "pointcloud": PointCloud2, "range": Range, "polygon": PolygonInstanceStamped}


class Bench:
    """The node, active, and the robot with a sensor that sees a wall at x = 2 m."""

    def __init__(self, set_stage: Set, zone: dict[str, Any] = STOP, sensor: str = "scan", **parameters: Any) -> None:
        values = {
            "base_frame_id": "base_link", "polygons": ["zone"], "zone": zone, "observation_sources": ["sensor"],
            "sensor": {"type": sensor, "topic": "sensor"}, "source_timeout": 0.3, "transform_tolerance": 0.2,
            "state_topic": "state",
        }  # fmt: skip
        self.stage = stage = set_stage({"/collision_monitor": values | parameters})
        self.sensor = sensor
        self.log = stage.collect(Log, "/rosout", 100)
        self.node = stage.add(CollisionMonitorNode())
        self.robot = stage.add_robot()
        self.states = stage.collect(CollisionMonitorState, "state")
        self.commands = stage.node.create_publisher(Twist, "cmd_vel_smoothed", 1)
        self.seen = stage.node.create_publisher(KINDS[sensor], "sensor", 1)
        assert self.node.trigger_configure() == TransitionCallbackReturn.SUCCESS
        self.node.trigger_activate()
        stage.step_until(lambda: self.commands.get_subscription_count() > 0 and self.seen.get_subscription_count() > 0)

    def look(self, stamp: Any = None, frame: str = "base_link", value: float | None = None) -> None:
        header = Header(stamp=self.stage.stamp if stamp is None else stamp, frame_id=frame)
        distance = float(2.0 - self.robot.pose[0]) if value is None else value
        points = [(distance, 0.01 * k, 0.2) for k in range(6)]
        if self.sensor == "scan":
            message: Any = LaserScan(header=header, angle_min=-0.05, angle_increment=0.02, range_max=10.0)
            message.ranges = [distance] * 6
        elif self.sensor == "pointcloud":
            message = create_cloud_xyz32(header, points)
        elif self.sensor == "range":
            message = Range(header=header, field_of_view=0.1, max_range=10.0, range=distance)
        else:
            corners = [Point32(x=x, y=y) for x, y, _ in points]
            instance = PolygonInstance(polygon=Polygon(points=corners))
            message = PolygonInstanceStamped(header=header, polygon=instance)
        self.seen.publish(message)

    def drive(self, seconds: float, speed: float = 0.5, look: Callable[[], None] | None = None) -> None:
        for _ in range(round(seconds / 0.05)):
            (look or self.look)()
            self.stage.step(0.0)
            self.commands.publish(Twist(linear=Vector3(x=speed)))
            self.stage.step()

    @property
    def speed(self) -> float:
        return float(self.robot.commands[-1][0])

    def has_logged(self, word: str) -> bool:
        return any(word in one.msg for one in self.log)


@pytest.mark.slow
@pytest.mark.parametrize("sensor", KINDS)
def test_the_robot_stops_before_what_a_sensor_sees(stage: Set, sensor: str) -> None:
    bench = Bench(stage, sensor=sensor)
    bench.drive(0.5, speed=1.0)
    assert bench.speed == 1.0
    bench.drive(2.3, speed=1.0)
    assert bench.speed == 0.0
    assert 1.4 < bench.robot.pose[0] < 1.7
    assert (bench.states[-1].action_type, bench.states[-1].polygon_name) == (CollisionMonitorState.STOP, "zone")
    count = len(bench.robot.commands)
    bench.drive(0.5)
    assert len(bench.robot.commands) == count


@pytest.mark.slow
def test_a_robot_that_approaches_never_touches(stage: Set) -> None:
    zone = {"type": "polygon", "action_type": "approach", "footprint_topic": "footprint", "min_points": 3}
    bench = Bench(stage, zone)
    bench.drive(0.5)
    assert bench.speed == 0.0
    assert bench.has_logged("its shape is not known")
    footprint = PolygonStamped(header=Header(frame_id="odom", stamp=bench.stage.stamp))
    x = float(bench.robot.pose[0])
    footprint.polygon.points = [Point32(x=x + a, y=b) for a, b in ((0.3, 0.2), (0.3, -0.2), (-0.3, -0.2), (-0.3, 0.2))]
    bench.stage.publish("footprint", footprint)
    bench.drive(7.0)
    assert 1.4 < bench.robot.pose[0] < 1.7
    assert bench.states[-1].action_type in (CollisionMonitorState.APPROACH, CollisionMonitorState.STOP)
    speeds = [one[0] for one in bench.robot.commands[10:] if one[0] > 0.0]
    assert 0.0 < min(speeds) < 0.2 < max(speeds)


FAULTS: dict[str, tuple[Callable[[Bench], Any], str]] = {
    "silent": (lambda bench: None, "s old"),
    "late": (lambda bench: bench.look(Header().stamp), "s old"),
    "ahead": (lambda bench: bench.look(time_message(round(1e9 * (bench.stage.now + 2.0)))), "s old"),
    "wrong frame": (lambda bench: bench.look(frame="nowhere"), "nowhere"),
    "not a number": (lambda bench: bench.look(value=math.nan), "has no ranges"),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_source_that_cannot_be_relied_on_stops_the_robot(stage: Set, fault: str) -> None:
    act, word = FAULTS[fault]
    bench = Bench(stage)
    bench.drive(0.5)
    assert bench.speed == 0.5
    bench.drive(0.5, look=lambda: act(bench))
    assert bench.speed == 0.0
    assert bench.states[-1].polygon_name == "invalid source"
    bench.stage.step_until(lambda: bench.has_logged(word))
    bench.drive(0.5)
    assert bench.speed == 0.5


def test_transforms_that_stop_and_commands_that_are_not_finite_stop_the_robot(stage: Set) -> None:
    bench = Bench(stage, source_timeout=5.0)
    bench.drive(0.3)
    bench.drive(0.2, speed=math.nan)
    assert bench.speed == 0.0
    bench.drive(0.2)
    assert bench.speed == 0.5
    commands = bench.robot.commands
    bench.stage.robot = None
    bench.drive(0.5)
    assert not np.any(commands[-1])
    bench.stage.step_until(lambda: bench.has_logged("the transform from odom to base_link is"))


@pytest.mark.slow
def test_the_motion_since_the_scan_is_taken_into_account(stage: Set) -> None:
    bench = Bench(stage, source_timeout=5.0)
    bench.drive(0.5)
    bench.drive(4.0, look=lambda: None)
    assert bench.speed == 0.0
    assert 1.4 < bench.robot.pose[0] < 1.6


def test_it_is_switched_off_and_on_and_zones_too(stage: Set) -> None:
    bench = Bench(stage, zone={**STOP, "radius": 5.0, "visualize": True})
    zones = bench.stage.collect(PolygonStamped, "zone")
    markers = bench.stage.collect(MarkerArray, "collision_monitor/collision_points_marker")
    bench.drive(0.3)
    assert bench.speed == 0.0
    bench.stage.step_until(lambda: len(zones) > 0 or bench.drive(0.05) is not None)
    assert len(zones[-1].polygon.points) > 8
    assert len(markers[-1].markers[0].points) == 6
    assert bench.stage.call(Toggle, "collision_monitor/toggle", enable=False).success
    bench.drive(0.2)
    assert bench.speed == 0.5
    bench.stage.call(Toggle, "collision_monitor/toggle", enable=True)
    bench.drive(0.2)
    assert bench.speed == 0.0
    assert bench.node.set_parameters([Parameter("zone.enabled", value=False)])[0].successful
    bench.drive(0.2)
    assert bench.speed == 0.5
    bench.node.trigger_deactivate()
    bench.drive(0.2)
    assert bench.speed == 0.0


def test_corners_as_a_list_of_numbers(stage: Set) -> None:
    bench = Bench(stage, {"type": "polygon", "points": [3.0, 1.0, 3.0, -1.0, 0.0, -1.0, 0.0, 1.0]})
    bench.drive(0.2)
    assert bench.speed == 0.0
    assert bench.states[-1].polygon_name == "zone"


def test_a_zone_with_an_unknown_source_fails_the_transition(stage: Set, capfd: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(AssertionError):
        Bench(stage, STOP | {"sources_names": ["senser"]})
    names = "'zone.sources_names' of /collision_monitor names 'senser', which is no observation source"
    assert f"{names}; did you mean 'sensor'?" in capfd.readouterr().err
