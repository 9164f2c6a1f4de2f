"""Conversions between the ROS types with the same gz type, such as Twist and TwistStamped."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from operator import attrgetter
from typing import Any

Converter = Callable[[Any], Any]

_FIX = {
    "header": "header",
    "status": "status.status",
    "latitude": "latitude",
    "longitude": "longitude",
    "altitude": "altitude",
    "covariance": "position_covariance",
    "covariance_type": "position_covariance_type",
}
_PLACES: tuple[dict[str, dict[str, str]], ...] = (
    {
        "geometry_msgs/msg/Pose": {"position": "position", "rotation": "orientation"},
        "geometry_msgs/msg/PoseStamped": {
            "header": "header",
            "position": "pose.position",
            "rotation": "pose.orientation",
        },
        "geometry_msgs/msg/Transform": {"position": "translation", "rotation": "rotation"},
        "geometry_msgs/msg/TransformStamped": {
            "header": "header",
            "position": "transform.translation",
            "rotation": "transform.rotation",
        },
    },
    {
        "geometry_msgs/msg/Twist": {"linear": "linear", "angular": "angular"},
        "geometry_msgs/msg/TwistStamped": {"header": "header", "linear": "twist.linear", "angular": "twist.angular"},
    },
    {
        "geometry_msgs/msg/TwistWithCovariance": {"twist": "twist", "covariance": "covariance"},
        "geometry_msgs/msg/TwistWithCovarianceStamped": {
            "header": "header",
            "twist": "twist.twist",
            "covariance": "twist.covariance",
        },
    },
    {
        "geometry_msgs/msg/PoseWithCovariance": {"pose": "pose", "covariance": "covariance"},
        "geometry_msgs/msg/PoseWithCovarianceStamped": {
            "header": "header",
            "pose": "pose.pose",
            "covariance": "pose.covariance",
        },
    },
    {
        "geometry_msgs/msg/Wrench": {"force": "force", "torque": "torque"},
        "geometry_msgs/msg/WrenchStamped": {"header": "header", "force": "wrench.force", "torque": "wrench.torque"},
    },
    {"sensor_msgs/msg/NavSatFix": _FIX, "gps_msgs/msg/GPSFix": _FIX},
    {
        "geometry_msgs/msg/Point": {"x": "x", "y": "y", "z": "z"},
        "geometry_msgs/msg/Vector3": {"x": "x", "y": "y", "z": "z"},
    },
)
"""Groups of types that share a type of gz, with the fields in which each keeps the same values."""


def message_class(type_name: str) -> Any:
    """Return the class of a message type such as ``std_msgs/msg/String``."""
    package, _, name = type_name.partition("/msg/")
    return getattr(import_module(f"{package}.msg"), name)


def find_converter(source: str, target: str, stamp: Callable[[], Any]) -> Converter | None:
    """Return what makes a message of one type from one of another; None where the types share no type of gz.

    Parameters
    ----------
    source, target
        ROS types, such as ``geometry_msgs/msg/Twist``.
    stamp
        Returns the time (builtin_interfaces/msg/Time) for headers that the source does not have.
    """
    special = _SPECIAL.get((source, target))
    if special is not None:
        return special
    for group in _PLACES:
        if source in group and target in group:
            return _by_places(message_class(target), group[source], group[target], stamp)
    return None


def _by_places(
    target: Any, source_places: dict[str, str], target_places: dict[str, str], stamp: Callable[[], Any]
) -> Converter:
    pairs = [(attrgetter(source_places[key]), target_places[key]) for key in target_places if key in source_places]
    wants_stamp = "header" in target_places and "header" not in source_places

    def convert(message: Any) -> Any:
        result = target()
        for get, place in pairs:
            _assign(result, place, get(message))
        if wants_stamp:
            result.header.stamp = stamp()
        return result

    return convert


def _assign(message: Any, place: str, value: Any) -> None:
    """Set a field below a message; a message of another class is copied by equal field names."""
    parent, _, name = place.rpartition(".")
    owner = attrgetter(parent)(message) if parent else message
    current = getattr(owner, name)
    if hasattr(current, "get_fields_and_field_types") and type(current) is not type(value):
        for field in current.get_fields_and_field_types():
            setattr(current, field, getattr(value, field))
    else:
        setattr(owner, name, value)


def _poses_from_transforms(message: Any) -> Any:
    from geometry_msgs.msg import Pose, PoseArray

    result = PoseArray()
    if message.transforms:
        result.header = message.transforms[0].header
    for transform in message.transforms:
        pose = Pose()
        _assign(pose, "position", transform.transform.translation)
        _assign(pose, "orientation", transform.transform.rotation)
        result.poses.append(pose)
    return result


def _transforms_from_poses(message: Any) -> Any:
    from geometry_msgs.msg import TransformStamped
    from tf2_msgs.msg import TFMessage

    result = TFMessage()
    for pose in message.poses:
        transform = TransformStamped(header=message.header)
        _assign(transform, "transform.translation", pose.position)
        _assign(transform, "transform.rotation", pose.orientation)
        result.transforms.append(transform)
    return result


def _range_from_scan(message: Any) -> Any:
    """Return the nearest return of a scan; infinity where there is none."""
    from sensor_msgs.msg import Range

    return Range(
        header=message.header,
        field_of_view=message.angle_max - message.angle_min,
        min_range=message.range_min,
        max_range=message.range_max,
        range=min((one for one in message.ranges if one == one), default=float("inf")),
    )


def _scan_from_range(message: Any) -> Any:
    """Return a scan of one ray in the middle of the field of view."""
    from sensor_msgs.msg import LaserScan

    return LaserScan(
        header=message.header,
        angle_min=-message.field_of_view / 2,
        angle_max=message.field_of_view / 2,
        angle_increment=message.field_of_view,
        range_min=message.min_range,
        range_max=message.max_range,
        ranges=[message.range],
    )


_SPECIAL: dict[tuple[str, str], Converter] = {
    ("tf2_msgs/msg/TFMessage", "geometry_msgs/msg/PoseArray"): _poses_from_transforms,
    ("geometry_msgs/msg/PoseArray", "tf2_msgs/msg/TFMessage"): _transforms_from_poses,
    ("sensor_msgs/msg/LaserScan", "sensor_msgs/msg/Range"): _range_from_scan,
    ("sensor_msgs/msg/Range", "sensor_msgs/msg/LaserScan"): _scan_from_range,
}
