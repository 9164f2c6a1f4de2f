"""Navigation of a TurtleBot3 without physics, in a saved map, with RViz: the loopback simulator moves it as told."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.conditions import IfCondition
from launch.substitutions import Command, LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.descriptions import ParameterFile
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare
from nav2_common.launch import RewrittenYaml

PASSED = ("namespace", "map", "params_file", "autostart", "use_composition", "use_respawn")
"""Arguments of bringup_launch.py."""

REMAPPINGS = [("/tf", "tf"), ("/tf_static", "tf_static")]
CLOCK = {"use_sim_time": True}


def in_package(package, *parts):
    """Return the path of a file of a package."""
    return PathJoinSubstitution([FindPackageShare(package), *parts])


def included(path, condition=None, **arguments):
    """Return the inclusion of a launch file."""
    return IncludeLaunchDescription(path, launch_arguments=arguments.items(), condition=condition)


def generate_launch_description():
    value = LaunchConfiguration
    arguments = [
        ("namespace", "", "namespace of all nodes"),
        ("map", in_package("nav2_bringup", "maps", "turtlebot3_world.yaml"), "map file"),
        (
            "model",
            in_package("turtlebot3_description", "urdf", "turtlebot3_waffle.urdf.xacro"),
            "xacro of the robot",
        ),
        ("params_file", in_package("nav2_bringup", "params", "nav2_params.yaml"), "parameter file"),
        ("autostart", "true", "whether the nodes are activated at once"),
        ("use_composition", "True", "whether the nodes share a process"),
        ("use_respawn", "False", "whether a process that ends is started again"),
        ("rviz_config_file", in_package("nav2_bringup", "rviz", "nav2_default_view.rviz"), "file with the displays"),
        ("use_robot_state_pub", "True", "whether the robot's description is published"),
        ("use_rviz", "True", "whether RViz is opened"),
    ]
    return LaunchDescription(
        [
            *(DeclareLaunchArgument(name, default_value=text, description=what) for name, text, what in arguments),
            robot_state_publisher(),
            *map_server(),
            included(
                in_package("nav2_loopback_sim", "loopback_simulation.launch.py"), params_file=value("params_file")
            ),
            included(
                in_package("nav2_bringup", "launch", "rviz_launch.py"),
                IfCondition(value("use_rviz")),
                namespace=value("namespace"),
                rviz_config=value("rviz_config_file"),
                use_sim_time="true",
            ),
            included(
                in_package("nav2_bringup", "launch", "bringup_launch.py"),
                use_sim_time="true",
                use_localization="False",
                **{name: value(name) for name in PASSED},
            ),
        ]
    )


def robot_state_publisher():
    """Return the publisher of the robot's description."""
    return Node(
        package="robot_state_publisher",
        executable="robot_state_publisher",
        namespace=LaunchConfiguration("namespace"),
        parameters=[
            CLOCK,
            {"robot_description": ParameterValue(Command(["xacro ", LaunchConfiguration("model")]), value_type=str)},
        ],
        remappings=REMAPPINGS,
        output="screen",
        condition=IfCondition(LaunchConfiguration("use_robot_state_pub")),
    )


def map_server():
    """Return the map server and what activates it: without localization nobody else starts them."""
    value = LaunchConfiguration
    file = RewrittenYaml(
        source_file=value("params_file"), root_key=value("namespace"), param_rewrites={}, convert_types=True
    )
    parameters = [ParameterFile(file, allow_substs=True), CLOCK]
    common = {"namespace": value("namespace"), "output": "screen", "remappings": REMAPPINGS}
    return [
        Node(
            package="nav2_map_server",
            executable="map_server",
            name="map_server",
            parameters=[*parameters, {"yaml_filename": value("map")}],
            respawn=value("use_respawn"),
            respawn_delay=2.0,
            **common,
        ),
        Node(
            package="nav2_lifecycle_manager",
            executable="lifecycle_manager",
            name="lifecycle_manager_map_server",
            parameters=[*parameters, {"autostart": value("autostart"), "node_names": ["map_server"]}],
            **common,
        ),
    ]
