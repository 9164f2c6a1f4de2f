"""Resolution of dependencies named in package.xml."""

from __future__ import annotations

import importlib.util
import re
from dataclasses import dataclass
from enum import Enum
from functools import cache
from importlib import metadata
from pathlib import Path

_BUILD = re.compile(
    r"ament_.*|rosidl_.*|catkin|cmake|git|ros_environment|ros_workspace|python_cmake_module|"
    r"build-essential|pkg-config|colcon.*|rmw.*|rosidl|ros_(base|core)|ros_testing|desktop(_full)?|"
    r"ros2(cli|launch|run|topic|node|pkg|param|service|action|bag|interface|doctor|component|lifecycle|test|_control|_controllers).*|"
    r"launch_testing_.*|rosbag2.*|domain_coordinator|osrf_.*|python3(-dev)?|python3-setuptools.*|python3-catkin-pkg.*|"
    r"message_(generation|runtime)|ros(bag|launch|lib|msg|node|param|service|test|topic|unit)|"
    r"(common_interfaces|desktop|geometry2|image_common|navigation2|perception|rqt_common_plugins|simulation|sros2)|"
    r"rclcpp(_components)?|tf2|tf2_ros_py|plotjuggler_ros|ros2(multicast|plugin)|bond_core"
)
_COMPILED = re.compile(
    r"rclcpp_.*|pluginlib|class_loader|rcl|rcl_.*|rcutils|rcpputils|libstatistics_collector|eigen3?|eigen3_cmake_module|"
    r"roscpp.*|nodelet.*|urdf|boost|lib[a-z].*|qt.*|pcl.*|tf2_(bullet|eigen|kdl)|kdl.*|orocos_kdl.*|urdfdom.*|"
    r"(compressed_|theora_)?image_transport(_plugins)?|console_bridge.*|spdlog.*|tinyxml.*|yaml[-_]cpp.*|"
    r"rviz_(common|rendering|ogre_vendor|default_plugins|visual_tools)|gtest|"
    r"controller_interface|hardware_interface|transmission_interface|realtime_tools|control_toolbox|"
    r"nav2_(core|util|costmap_2d|rviz_plugins)|generate_parameter_library|behaviortree_cpp.*|gazebo(_dev)?|"
    r"cv_bridge_cpp|ceres-solver|.*_vendor|bondcpp|fast(cdr|rtps.*)|iceoryx_.*|(py)?tracetools.*|rttest|tlsf.*|smclib|filters|"
    r"camera_calibration_parsers|rviz_.*|nav_?2d?_utils|realtime_tools|kinematics_interface.*|joint_limits"
)
_OF_ROS1 = {
    "actionlib": "rclpy",
    "actionlib_msgs": "action_msgs",
    "gmapping": "slam_toolbox",
    "hector_slam": "hector_mapping",
    "move_base_msgs": "nav2_msgs",
    "roscpp_tutorials": "demo_nodes_cpp",
    "rospy": "rclpy",
    "rospy_tutorials": "demo_nodes_py",
    "rviz": "rviz2",
    "tf": "tf2_ros",
}
"""Packages of ROS 1, and those that stand in for them."""
_DISTRIBUTIONS = {
    "opencv": "opencv-python-headless",
    "yaml": "pyyaml",
    "serial": "pyserial",
    "pil": "pillow",
    "imaging": "pillow",
    "skimage": "scikit-image",
    "sklearn": "scikit-learn",
    "bs4": "beautifulsoup4",
    "usb": "pyusb",
    "zmq": "pyzmq",
    "qt5-bindings": "pyqt5",
    "pyqt5": "pyqt5",
    "paho-mqtt": "paho-mqtt",
    "tk": "",
    "venv": "",
    "pip": "",
    "distutils": "",
    "lxml": "lxml",
    "dateutil": "python-dateutil",
    "transforms3d": "transforms3d",
    "pykdl": "",
    "mock": "mock",
    "pygraphviz": "pygraphviz",
    "pydot": "pydot",
    "torch": "torch",
    "ultralytics": "ultralytics",
}


class Answer(Enum):
    """Outcome of the resolution of a dependency."""

    HERE = "here"
    """Installed, or not needed by a build."""
    COMPILED = "compiled"
    """Only C++ needs it; targets that do are left out of a build."""
    ABSENT = "absent"
    """A package of ROS 2 that does not come with Daidalos; a build does not need it."""
    PYTHON = "python"
    """Available in the Python package index."""
    UNKNOWN = "unknown"
    """Nothing is known of it."""


@dataclass(frozen=True)
class Resolution:
    """Resolved dependency; `distribution` is its name in the package index."""

    answer: Answer
    distribution: str = ""


def resolve(key: str) -> Resolution:
    """Return the resolution of a package's dependency."""
    key = _OF_ROS1.get(key, key)
    if _is_package(key) or _BUILD.fullmatch(key):
        return Resolution(Answer.HERE)
    if key.startswith(("python-", "python3-")):
        distribution = _distribution(key)
        if not distribution or _is_installed(distribution):
            return Resolution(Answer.HERE, distribution)
        return Resolution(Answer.PYTHON, distribution)
    if _COMPILED.fullmatch(key):
        return Resolution(Answer.COMPILED)
    if key in _ros_packages():
        return Resolution(Answer.ABSENT)
    return Resolution(Answer.UNKNOWN)


@cache
def _ros_packages() -> frozenset[str]:
    """Return the packages of ROS 2's desktop installation and of the stacks that robots build on, as of Jazzy."""
    return frozenset(Path(__file__).with_name("ros_packages.txt").read_text("utf-8").split())


def _is_package(key: str) -> bool:
    from ament_index_python.packages import get_packages_with_prefixes

    from daidalos.interfaces.library import BUILT_IN

    if key in get_packages_with_prefixes() or (BUILT_IN / key).is_dir():
        return True
    return re.fullmatch(r"[a-z]\w*", key) is not None and importlib.util.find_spec(key) is not None


def _distribution(key: str) -> str:
    """Return the package index's name of a key such as ``python3-opencv`` or ``python3-ruckig-pip``."""
    name = key.partition("-")[2].removesuffix("-pip")
    return _DISTRIBUTIONS.get(name, name)


def _is_installed(distribution: str) -> bool:
    # One library goes under several names there.
    names = {distribution, distribution.removesuffix("-headless")}
    for name in names:
        try:
            metadata.version(name)
        except metadata.PackageNotFoundError:
            continue
        return True
    return False
