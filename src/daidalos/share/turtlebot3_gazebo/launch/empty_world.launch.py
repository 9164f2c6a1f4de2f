"""A TurtleBot3 on an empty ground; the environment variable TURTLEBOT3_MODEL is waffle or burger."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    place = ("x_pose", "y_pose")
    return LaunchDescription(
        [
            *(DeclareLaunchArgument(n, default_value="0.0", description="where the robot stands [m]") for n in place),
            IncludeLaunchDescription(
                PathJoinSubstitution([FindPackageShare("turtlebot3_gazebo"), "launch", "turtlebot3_world.launch.py"]),
                launch_arguments={"world": "", **{name: LaunchConfiguration(name) for name in place}}.items(),
            ),
        ]
    )
