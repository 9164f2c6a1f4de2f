"""A work cell in the simulator: a table under a moving head and a laser projector, and a depth camera.

The devices are real up to the network: `simulated_head` receives Art-Net, turns the axes at the speed of the fixture,
and shows the beam up to what it meets; `simulated_laser` receives IDN, and shows its picture on what it meets.
"""

from math import pi

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, Shutdown
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare


def share(*parts):
    return PathJoinSubstitution([FindPackageShare("daidalos_lighting"), *parts])


def value(name, kind):
    return ParameterValue(LaunchConfiguration(name), value_type=kind)


def words(options):
    return [str(one) for pair in options.items() for one in pair]


def generate_launch_description():
    urdf = share("urdf", "moving_head.urdf")
    studio = {"port": value("port", int), "open_browser": value("open_browser", bool)}
    has_camera = IfCondition(LaunchConfiguration("camera"))
    camera = {"-entity": "camera", "-x": -0.3, "-z": 2.4, "-P": pi / 2, "-Y": pi / 2}
    lens = {"--x": -0.3, "--z": 2.4, "--roll": pi, "--frame-id": "world", "--child-frame-id": "camera_optical"}
    return LaunchDescription(
        [
            DeclareLaunchArgument("studio", default_value="true", description="whether to serve the studio"),
            DeclareLaunchArgument("open_browser", default_value="true", description="whether to open it"),
            DeclareLaunchArgument("port", default_value="8765", description="of the studio"),
            DeclareLaunchArgument("artnet_port", default_value="6454", description="UDP port of the head's Art-Net"),
            DeclareLaunchArgument("laser", default_value="true", description="whether there is a laser projector"),
            DeclareLaunchArgument("camera", default_value="false", description="whether there is a depth camera"),
            DeclareLaunchArgument("idn_port", default_value="7255", description="UDP port of the laser's IDN"),
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
                package="tf2_ros",
                executable="static_transform_publisher",
                arguments=words(lens),
                condition=has_camera,
            ),
            Node(
                package="gazebo_ros",
                executable="spawn_entity.py",
                arguments=["-file", share("models", "depth_camera.sdf"), *words(camera)],
                condition=has_camera,
            ),
            Node(
                package="daidalos_lighting",
                executable="simulated_head",
                parameters=[{"config": share("config", "head.yaml"), "port": value("artnet_port", int)}],
                output="screen",
                on_exit=[Shutdown()],
            ),
            Node(
                package="daidalos_lighting",
                executable="simulated_laser",
                parameters=[{"port": value("idn_port", int)}],
                output="screen",
                on_exit=[Shutdown()],
                condition=IfCondition(LaunchConfiguration("laser")),
            ),
            Node(package="daidalos_lighting", executable="cell_view", output="screen"),
            Node(
                package="foxglove_bridge",
                executable="foxglove_bridge",
                parameters=[studio],
                condition=IfCondition(LaunchConfiguration("studio")),
                output="screen",
                on_exit=[Shutdown()],
            ),
        ]
    )
