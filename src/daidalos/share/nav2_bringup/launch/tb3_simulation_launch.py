"""A simulated TurtleBot3 that navigates: simulator, robot, navigation with a map or SLAM, and RViz."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction, IncludeLaunchDescription
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration, NotSubstitution, PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare

PASSED = ("namespace", "slam", "map", "use_sim_time", "params_file", "autostart", "use_composition", "use_respawn")
"""Arguments of bringup_launch.py."""


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
        ("slam", "False", "whether the map is made while driving"),
        ("map", in_package("nav2_bringup", "maps", "turtlebot3_world.yaml"), "map file, without SLAM"),
        ("use_sim_time", "true", "whether the simulator's clock is used"),
        ("params_file", in_package("nav2_bringup", "params", "nav2_params.yaml"), "parameter file"),
        ("autostart", "true", "whether the nodes are activated at once"),
        ("use_composition", "True", "whether the nodes share a process"),
        ("use_respawn", "False", "whether a process that ends is started again"),
        ("rviz_config_file", in_package("nav2_bringup", "rviz", "nav2_default_view.rviz"), "file with the displays"),
        (
            "robot_launch",
            in_package("turtlebot3_gazebo", "launch", "turtlebot3_world.launch.py"),
            "launch file of simulator and robot",
        ),
        ("use_simulator", "True", "whether simulator and robot are started"),
        ("use_rviz", "True", "whether RViz is opened"),
        ("headless", "True", "whether the simulator has no window of its own"),
        ("world", in_package("turtlebot3_gazebo", "worlds", "hexagon.world"), "SDF world to simulate"),
        ("x_pose", "-2.0", "where the robot stands [m]"),
        ("y_pose", "-0.5", "where the robot stands [m]"),
        ("yaw", "0.0", "where it looks [rad]"),
    ]
    return LaunchDescription(
        [
            *(DeclareLaunchArgument(name, default_value=text, description=what) for name, text, what in arguments),
            # In a scope of its own: arguments of an inclusion hold for what follows it as well.
            GroupAction(
                [
                    included(
                        value("robot_launch"),
                        use_composition="False",
                        gui=NotSubstitution(value("headless")),
                        **{name: value(name) for name in ("world", "x_pose", "y_pose", "yaw")},
                    )
                ],
                condition=IfCondition(value("use_simulator")),
            ),
            included(
                in_package("nav2_bringup", "launch", "rviz_launch.py"),
                IfCondition(value("use_rviz")),
                namespace=value("namespace"),
                rviz_config=value("rviz_config_file"),
                use_sim_time=value("use_sim_time"),
            ),
            included(
                in_package("nav2_bringup", "launch", "bringup_launch.py"), **{name: value(name) for name in PASSED}
            ),
        ]
    )
