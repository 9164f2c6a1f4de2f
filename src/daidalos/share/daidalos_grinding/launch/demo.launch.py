"""A grinding cell, its robot, and the studio with the height field and plots of force and cylinder."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, Shutdown
from launch.conditions import IfCondition
from launch.substitutions import Command, LaunchConfiguration, PathJoinSubstitution, PythonExpression
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    def value(name, kind):
        return ParameterValue(LaunchConfiguration(name), value_type=kind)

    xacro = PathJoinSubstitution([FindPackageShare("irb8700_description"), "urdf", "irb8700.urdf.xacro"])
    cell = {
        "task": LaunchConfiguration("task"),
        "controller": LaunchConfiguration("controller"),
        "speed": value("speed", float),
        "seed": value("seed", int),
    }
    headless = PythonExpression(["'' if '", LaunchConfiguration("open_browser"), "' == 'true' else '--headless'"])
    return LaunchDescription(
        [
            DeclareLaunchArgument("task", default_value="clamp", description="clamp or plate"),
            DeclareLaunchArgument("controller", default_value="pi", description="force controller"),
            DeclareLaunchArgument("speed", default_value="1.0", description="of the process, 1 for real time"),
            DeclareLaunchArgument("seed", default_value="0", description="of noise and errors"),
            DeclareLaunchArgument("studio", default_value="true", description="whether to serve the studio"),
            DeclareLaunchArgument("open_browser", default_value="true", description="whether to open it"),
            DeclareLaunchArgument("port", default_value="8765", description="of the studio"),
            Node(
                package="robot_state_publisher",
                executable="robot_state_publisher",
                parameters=[{"robot_description": ParameterValue(Command(["xacro ", xacro]), value_type=str)}],
            ),
            Node(
                package="daidalos_grinding",
                executable="grinding_cell",
                parameters=[cell],
                output="screen",
                on_exit=[Shutdown()],
            ),
            Node(
                package="daidalos_grinding",
                executable="grinding_studio",
                arguments=["--port", LaunchConfiguration("port"), headless],
                condition=IfCondition(LaunchConfiguration("studio")),
                output="screen",
            ),
        ]
    )
