"""A moving head over a table in the simulator: it points at parts in turn, until somebody publishes a point.

The head is real from the message on: `moving_head` sends Art-Net, `simulated_head` receives it, turns the axes at the
speed of the fixture, and shows the beam up to what it meets.
"""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, Shutdown
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare


def share(*parts):
    return PathJoinSubstitution([FindPackageShare("daidalos_lighting"), *parts])


def generate_launch_description():
    urdf = share("urdf", "moving_head.urdf")
    port = ParameterValue(LaunchConfiguration("artnet_port"), value_type=int)
    config = {"config": share("config", "head.yaml")}
    studio = {
        "port": ParameterValue(LaunchConfiguration("port"), value_type=int),
        "open_browser": ParameterValue(LaunchConfiguration("open_browser"), value_type=bool),
    }
    return LaunchDescription(
        [
            DeclareLaunchArgument("studio", default_value="true", description="whether to serve the studio"),
            DeclareLaunchArgument("open_browser", default_value="true", description="whether to open it"),
            DeclareLaunchArgument("port", default_value="8765", description="of the studio"),
            DeclareLaunchArgument("artnet_port", default_value="6454", description="UDP port of Art-Net"),
            Node(
                package="gazebo_ros",
                executable="gzserver",
                arguments=[share("worlds", "cell.world")],
                output="screen",
                on_exit=[Shutdown()],
            ),
            Node(package="gazebo_ros", executable="spawn_entity.py", arguments=["-file", urdf, "-entity", "head"]),
            Node(package="robot_state_publisher", executable="robot_state_publisher", arguments=[urdf]),
            Node(
                package="daidalos_lighting",
                executable="moving_head",
                parameters=[config, {"artnet_port": port}],
                remappings=[("joint_states", "aimed_joint_states"), ("point", "clicked_point")],
                output="screen",
            ),
            Node(
                package="daidalos_lighting",
                executable="simulated_head",
                parameters=[config, {"port": port}],
                output="screen",
                on_exit=[Shutdown()],
            ),
            Node(package="daidalos_lighting", executable="tour", output="screen"),
            Node(package="daidalos_lighting", executable="cell_view", output="screen"),
            Node(
                package="foxglove_bridge",
                executable="foxglove_bridge",
                parameters=[studio],
                condition=IfCondition(LaunchConfiguration("studio")),
                output="screen",
            ),
        ]
    )
