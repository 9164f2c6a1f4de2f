"""The two-armed robot ABB IRB 14000 YuMi in the simulator, with a trajectory and a gripper controller for each arm."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    here = FindPackageShare("irb14000_description")
    return LaunchDescription(
        [
            DeclareLaunchArgument("world", default_value="", description="SDF world to simulate (default: empty)"),
            DeclareLaunchArgument("gui", default_value="true", description="whether to serve the studio"),
            IncludeLaunchDescription(
                PathJoinSubstitution([FindPackageShare("humanoid_description"), "launch", "controlled.launch.py"]),
                launch_arguments={
                    "model": PathJoinSubstitution([here, "urdf", "irb14000_controlled.urdf.xacro"]),
                    "name": "irb14000",
                    "controllers": "joint_state_broadcaster left_arm_controller right_arm_controller "
                    "left_gripper_controller right_gripper_controller",
                    "world": LaunchConfiguration("world"),
                    "gui": LaunchConfiguration("gui"),
                }.items(),
            ),
        ]
    )
