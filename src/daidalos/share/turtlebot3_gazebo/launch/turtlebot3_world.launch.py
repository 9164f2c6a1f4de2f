"""A TurtleBot3 in the hexagon; the environment variable TURTLEBOT3_MODEL is waffle or burger."""

import os
from pathlib import Path

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    model = os.environ.get("TURTLEBOT3_MODEL", "waffle")
    model = "burger" if model == "burger" else "waffle"
    hexagon = Path(get_package_share_directory("turtlebot3_gazebo")) / "worlds" / "hexagon.world"
    passed = {name: LaunchConfiguration(name) for name in ("world", "x_pose", "y_pose", "yaw", "seed")}
    return LaunchDescription(
        [
            DeclareLaunchArgument("use_sim_time", default_value="true", description="accepted: it always is"),
            DeclareLaunchArgument("world", default_value=str(hexagon), description="SDF world to simulate"),
            DeclareLaunchArgument("x_pose", default_value="-2.0", description="where the robot stands [m]"),
            DeclareLaunchArgument("y_pose", default_value="-0.5", description="where the robot stands [m]"),
            DeclareLaunchArgument("yaw", default_value="0.0", description="where it looks [rad]"),
            DeclareLaunchArgument("seed", default_value="0", description="of all random numbers"),
            DeclareLaunchArgument("gui", default_value="true", description="whether to serve the studio"),
            IncludeLaunchDescription(
                PathJoinSubstitution([FindPackageShare("turtlebot3_gazebo"), "launch", "turtlebot3_arena.launch.py"]),
                launch_arguments={"urdf": f"turtlebot3_{model}.urdf.xacro", "name": model, **passed}.items(),
            ),
            IncludeLaunchDescription(
                PathJoinSubstitution([FindPackageShare("gazebo_ros"), "launch", "gzclient.launch.py"]),
                launch_arguments={"gui": LaunchConfiguration("gui")}.items(),
            ),
        ]
    )
