"""`navsat_transform_node` under a stepped clock, with a receiver that the test plays."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from geographic_msgs.msg import GeoPoint, GeoPose
from geometry_msgs.msg import Point, TransformStamped
from nav_msgs.msg import Odometry
from rcl_interfaces.msg import Log
from robot_localization.srv import FromLL, FromLLArray, SetDatum, SetUTMZone, ToLL, ToLLArray
from sensor_msgs.msg import Imu, NavSatFix
from tf2_msgs.msg import TFMessage

from daidalos.common.parameters import ParameterError
from daidalos.localization.geodesy import UtmZone
from daidalos.nodes.conversions import pose_message, quaternion_message
from daidalos.nodes.robot_localization.navsat_transform_node import NavsatTransformNode
from nodes.stepped import LATCHED, Stage

Set = Callable[[dict[str, Any]], Stage]
ZONE = UtmZone(30, True)
START = (55.944904, -3.186693, 40.0)
ANTENNA = 0.5
"""How far ahead of the base [m] the antenna is."""


class Bench:
    """The node, and a robot that starts at `START` in a world frame whose x axis points to `heading` from the east."""

    def __init__(self, set_stage: Set, heading: float = 0.0, **parameters: Any) -> None:
        self.stage = set_stage({"/navsat_transform_node": {"frequency": 20.0, **parameters}})
        self.heading = heading
        self.log = self.stage.collect(Log, "/rosout", 100)
        self.positions = self.stage.collect(Odometry, "odometry/gps")
        self.filtered = self.stage.collect(NavSatFix, "gps/filtered")
        self.transforms = self.stage.collect(TFMessage, "/tf_static", LATCHED)
        self.node = self.stage.add(NavsatTransformNode())
        create = self.stage.node.create_publisher
        self._odometry, self._fixes = create(Odometry, "odometry/filtered", 1), create(NavSatFix, "gps/fix", 1)
        self._imu = create(Imu, "imu", 1)
        mount = TransformStamped(child_frame_id="gps")
        mount.header.frame_id, mount.transform.translation.x, mount.transform.rotation.w = "base_link", ANTENNA, 1.0
        self.stage.publish("/tf_static", TFMessage(transforms=[mount]), LATCHED)
        self.stage.step()

    def place(self, x: float, y: float, yaw: float) -> tuple[float, float, float]:
        """Return where the antenna is when the robot has a pose in its world frame."""
        x, y = x + ANTENNA * math.cos(yaw), y + ANTENNA * math.sin(yaw)
        true = self.heading + ZONE.convergence(*START[:2])
        east, north, _ = ZONE.forward(*START)
        turned = complex(x, y) * complex(math.cos(true), math.sin(true))
        return ZONE.reverse(east + turned.real, north + turned.imag, START[2])

    def drive(self, x: float = 0.0, y: float = 0.0, yaw: float = 0.0, compass: float = 0.0) -> None:
        """Publish the odometry, satellite position and orientation of a robot at a pose; step."""
        odometry = Odometry(child_frame_id="base_link")
        odometry.header.stamp, odometry.header.frame_id = self.stage.stamp, "map"
        odometry.pose.pose = pose_message([x, y, yaw])
        odometry.pose.covariance = np.diag([4.0, 1.0, 1.0, 0.0, 0.0, 0.0]).ravel()
        self._odometry.publish(odometry)
        self.stage.step()
        imu = Imu(orientation=quaternion_message(self.heading + yaw - compass))
        imu.header.stamp, imu.header.frame_id = self.stage.stamp, "base_link"
        self._imu.publish(imu)
        self.fix(self.place(x, y, yaw))
        self.stage.step_for(0.1)

    def fix(self, place: tuple[float, float, float], **changes: Any) -> None:
        message = NavSatFix(latitude=place[0], longitude=place[1], altitude=place[2])
        message.header.stamp, message.header.frame_id = self.stage.stamp, "gps"
        message.position_covariance = np.diag([4.0, 1.0, 1.0]).ravel()
        message.status.status = changes.get("status", 0)
        self._fixes.publish(message)
        self.stage.step()

    @property
    def position(self) -> tuple[float, float]:
        point = self.positions[-1].pose.pose.position
        return point.x, point.y

    def warnings(self, word: str) -> list[str]:
        return [one.msg for one in self.log if word in one.msg]


@pytest.mark.parametrize("plane", [False, True])
def test_positions_are_those_of_the_robot_in_its_world_frame(stage: Set, plane: bool) -> None:
    bench = Bench(
        stage, heading=1.1, use_local_cartesian=plane, magnetic_declination_radians=0.05, yaw_offset=0.2,
        broadcast_cartesian_transform=True,
    )  # fmt: skip
    bench.drive(x=2.0, y=1.0, yaw=0.4, compass=0.25)
    for x, y, yaw in [(2.0, 1.0, 0.4), (12.0, -3.0, -1.5)]:
        bench.drive(x, y, yaw)
        assert bench.position == pytest.approx((x, y), abs=0.02)
    message = bench.positions[-1]
    assert (message.header.frame_id, message.pose.pose.position.z) == ("map", pytest.approx(0.0, abs=0.01))
    covariance = np.array(message.pose.covariance).reshape(6, 6)
    assert np.trace(covariance) == pytest.approx(6.0)
    assert 1.5 < covariance[1, 1] < 3.9, "turned from the grid into the world frame"
    last = bench.filtered[-1]
    back = ZONE.forward(last.latitude, last.longitude, 0.0)
    there = ZONE.forward(*bench.place(12.0 - ANTENNA, -3.0, 0.0))
    assert back[:2] == pytest.approx(there[:2], abs=0.02)
    found = [one for message in bench.transforms for one in message.transforms if one.header.frame_id == "map"]
    assert [one.child_frame_id for one in found] == ["local_enu" if plane else "utm"]


def test_places_are_converted_there_and_back(stage: Set) -> None:
    bench = Bench(stage, use_odometry_yaw=True, zero_altitude=True)
    unknown = bench.stage.call(ToLL, "/toLL", map_point=Point(x=1.0))
    assert math.isnan(unknown.ll_point.latitude), "no place is better than a wrong one"
    assert bench.warnings("not aligned with the earth yet")
    none = bench.stage.call(FromLLArray, "/fromLLArray", ll_points=[GeoPoint(latitude=START[0], longitude=START[1])])
    assert [math.isnan(point.x) for point in none.map_points] == [True]
    bench.drive()
    bench.drive()
    place = bench.stage.call(ToLL, "/toLL", map_point=Point(x=30.0, y=-4.0)).ll_point
    point = bench.stage.call(FromLL, "/fromLL", ll_point=place).map_point
    assert (point.x, point.y, point.z) == pytest.approx((30.0, -4.0, 0.0), abs=1e-6)
    assert (place.latitude, place.longitude) == pytest.approx(bench.place(29.5, -4.0, 0.0)[:2], abs=1e-7)
    points = [Point(x=30.0, y=-4.0), Point(x=-5.0, y=2.0)]
    places = bench.stage.call(ToLLArray, "/toLLArray", map_points=points).ll_points
    assert places[0] == place
    assert bench.stage.call(FromLLArray, "/fromLLArray", ll_points=places[:1]).map_points == [point]
    back = bench.stage.call(FromLLArray, "/fromLLArray", ll_points=places).map_points
    assert [(one.x, one.y) for one in back] == [pytest.approx((one.x, one.y), abs=1e-6) for one in points]


def test_a_datum_is_the_origin(stage: Set) -> None:
    bench = Bench(stage, wait_for_datum=True, datum=[*START[:2], 0.0])
    bench.drive(x=7.0)  # the datum counts, not where the odometry is
    bench.drive(x=7.0)
    assert bench.position == pytest.approx((7.0, 0.0), abs=0.01)
    datum = GeoPose(orientation=quaternion_message(math.pi / 2))
    datum.position.latitude, datum.position.longitude = START[:2]
    bench.stage.call(SetDatum, "/datum", geo_pose=datum)
    bench.drive(x=7.0)
    bench.drive(x=7.0)
    assert bench.position == pytest.approx((0.0, -7.0), abs=0.6), "x points to the north now"
    place = bench.stage.call(FromLL, "/fromLL", ll_point=GeoPoint(latitude=START[0] + 1e-4, longitude=START[1]))
    assert (place.map_point.x, place.map_point.y) == pytest.approx((11.1, 0.0), abs=0.1)


def test_a_zone_is_set(stage: Set) -> None:
    bench = Bench(stage)
    bench.stage.call(SetUTMZone, "/setUTMZone", utm_zone="99U")
    assert bench.warnings("expected a zone of UTM such as '31U', found '99U'")
    bench.stage.call(SetUTMZone, "/setUTMZone", utm_zone="31U")
    bench.drive()
    bench.drive(x=5.0)
    assert bench.position == pytest.approx((5.0, 0.0), abs=0.02), "aligned with that zone's north"
    assert bench.node._zone == UtmZone(31, True)


def test_positions_that_cannot_be_used_are_named(stage: Set) -> None:
    bench = Bench(stage)
    bench.fix(START, status=-1)
    bench.fix((math.nan, 0.0, 0.0))
    assert bench.warnings("the receiver has no fix")
    assert bench.warnings("is not used: it is (nan")
    bench.drive()
    bench.drive()
    count = len(bench.positions)
    assert count
    bench.fix(START, status=-1)
    bench.stage.step_for(0.2)
    assert len(bench.positions) == count


@pytest.mark.parametrize("datum", [[1.0, 2.0], [155.0, 0.0, 0.0]])
def test_a_datum_that_is_none_is_refused(stage: Set, datum: list[float]) -> None:
    with pytest.raises(ParameterError, match="datum"):
        Bench(stage, datum=datum)
