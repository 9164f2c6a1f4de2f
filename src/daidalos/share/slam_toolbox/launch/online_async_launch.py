"""SLAM on live data."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    parameters = PathJoinSubstitution([FindPackageShare("slam_toolbox"), "config", "mapper_params_online_async.yaml"])
    use_sim_time = ParameterValue(LaunchConfiguration("use_sim_time"), value_type=bool)
    return LaunchDescription(
        [
            DeclareLaunchArgument("use_sim_time", default_value="true", description="whether time is simulated"),
            DeclareLaunchArgument("slam_params_file", default_value=parameters, description="parameter file"),
            Node(
                package="slam_toolbox",
                executable="async_slam_toolbox_node",
                name="slam_toolbox",
                parameters=[LaunchConfiguration("slam_params_file"), {"use_sim_time": use_sim_time}],
                output="screen",
            ),
        ]
    )
