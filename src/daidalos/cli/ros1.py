"""Commands of ROS 1, which answer with the command that stands for them today."""

from __future__ import annotations

import shlex
import sys
from collections.abc import Sequence
from pathlib import Path

_RENAMED = {
    "rosbag": "ros2 bag",
    "roslaunch": "ros2 launch",
    "rosmsg": "ros2 interface",
    "rosnode": "ros2 node",
    "rosparam": "ros2 param",
    "rosrun": "ros2 run",
    "rosservice": "ros2 service",
    "rossrv": "ros2 interface",
    "rostest": "launch_test",
    "rostopic": "ros2 topic",
    "roswtf": "ros2 doctor",
}
"""Commands whose arguments are understood as they are, apart from those in `_FORMS`."""

_FORMS = {
    "catkin": "colcon build",
    "catkin_init_workspace": "mkdir -p my_workspace/src (nothing has to be initialized)",
    "catkin_make": "colcon build",
    "rosbag check": "ros2 bag info BAG",
    "rosbag filter": "ros2 bag convert -i BAG -o OPTIONS.yaml",
    "rosclean": "rm -r ~/.ros/log",
    "roscore": "nothing: there is no master, so start your nodes",
    "rosmake": "colcon build",
    "rosmsg list": "ros2 interface list -m",
    "rosmsg packages": "ros2 interface packages -m",
    "rosmsg show": "ros2 interface show PACKAGE/msg/NAME",
    "rosnode cleanup": "nothing: a node that ended leaves the graph by itself",
    "rosnode kill": "Ctrl-C in the node's terminal",
    "rosnode ping": "ros2 node info NODE",
    "rospack": "ros2 pkg list",
    "rospack find": "ros2 pkg prefix --share PACKAGE",
    "rosparam delete": "ros2 param delete NODE NAME",
    "rosparam dump": "ros2 param dump NODE",
    "rosparam get": "ros2 param get NODE NAME",
    "rosparam load": "ros2 param load NODE FILE",
    "rosparam set": "ros2 param set NODE NAME VALUE",
    "rosservice args": "ros2 interface show PACKAGE/srv/NAME",
    "rosservice call": "ros2 service call SERVICE TYPE 'VALUES'",
    "rosservice uri": "ros2 service info SERVICE",
    "rossrv list": "ros2 interface list -s",
    "rossrv packages": "ros2 interface packages -s",
    "rossrv show": "ros2 interface show PACKAGE/srv/NAME",
    "rosversion": "echo $ROS_DISTRO",
    "rviz": "rviz2",
}
"""Today's form of commands, or of their verbs, whose arguments have changed."""


def main() -> int:
    """Answer the command by whose name this program was called."""
    name = Path(sys.argv[0]).stem
    sys.stderr.write(f"{name} is a command of ROS 1; in ROS 2: {today(name, sys.argv[1:])}\n")
    return 1


def today(name: str, arguments: Sequence[str]) -> str:
    """Return what stands for a command line of ROS 1 today."""
    verb = next((word for word in arguments if not word.startswith("-")), "")
    form = _FORMS.get(f"{name} {verb}") or _FORMS.get(name)
    return form or shlex.join([*_RENAMED[name].split(), *arguments])


def catkin_create_pkg() -> int:
    """Run `catkin_create_pkg`, which asks for the name of a distribution of ROS, with the one of the environment."""
    from catkin_pkg.cli.create_pkg import main as create

    from daidalos.distribution import complete_environment

    complete_environment()
    create(sys.argv[1:])
    return 0
