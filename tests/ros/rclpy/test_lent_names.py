"""Names that programs for ROS 2 import from modules where they are not at home."""

import subprocess
import sys
from importlib import import_module

import pytest

LENT = [
    ("rclpy.node", "rclpy.impl.type_variables", "MsgType"),
    ("rclpy.publisher", "rclpy.node", "MsgType"),
    ("rclpy.subscription", "rclpy.node", "MsgType"),
    ("rclpy.client", "rclpy.node", "SrvTypeRequest"),
    ("rclpy.service", "rclpy.node", "SrvTypeResponse"),
    ("tf2_ros.buffer_interface", "geometry_msgs.msg", "TransformStamped"),
    ("rosbag2_py._storage", "rosbag2_py", "TopicMetadata"),
    ("rosbag2_py._storage", "rosbag2_py", "BagMetadata"),
    ("tf2_ros", "geometry_msgs.msg", "TransformStamped"),
    ("tf2_ros", "rclpy.time", "Time"),
    ("tf2_ros.buffer", "tf2_msgs.srv", "FrameGraph"),
    ("tf2_ros.static_transform_broadcaster", "geometry_msgs.msg", "TransformStamped"),
    ("tf2_geometry_msgs", "geometry_msgs.msg", "TransformStamped"),
    ("message_filters", "rclpy.duration", "Duration"),
    ("rclpy.node", "rcl_interfaces.msg", "ParameterDescriptor"),
    ("rclpy.node", "rcl_interfaces.msg", "SetParametersResult"),
    ("rclpy.node", "rclpy.subscription", "Subscription"),
    ("rclpy.node", "rclpy.exceptions", "ParameterNotDeclaredException"),
    ("rclpy.action.client", "action_msgs.msg", "GoalStatus"),
    ("rclpy.action.server", "action_msgs.msg", "GoalStatus"),
    ("rclpy.executors", "rclpy.node", "Node"),
    ("rclpy.parameter", "rcl_interfaces.msg", "ParameterValue"),
    ("rclpy.time_source", "rcl_interfaces.msg", "ParameterEvent"),
]


@pytest.mark.parametrize(("lender", "home", "name"), LENT)
def test_names_are_what_they_are_at_home(lender: str, home: str, name: str) -> None:
    assert getattr(import_module(lender), name) is getattr(import_module(home), name)


@pytest.mark.parametrize("lender", sorted({lender for lender, *_ in LENT}))
def test_every_lent_name_exists_and_no_other(lender: str) -> None:
    module = import_module(lender)
    homes = next(cell.cell_contents for cell in module.__getattr__.__closure__ if isinstance(cell.cell_contents, dict))
    assert [name for name in homes if not hasattr(module, name)] == []
    with pytest.raises(ImportError, match=f"cannot import name 'Nothing' from '{lender}'"):
        exec(f"from {lender} import Nothing")


def test_nothing_is_imported_before_it_is_asked_for() -> None:
    seen = "print('rclpy.action' in sys.modules)"
    code = f"import sys, tf2_ros; {seen}; tf2_ros.BufferClient; {seen}"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True).stdout == "False\nTrue\n"
