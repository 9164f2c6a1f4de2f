"""The multiplexer of velocities."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    topics, locks = (
        PathJoinSubstitution([FindPackageShare("twist_mux"), "config", name])
        for name in ("twist_mux_topics.yaml", "twist_mux_locks.yaml")
    )
    use_sim_time = ParameterValue(LaunchConfiguration("use_sim_time"), value_type=bool)
    return LaunchDescription(
        [
            DeclareLaunchArgument("config_topics", default_value=topics, description="parameter file of the sources"),
            DeclareLaunchArgument("config_locks", default_value=locks, description="parameter file of the locks"),
            DeclareLaunchArgument(
                "cmd_vel_out",
                default_value="twist_mux/cmd_vel",
                description="topic of the velocities that are passed on",
            ),
            DeclareLaunchArgument("use_sim_time", default_value="False", description="whether time is simulated"),
            Node(
                package="twist_mux",
                executable="twist_mux",
                output="screen",
                remappings=[("/cmd_vel_out", LaunchConfiguration("cmd_vel_out"))],
                parameters=[
                    {"use_sim_time": use_sim_time},
                    LaunchConfiguration("config_locks"),
                    LaunchConfiguration("config_topics"),
                ],
            ),
        ]
    )
