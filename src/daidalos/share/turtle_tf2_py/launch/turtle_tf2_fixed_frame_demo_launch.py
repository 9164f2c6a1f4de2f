"""Two turtles: the second one follows a carrot that stands beside the first."""

from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription
from launch.substitutions import PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    demo = PathJoinSubstitution([FindPackageShare("turtle_tf2_py"), "launch", "turtle_tf2_demo_launch.py"])
    return LaunchDescription(
        [
            IncludeLaunchDescription(demo, launch_arguments={"target_frame": "carrot1"}.items()),
            Node(
                package="turtle_tf2_py",
                executable="fixed_frame_tf2_broadcaster",
                name="fixed_broadcaster",
            ),
        ]
    )
