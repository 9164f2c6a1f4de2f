from pathlib import Path

import pytest

from daidalos.nodes.ros_gz_bridge._mapping import (
    Bridge,
    MappingError,
    parse_arguments,
    read_file,
    simulator_topic,
)

FILE = """
- ros_topic_name: odom
  gz_topic_name: /model/cart/odometry
  ros_type_name: nav_msgs/msg/Odometry
  gz_type_name: gz.msgs.Odometry
  direction: GZ_TO_ROS
- topic_name: cmd_vel
  ros_type_name: geometry_msgs/msg/Twist
  gz_type_name: ignition.msgs.Twist
- service_name: /world/hall/control
  ros_type_name: ros_gz_interfaces/srv/ControlWorld
"""


def test_arguments_say_topic_types_and_direction():
    bridges, services = parse_arguments(
        [
            "/scan@sensor_msgs/msg/LaserScan[gz.msgs.LaserScan",
            "/cmd@geometry_msgs/msg/Twist]gz.msgs.Twist",
            "/both@std_msgs/msg/String@gz.msgs.StringMsg",
            "/world/w/control@ros_gz_interfaces/srv/ControlWorld",
        ]
    )
    assert [bridge.direction for bridge in bridges] == ["GZ_TO_ROS", "ROS_TO_GZ", "BIDIRECTIONAL"]
    assert bridges[0].ros_topic == "/scan"
    assert services == ["/world/w/control"]


@pytest.mark.parametrize(
    ("gz", "here"),
    [
        ("/world/hall/model/cart/link/base/sensor/lidar/scan/points", "/cart/base/lidar/scan/points"),
        ("/world/hall/model/cart/model/mast/link/top/sensor/eye/image", "/cart/mast/top/eye/image"),
        ("/world/hall/clock", "/clock"),
        ("/model/cart/odometry", "/model/cart/odometry"),
        ("scan", "/scan"),
    ],
)
def test_gzs_long_names_mean_the_simulators(gz: str, here: str):
    assert simulator_topic(gz) == here


def test_files_may_give_two_names(tmp_path: Path):
    path = tmp_path / "bridge.yaml"
    path.write_text(FILE)
    (first, second), services = read_file(path)
    assert services == ["/world/hall/control"]
    assert first == Bridge("odom", "/model/cart/odometry", "nav_msgs/msg/Odometry", "gz.msgs.Odometry", "GZ_TO_ROS")
    assert (second.ros_topic, second.gz_topic, second.direction) == ("cmd_vel", "cmd_vel", "BIDIRECTIONAL")


@pytest.mark.parametrize(
    ("word", "words"),
    [
        ("/scan", "'/scan' is not a bridge"),
        ("/scan@sensor_msgs/msg/LaserScan@gz.msgs.Image", "stands for gz.msgs.LaserScan, not for gz.msgs.Image"),
        (
            "/scan@sensor_msgs/msg/LaserScn@gz.msgs.LaserScan",
            "bridged; did you mean 'sensor_msgs/msg/LaserScan'",
        ),
    ],
)
def test_what_can_not_be_is_explained(word: str, words: str):
    with pytest.raises(MappingError, match=words):
        parse_arguments([word])


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("- a: [", "bridge.yaml:"),
        ("a: b", "expected a list"),
        ("- 3", "entry 1: expected names"),
        ("- topic_name: a\n  ros_type_name: std_msgs/msg/String", "entry 1: <gz_type_name> is missing"),
        (FILE.replace("GZ_TO_ROS", "UP"), "entry 1: direction is 'UP'"),
    ],
)
def test_faulty_files_are_explained(tmp_path: Path, text: str, words: str):
    path = tmp_path / "bridge.yaml"
    path.write_text(text)
    with pytest.raises(MappingError, match=words):
        read_file(path)
