"""A robot, its joints on sliders, and a view on it."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.conditions import IfCondition, UnlessCondition
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    here = FindPackageShare("urdf_launch")
    return LaunchDescription(
        [
            DeclareLaunchArgument("urdf_package", description="package that holds the robot's description"),
            DeclareLaunchArgument("urdf_package_path", description="the description in it, such as urdf/robot.urdf"),
            DeclareLaunchArgument("jsp_gui", default_value="true", description="joints on sliders"),
            DeclareLaunchArgument("rviz", default_value="true", description="whether to open the view"),
            DeclareLaunchArgument(
                "rviz_config",
                default_value=PathJoinSubstitution([here, "config", "urdf.rviz"]),
                description="what the view shows",
            ),
            IncludeLaunchDescription(
                PathJoinSubstitution([here, "launch", "description.launch.py"]),
                launch_arguments={
                    "urdf_package": LaunchConfiguration("urdf_package"),
                    "urdf_package_path": LaunchConfiguration("urdf_package_path"),
                }.items(),
            ),
            Node(
                package="joint_state_publisher",
                executable="joint_state_publisher",
                condition=UnlessCondition(LaunchConfiguration("jsp_gui")),
            ),
            Node(
                package="joint_state_publisher_gui",
                executable="joint_state_publisher_gui",
                condition=IfCondition(LaunchConfiguration("jsp_gui")),
            ),
            Node(
                package="rviz2",
                executable="rviz2",
                arguments=["-d", LaunchConfiguration("rviz_config")],
                condition=IfCondition(LaunchConfiguration("rviz")),
                output="screen",
            ),
        ]
    )
