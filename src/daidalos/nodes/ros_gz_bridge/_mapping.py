"""Configuration of bridges: topics and services, with their types on both sides."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from daidalos.common.documents import DocumentError, read_yaml
from daidalos.common.suggestions import hint

_NAMES = {
    "std_msgs": "Bool:Boolean ColorRGBA:Color Empty Float32:Float Float64:Double Header Int32 String:StringMsg UInt32",
    "geometry_msgs": "Pose PoseArray:Pose_V PoseStamped:Pose Point:Vector3d Quaternion Transform:Pose "
    "TransformStamped:Pose Twist TwistStamped:Twist TwistWithCovariance TwistWithCovarianceStamped:TwistWithCovariance "
    "PoseWithCovariance PoseWithCovarianceStamped:PoseWithCovariance Vector3:Vector3d Wrench WrenchStamped:Wrench",
    "gps_msgs": "GPSFix:NavSat",
    "nav_msgs": "Odometry Odometry:OdometryWithCovariance",
    "rosgraph_msgs": "Clock",
    "sensor_msgs": "BatteryState CameraInfo FluidPressure Image Imu:IMU JointState:Model Joy LaserScan "
    "MagneticField:Magnetometer NavSatFix:NavSat PointCloud2:PointCloudPacked Range:LaserScan",
    "tf2_msgs": "TFMessage:Pose_V",
    "trajectory_msgs": "JointTrajectory",
    "vision_msgs": "Detection2D:AnnotatedAxisAligned2DBox Detection2DArray:AnnotatedAxisAligned2DBox_V "
    "Detection3D:AnnotatedOriented3DBox Detection3DArray:AnnotatedOriented3DBox_V",
    "actuator_msgs": "Actuators",
    "builtin_interfaces": "Time",
    "rcl_interfaces": "ParameterValue:Any",
    "ros_gz_interfaces": "Altimeter Contact Contacts Dataframe Entity EntityFactory EntityWrench Float32Array:Float_V "
    "GuiCamera:GUICamera JointWrench Light LogicalCameraImage MaterialColor ParamVec:Param ParamVec:Param_V "
    "SensorNoise StringVec:StringMsg_V TrackVisual VideoRecord WorldControl WorldStatistics",
}
TYPES: dict[str, set[str]] = {}
"""gz types of each ROS type, without their package."""
for _package, _words in _NAMES.items():
    for _word in _words.split():
        _ros, _, _gz = _word.partition(":")
        TYPES.setdefault(f"{_package}/msg/{_ros}", set()).add(_gz or _ros)

_ARGUMENT = re.compile(r"(?P<topic>[^@]+)@(?P<ros>[^@\[\]]+)(?P<direction>[@\[\]])(?P<gz>.+)")
_SENSOR = re.compile(r"/world/[^/]+/model/(?P<models>.+)/link/(?P<link>[^/]+)/sensor/(?P<sensor>.+)")
_WORLD_CLOCK = re.compile(r"/world/[^/]+/clock")
_DIRECTIONS = {"@": "BIDIRECTIONAL", "[": "GZ_TO_ROS", "]": "ROS_TO_GZ"}


class MappingError(ValueError):
    """Invalid bridge; the message names it and the reason."""


@dataclass(frozen=True)
class Bridge:
    """Bridged topic or service.

    Parameters
    ----------
    ros_topic, gz_topic : str
    ros_type, gz_type : str
    direction : str
        ``BIDIRECTIONAL``, ``GZ_TO_ROS`` or ``ROS_TO_GZ``.
    """

    ros_topic: str
    gz_topic: str
    ros_type: str
    gz_type: str
    direction: str = "BIDIRECTIONAL"


def simulator_topic(name: str) -> str:
    """Return how the simulator calls a topic of gz; sensors without a topic have long names there, which end alike."""
    name = name if name.startswith("/") else f"/{name}"
    if _WORLD_CLOCK.fullmatch(name):
        return "/clock"
    match = _SENSOR.fullmatch(name)
    if match is None:
        return name
    models = match["models"].replace("/model/", "/")
    return f"/{models}/{match['link']}/{match['sensor']}"


def parse_arguments(words: Sequence[str]) -> tuple[list[Bridge], list[str]]:
    """Return the bridges of a command line, and the services that it names.

    Raises
    ------
    MappingError
    """
    bridges, services = [], []
    for word in words:
        if word.count("@") == 3 or "/srv/" in word:
            services.append(word.partition("@")[0])
            continue
        match = _ARGUMENT.fullmatch(word)
        if match is None:
            raise MappingError(f"'{word}' is not a bridge; write topic@ros_type@gz_type, with [ or ] for one direction")
        topic, direction = match["topic"], _DIRECTIONS[match["direction"]]
        bridges.append(_checked(Bridge(topic, topic, match["ros"], match["gz"], direction), word))
    return bridges, services


def read_file(path: Path) -> tuple[list[Bridge], list[str]]:
    """Return the bridges of a YAML file, and the services that it names.

    Raises
    ------
    MappingError
    """
    try:
        entries = read_yaml(path) or []
    except OSError as error:
        raise MappingError(f"cannot read '{path}': {error.strerror}") from None
    except DocumentError as error:
        raise MappingError(str(error)) from None
    if not isinstance(entries, list):
        raise MappingError(f"{path}: expected a list of bridges")
    bridges, services = [], []
    for number, entry in enumerate(entries, 1):
        where = f"{path}: entry {number}"
        if not isinstance(entry, dict):
            raise MappingError(f"{where}: expected names and values, got {entry!r}")
        if "service_name" in entry:
            services.append(str(entry["service_name"]))
        else:
            bridges.append(_entry(entry, where))
    return bridges, services


def _entry(entry: dict[str, Any], where: str) -> Bridge:
    common = entry.get("topic_name")
    ros = entry.get("ros_topic_name") or common or entry.get("gz_topic_name")
    gz = entry.get("gz_topic_name") or common or ros
    direction = str(entry.get("direction", "BIDIRECTIONAL"))
    for key, value in (
        ("ros_topic_name", ros),
        ("ros_type_name", entry.get("ros_type_name")),
        ("gz_type_name", entry.get("gz_type_name")),
    ):
        if not value:
            raise MappingError(f"{where}: <{key}> is missing")
        if not str(value).isprintable():
            raise MappingError(f"{where}: <{key}> is {value!r}, expected a name")
    if direction not in _DIRECTIONS.values():
        raise MappingError(f"{where}: direction is {direction!r}, expected one of {', '.join(_DIRECTIONS.values())}")
    kinds = str(entry["ros_type_name"]), str(entry["gz_type_name"])
    return _checked(Bridge(str(ros), str(gz), *kinds, direction), where)


def _checked(bridge: Bridge, where: str) -> Bridge:
    known = TYPES.get(bridge.ros_type)
    bare = bridge.gz_type.removeprefix("gz.msgs.").removeprefix("ignition.msgs.")
    if known is None:
        raise MappingError(f"{where}: {bridge.ros_type} cannot be bridged{hint(bridge.ros_type, TYPES)}")
    if bare not in known:
        wanted = " or ".join(f"gz.msgs.{name}" for name in sorted(known))
        raise MappingError(f"{where}: {bridge.ros_type} stands for {wanted}, not for {bridge.gz_type}")
    return bridge
