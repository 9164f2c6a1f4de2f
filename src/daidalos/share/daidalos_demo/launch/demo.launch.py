"""A TurtleBot3 maps the arena and drives where it is sent; the studio shows it in the browser.

Copy this file to begin a robot of your own: it includes nothing but packages' public launch files and nodes.
"""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription, Shutdown
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import ComposableNodeContainer, Node
from launch_ros.descriptions import ComposableNode
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare

CONTAINER = "nav2_container"


def share(package, *parts):
    return PathJoinSubstitution([FindPackageShare(package), *parts])


def generate_launch_description():
    navigation_parameters = share("nav2_bringup", "params", "nav2_params.yaml")
    composed = {"use_composition": "True", "container_name": CONTAINER}
    return LaunchDescription(
        [
            DeclareLaunchArgument("seed", default_value="0", description="of all random numbers"),
            DeclareLaunchArgument("studio", default_value="true", description="whether to serve the studio"),
            DeclareLaunchArgument("open_browser", default_value="true", description="whether to open it"),
            DeclareLaunchArgument("look_around", default_value="true", description="whether to turn once at first"),
            DeclareLaunchArgument("port", default_value="8765", description="of the studio"),
            # All nodes share one process: it saves memory, and messages need not be encoded.
            ComposableNodeContainer(
                name=CONTAINER,
                namespace="",
                package="rclcpp_components",
                executable="component_container_isolated",
                parameters=[navigation_parameters],
                composable_node_descriptions=[
                    ComposableNode(
                        package="foxglove_bridge",
                        plugin="foxglove_bridge::FoxgloveBridge",
                        name="foxglove_bridge",
                        parameters=[
                            {
                                "port": ParameterValue(LaunchConfiguration("port"), value_type=int),
                                "open_browser": ParameterValue(LaunchConfiguration("open_browser"), value_type=bool),
                            }
                        ],
                        condition=IfCondition(LaunchConfiguration("studio")),
                    ),
                    ComposableNode(
                        package="slam_toolbox",
                        plugin="slam_toolbox::AsynchronousSlamToolbox",
                        name="slam_toolbox",
                        parameters=[
                            share("slam_toolbox", "config", "mapper_params_online_async.yaml"),
                            {"use_sim_time": True},
                        ],
                    ),
                ],
                on_exit=Shutdown(reason="the container of all nodes has ended"),
                output="screen",
            ),
            IncludeLaunchDescription(
                share("turtlebot3_gazebo", "launch", "turtlebot3_arena.launch.py"),
                launch_arguments={"seed": LaunchConfiguration("seed"), **composed}.items(),
            ),
            IncludeLaunchDescription(
                share("nav2_bringup", "launch", "navigation_launch.py"),
                launch_arguments={"params_file": navigation_parameters, **composed}.items(),
            ),
            Node(
                package="daidalos_demo",
                executable="look_around",
                condition=IfCondition(LaunchConfiguration("look_around")),
                output="screen",
            ),
        ]
    )
