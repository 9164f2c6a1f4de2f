"""Commands of ROS 1 and what they answer."""

import sys
import tomllib
from pathlib import Path

import pytest

from daidalos.cli import ros1
from places import REPOSITORY


@pytest.mark.parametrize(
    ("line", "answer"),
    [
        ("roscore", "nothing: there is no master, so start your nodes"),
        ("rostopic echo /chatter", "ros2 topic echo /chatter"),
        ("rosrun turtlesim turtlesim_node", "ros2 run turtlesim turtlesim_node"),
        ("roslaunch tb3_gazebo world.launch x:=1", "ros2 launch tb3_gazebo world.launch x:=1"),
        ("rosmsg show std_msgs/String", "ros2 interface show PACKAGE/msg/NAME"),
        ("rosparam set /turtlesim/background_r 3", "ros2 param set NODE NAME VALUE"),
        ("rosnode list", "ros2 node list"),
        ("catkin_make -j4", "colcon build"),
        ("catkin build", "colcon build"),
    ],
)
def test_a_command_answers_with_todays(
    line: str, answer: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    name, *arguments = line.split()
    monkeypatch.setattr(sys, "argv", [f"/somewhere/bin/{name}", *arguments])
    assert ros1.main() == 1
    assert capsys.readouterr().err == f"{name} is a command of ROS 1; in ROS 2: {answer}\n"


def test_every_command_that_is_installed_has_an_answer() -> None:
    scripts = tomllib.loads((REPOSITORY / "pyproject.toml").read_text())["project"]["scripts"]
    names = [name for name, function in scripts.items() if function == "daidalos.cli.ros1:main"]
    assert {"roscore", "rosrun", "roslaunch", "rostopic", "catkin_make"} <= set(names)
    assert all(ros1.today(name, []) for name in names)


def test_a_package_of_ros_1_can_be_created_without_a_distribution_in_the_environment(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("ROS_DISTRO", raising=False)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "argv", ["catkin_create_pkg", "beginner_tutorials", "std_msgs", "rospy"])
    assert ros1.catkin_create_pkg() == 0
    assert "<build_depend>rospy</build_depend>" in (tmp_path / "beginner_tutorials" / "package.xml").read_text()
