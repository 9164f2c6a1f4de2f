"""`navsat_transform_node`: satellite positions as odometry in the robot's world frame, and back."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from geographic_msgs.msg import GeoPoint
from geometry_msgs.msg import Point, TransformStamped
from nav_msgs.msg import Odometry
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.time import Time
from robot_localization.srv import FromLL, FromLLArray, SetDatum, SetUTMZone, ToLL, ToLLArray
from sensor_msgs.msg import Imu, NavSatFix
from tf2_ros import Buffer, StaticTransformBroadcaster, TransformException, TransformListener

from daidalos.common.arrays import Array
from daidalos.common.parameters import ParameterError, Parameters, parameter
from daidalos.common.pose3 import Pose, Vector, normalize, rotation_matrix
from daidalos.localization.errors import LocalizationError
from daidalos.localization.geodesy import Projection, TangentPlane, UtmZone
from daidalos.localization.navsat import NavsatAlignment
from daidalos.nodes.parameters import declare, declare_without_effect
from daidalos.nodes.scan_reports import ScanReports

_SENSOR = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
_WITHOUT_EFFECT = {
    "transform_timeout": "transforms are not waited for; the newest counts where that of the time is missing"
}
_UNKNOWN = math.nan


@dataclass(frozen=True)
class NavsatParameters(Parameters):
    """Parameters of the node."""

    frequency: float = parameter(10.0, "How often positions are published at most.", unit="Hz", above=0.0)
    delay: float = parameter(0.0, "Time to wait before the world frame is aligned.", unit="s", minimum=0.0)
    magnetic_declination_radians: float = parameter(
        0.0, "Added to the heading, where it is that of a compass.", unit="rad"
    )
    yaw_offset: float = parameter(0.0, "Added to the heading, which is 0 to the east then.", unit="rad")
    zero_altitude: bool = parameter(False, "Whether published positions have the height 0.")
    publish_filtered_gps: bool = parameter(True, "Whether the odometry is published as satellite positions.")
    use_odometry_yaw: bool = parameter(
        False, "Whether the heading is that of the odometry, not of the inertial sensor."
    )
    use_local_cartesian: bool = parameter(
        False, "Whether places are projected onto the tangent plane of the first one, not onto UTM's zone."
    )
    wait_for_datum: bool = parameter(False, "Whether datum, or the service, gives the origin of the world frame.")
    datum: tuple[float, ...] = parameter((), "Latitude, longitude and heading of that origin.", unit="deg, deg, rad")
    broadcast_cartesian_transform: bool = parameter(False, "Whether the transform to the projection is published.")
    broadcast_cartesian_transform_as_parent_frame: bool = parameter(
        False, "Whether the projection is the parent of the world frame."
    )
    broadcast_utm_transform: bool = parameter(False, "Older name of broadcast_cartesian_transform.")
    broadcast_utm_transform_as_parent_frame: bool = parameter(
        False, "Older name of broadcast_cartesian_transform_as_parent_frame."
    )

    def check(self) -> None:
        """Refuse a datum that is none."""
        if len(self.datum) not in (0, 3):
            raise ParameterError("datum", f"must be [latitude, longitude, heading], got {list(self.datum)}")
        if self.datum and not (abs(self.datum[0]) <= 90.0 and abs(self.datum[1]) <= 360.0):
            raise ParameterError("datum", f"must have a latitude and a longitude in degrees, got {list(self.datum)}")


@dataclass(frozen=True)
class _Fix:
    """A satellite position that can be used."""

    stamp: Any
    frame: str
    place: Vector
    covariance: Array


@dataclass(frozen=True)
class _Datum:
    """Place and heading of the world frame's origin."""

    place: Vector
    yaw: float


class NavsatTransformNode(Node):
    """Node that publishes ``odometry/gps`` and ``gps/filtered``."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("navsat_transform_node", **kwargs)
        self._settings = p = declare(self, NavsatParameters)
        declare_without_effect(self, _WITHOUT_EFFECT)
        self._reports = ScanReports(self)
        self._buffer = Buffer()
        self._listener = TransformListener(self._buffer, self)
        self._broadcaster = StaticTransformBroadcaster(self)
        self._alignment: NavsatAlignment | None = None
        self._zone: UtmZone | None = None
        self._fix: _Fix | None = None
        self._odometry: Odometry | None = None
        self._is_fix_new = self._is_odometry_new = False
        self._orientation: Pose | None = None
        self._waits_for_datum = p.wait_for_datum
        self._datum: _Datum | None = None
        if p.wait_for_datum and p.datum:
            self._datum = _Datum((p.datum[0], p.datum[1], 0.0), p.datum[2])
        self._started_at: float | None = None
        self._gps_publisher = self.create_publisher(Odometry, "odometry/gps", 10)
        if p.publish_filtered_gps:
            self._filtered_publisher = self.create_publisher(NavSatFix, "gps/filtered", 10)
        self.create_subscription(Odometry, "odometry/filtered", self._on_odometry, _SENSOR)
        self.create_subscription(NavSatFix, "gps/fix", self._on_fix, _SENSOR)
        if not p.use_odometry_yaw and not p.wait_for_datum:
            self.create_subscription(Imu, "imu", self._on_imu, _SENSOR)
        self.create_service(SetDatum, "datum", self._on_set_datum)
        self.create_service(ToLL, "toLL", self._on_to_ll)
        self.create_service(FromLL, "fromLL", self._on_from_ll)
        self.create_service(ToLLArray, "toLLArray", self._on_to_ll_array)
        self.create_service(FromLLArray, "fromLLArray", self._on_from_ll_array)
        self.create_service(SetUTMZone, "setUTMZone", self._on_set_zone)
        self.create_timer(1.0 / p.frequency, self._cycle)

    # What comes in.

    def _on_odometry(self, message: Odometry) -> None:
        pose = message.pose.pose
        numbers = [pose.position.x, pose.position.y, pose.position.z, *_quaternion(pose.orientation)]
        if not np.isfinite(numbers).all() or not any(_quaternion(pose.orientation)):
            self._reports.report("odometry", "a message on odometry/filtered is not used: its pose is not finite")
            return
        self._odometry, self._is_odometry_new = message, True

    def _on_fix(self, message: NavSatFix) -> None:
        place = (message.latitude, message.longitude, message.altitude)
        if message.status.status < 0:
            self._reports.report("fix", "a position on gps/fix is not used: the receiver has no fix")
        elif not np.isfinite(place).all() or abs(place[0]) > 90.0:
            self._reports.report("place", f"a position on gps/fix is not used: it is {place}")
        else:
            covariance = np.array(message.position_covariance, dtype=float).reshape(3, 3)
            if not np.isfinite(covariance).all():
                self._reports.report("covariance", "a position on gps/fix is not used: its covariance is not finite")
                return
            self._fix = _Fix(message.header.stamp, message.header.frame_id, place, covariance)
            self._is_fix_new = True

    def _on_imu(self, message: Imu) -> None:
        """Keep the orientation of the base."""
        if self._alignment is not None or self._odometry is None:
            return
        quaternion = _quaternion(message.orientation)
        if message.orientation_covariance[0] == -1 or not np.isfinite(quaternion).all() or not any(quaternion):
            self._reports.report("orientation", "a message on imu is not used: it has no orientation")
            return
        mount = Pose((0.0, 0.0, 0.0), self._mount(message.header.frame_id, message.header.stamp).orientation)
        self._orientation = Pose((0.0, 0.0, 0.0), normalize(quaternion)) @ mount.inverse

    def _mount(self, frame: str, stamp: Any) -> Pose:
        """Return the pose of a sensor in the base's frame; its origin after a report where it is not known."""
        assert self._odometry is not None
        base = self._odometry.child_frame_id
        if not frame or frame == base:
            return Pose()
        for time in (stamp, Time()):
            try:
                found = self._buffer.lookup_transform(base, frame, time).transform
            except TransformException:
                continue
            shift = found.translation
            return Pose((shift.x, shift.y, shift.z), _quaternion(found.rotation))
        text = f"there is no transform from '{frame}' to '{base}'"
        self._reports.report(f"mount {frame}", f"{text}: it counts as mounted at the robot's origin")
        return Pose()

    # The cycle.

    def _cycle(self) -> None:
        now = self.get_clock().now().nanoseconds * 1e-9
        if self._started_at is None or now < self._started_at:
            self._started_at = now
        if self._alignment is None:
            if now - self._started_at >= self._settings.delay:
                self._align()
            return
        if self._is_fix_new and self._odometry is not None:
            self._publish_odometry()
        if self._settings.publish_filtered_gps and self._is_odometry_new:
            self._publish_filtered()

    def _align(self) -> None:
        """Align the world frame with the earth, as soon as all is known."""
        try:
            self._alignment = self._alignment_by_datum() if self._waits_for_datum else self._alignment_by_sensors()
        except LocalizationError as error:
            self._reports.report("projection", f"the world frame is not aligned: {error}")
        if self._alignment is not None:
            if self._settings.use_local_cartesian:
                text = "the tangent plane of the datum"
            else:
                text = f"zone {self._zone} of UTM"
            self.get_logger().info(f"aligned the world frame with {text}")
            self._publish_grid()

    def _alignment_by_datum(self) -> NavsatAlignment | None:
        if self._datum is None or self._odometry is None:
            return None
        place = self._datum.place
        return NavsatAlignment.of(self._projection(place), place, self._heading(self._datum.yaw), Pose())

    def _alignment_by_sensors(self) -> NavsatAlignment | None:
        if self._odometry is None or self._fix is None:
            return None
        robot = _pose(self._odometry)
        orientation = robot if self._settings.use_odometry_yaw else self._orientation
        if orientation is None:
            return None
        mount = self._mount(self._fix.frame, self._fix.stamp)
        roll, pitch, yaw = orientation.rpy
        place = self._fix.place
        heading = self._heading(yaw)
        return NavsatAlignment.of(self._projection(place), place, heading, robot, mount.position, (roll, pitch))

    def _heading(self, yaw: float) -> float:
        return yaw + self._settings.magnetic_declination_radians + self._settings.yaw_offset

    def _projection(self, place: Vector) -> Projection:
        if self._settings.use_local_cartesian:
            return TangentPlane(place[0], place[1])
        self._zone = self._zone or UtmZone.containing(place[0], place[1])
        return self._zone

    def _publish_grid(self) -> None:
        """Publish the transform between the world frame and the projection."""
        p = self._settings
        if not (p.broadcast_cartesian_transform or p.broadcast_utm_transform):
            return
        assert self._alignment is not None
        assert self._odometry is not None
        is_parent = p.broadcast_cartesian_transform_as_parent_frame or p.broadcast_utm_transform_as_parent_frame
        names = [self._odometry.header.frame_id, "local_enu" if p.use_local_cartesian else "utm"]
        pose = self._alignment.grid.inverse if is_parent else self._alignment.grid
        message = TransformStamped(child_frame_id=names[0 if is_parent else 1])
        message.header.frame_id, message.header.stamp = names[1 if is_parent else 0], self.get_clock().now().to_msg()
        shift, turn = message.transform.translation, message.transform.rotation
        shift.x, shift.y, shift.z = pose.position
        turn.x, turn.y, turn.z, turn.w = pose.orientation
        if p.zero_altitude:
            shift.z = 0.0
        self._broadcaster.sendTransform(message)

    def _publish_odometry(self) -> None:
        """Publish the last satellite position as that of the robot in its world frame."""
        assert self._alignment is not None
        assert self._odometry is not None
        assert self._fix is not None
        mount = self._mount(self._fix.frame, self._fix.stamp)
        self._is_fix_new = False
        x, y, z = self._alignment.robot_position(self._fix.place, _pose(self._odometry), mount.position)
        message = Odometry()
        message.header.stamp, message.header.frame_id = self._fix.stamp, self._odometry.header.frame_id
        message.pose.pose.position = Point(x=x, y=y, z=0.0 if self._settings.zero_altitude else z)
        turn = rotation_matrix(self._alignment.grid.orientation)
        covariance = np.zeros((6, 6))
        covariance[:3, :3] = turn @ self._fix.covariance @ turn.T
        message.pose.covariance = covariance.ravel()
        self._gps_publisher.publish(message)

    def _publish_filtered(self) -> None:
        """Publish the odometry as a satellite position."""
        assert self._alignment is not None
        assert self._odometry is not None
        self._is_odometry_new = False
        message = NavSatFix()
        message.header.stamp, message.header.frame_id = self._odometry.header.stamp, self._odometry.child_frame_id
        place = self._alignment.to_place(_pose(self._odometry).position)
        message.latitude, message.longitude, message.altitude = place
        turn = rotation_matrix(self._alignment.grid.inverse.orientation)
        known = np.array(self._odometry.pose.covariance).reshape(6, 6)[:3, :3]
        message.position_covariance = (turn @ known @ turn.T).ravel()
        message.position_covariance_type = NavSatFix.COVARIANCE_TYPE_KNOWN
        message.status.status = message.status.STATUS_GBAS_FIX
        self._filtered_publisher.publish(message)

    # Services.

    def _on_set_datum(self, request: Any, response: Any) -> Any:
        point, quaternion = request.geo_pose.position, _quaternion(request.geo_pose.orientation)
        place = (point.latitude, point.longitude, point.altitude)
        if not np.isfinite([*place, *quaternion]).all() or abs(place[0]) > 90.0 or not any(quaternion):
            self.get_logger().error(f"a datum is not used: {place} with the orientation {quaternion}")
            return response
        self._datum, self._waits_for_datum = _Datum(place, Pose((0.0, 0.0, 0.0), normalize(quaternion)).yaw), True
        self._forget()
        return response

    def _on_set_zone(self, request: Any, response: Any) -> Any:
        try:
            self._zone = UtmZone.parse(request.utm_zone)
        except LocalizationError as error:
            self.get_logger().error(f"the zone is not set: {error}")
            return response
        self._alignment, self._waits_for_datum = None, False
        self.get_logger().info(f"places are projected into zone {self._zone} of UTM")
        return response

    def _forget(self) -> None:
        """Align the world frame again."""
        self._alignment = self._zone = None

    def _on_to_ll(self, request: Any, response: Any) -> Any:
        self._report_unaligned()
        response.ll_point = self._to_place(request.map_point)
        return response

    def _on_from_ll(self, request: Any, response: Any) -> Any:
        self._report_unaligned()
        response.map_point = self._to_point(request.ll_point)
        return response

    def _on_to_ll_array(self, request: Any, response: Any) -> Any:
        self._report_unaligned()
        response.ll_points = [self._to_place(point) for point in request.map_points]
        return response

    def _on_from_ll_array(self, request: Any, response: Any) -> Any:
        self._report_unaligned()
        response.map_points = [self._to_point(place) for place in request.ll_points]
        return response

    def _to_place(self, point: Point) -> GeoPoint:
        """Return the place of a point in the world frame; one that is not known while that is not aligned."""
        alignment = self._alignment
        place = (_UNKNOWN,) * 3 if alignment is None else alignment.to_place((point.x, point.y, point.z))
        return GeoPoint(latitude=place[0], longitude=place[1], altitude=place[2])

    def _to_point(self, place: GeoPoint) -> Point:
        """Return the point in the world frame of a place; one that is not known while that is not aligned."""
        alignment, coordinates = self._alignment, (place.latitude, place.longitude, place.altitude)
        x, y, z = (_UNKNOWN,) * 3 if alignment is None else alignment.to_world(*coordinates)
        return Point(x=x, y=y, z=0.0 if self._settings.zero_altitude else z)

    def _report_unaligned(self) -> None:
        """Write to the log where the world frame is not aligned yet."""
        if self._alignment is None:
            self.get_logger().error("places cannot be converted: the world frame is not aligned with the earth yet")


def _quaternion(message: Any) -> tuple[float, float, float, float]:
    return message.x, message.y, message.z, message.w


def _pose(message: Odometry) -> Pose:
    """Return the pose of odometry."""
    position = message.pose.pose.position
    return Pose((position.x, position.y, position.z), normalize(_quaternion(message.pose.pose.orientation)))
