"""The arm ABB IRB 6700-150/3.20 in the simulator, for `daidalos rapid run --robot irb6700 --sim`."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    here = FindPackageShare("irb6700_description")
    return LaunchDescription(
        [
            DeclareLaunchArgument("world", default_value="", description="SDF world to simulate (default: empty)"),
            DeclareLaunchArgument("pen", default_value="0", description="length of a pen on the flange [mm]"),
            DeclareLaunchArgument("gui", default_value="true", description="whether to serve the studio"),
            IncludeLaunchDescription(
                PathJoinSubstitution([FindPackageShare("humanoid_description"), "launch", "controlled.launch.py"]),
                launch_arguments={
                    "model": [
                        PathJoinSubstitution([here, "urdf", "irb6700_controlled.urdf.xacro"]),
                        *(" pen:=", LaunchConfiguration("pen")),
                    ],
                    "name": "irb6700",
                    "controllers": "joint_state_broadcaster joint_trajectory_controller",
                    "world": LaunchConfiguration("world"),
                    "gui": LaunchConfiguration("gui"),
                }.items(),
            ),
        ]
    )
