"""Navigation with a saved map or with SLAM: `slam:=True`, or `map:=FILE`."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction, IncludeLaunchDescription
from launch.conditions import IfCondition
from launch.substitutions import (
    AndSubstitution,
    LaunchConfiguration,
    NotEqualsSubstitution,
    NotSubstitution,
    PathJoinSubstitution,
)
from launch_ros.actions import Node
from launch_ros.descriptions import ParameterFile
from launch_ros.substitutions import FindPackageShare
from nav2_common.launch import RewrittenYaml

ARGUMENTS = [
    ("namespace", "", "namespace of all nodes"),
    ("slam", "False", "whether the map is made while driving"),
    ("map", "", "map file, without SLAM"),
    ("graph", "", "file of the graph of routes; starts the route server"),
    ("keepout_mask", "", "map file of the keepout filter's mask; starts its servers"),
    ("speed_mask", "", "map file of the speed filter's mask; starts its servers"),
    ("use_keepout_zones", "True", "what KEEPOUT_ZONE_ENABLED in the parameter file stands for"),
    ("use_speed_zones", "True", "what SPEED_ZONE_ENABLED in the parameter file stands for"),
    ("use_localization", "True", "whether map and localization are started"),
    ("use_sim_time", "false", "whether the simulator's clock is used"),
    ("autostart", "true", "whether the nodes are activated at once"),
    ("use_composition", "True", "whether the nodes share a process"),
    ("use_respawn", "True", "whether a process that ends is started again"),
    ("log_level", "info", "log level"),
]


def included(name, condition, **arguments):
    """Return the inclusion of a launch file of this package."""
    passed = {key: LaunchConfiguration(key) for key in ("namespace", "use_sim_time", "autostart", "use_respawn")}
    return IncludeLaunchDescription(
        PathJoinSubstitution([FindPackageShare("nav2_bringup"), "launch", name]),
        launch_arguments={**passed, "params_file": LaunchConfiguration("params_file"), **arguments}.items(),
        condition=condition,
    )


def generate_launch_description():
    value = LaunchConfiguration
    default = PathJoinSubstitution([FindPackageShare("nav2_bringup"), "params", "nav2_params.yaml"])
    zones = {"KEEPOUT_ZONE_ENABLED": value("use_keepout_zones"), "SPEED_ZONE_ENABLED": value("use_speed_zones")}
    file = RewrittenYaml(
        source_file=value("params_file"),
        root_key=value("namespace"),
        param_rewrites={},
        value_rewrites=zones,
        convert_types=True,
    )
    composed = {"use_composition": value("use_composition"), "container_name": "nav2_container"}
    localized = AndSubstitution(NotSubstitution(value("slam")), value("use_localization"))
    return LaunchDescription(
        [
            *(DeclareLaunchArgument(name, default_value=text, description=what) for name, text, what in ARGUMENTS),
            DeclareLaunchArgument("params_file", default_value=default, description="parameter file"),
            Node(
                package="rclcpp_components",
                executable="component_container_isolated",
                name="nav2_container",
                namespace=value("namespace"),
                parameters=[ParameterFile(file, allow_substs=True), {"use_sim_time": value("use_sim_time")}],
                remappings=[("/tf", "tf"), ("/tf_static", "tf_static")],
                arguments=["--ros-args", "--log-level", value("log_level")],
                output="screen",
                condition=IfCondition(value("use_composition")),
            ),
            GroupAction(
                [
                    included("slam_launch.py", IfCondition(value("slam"))),
                    included(
                        "localization_launch.py",
                        IfCondition(localized),
                        map=value("map"),
                        **composed,
                    ),
                    *(
                        included(
                            f"{kind}_zone_launch.py",
                            IfCondition(AndSubstitution(NotEqualsSubstitution(mask, ""), used)),
                            **{f"{kind}_mask": mask, f"use_{kind}_zones": used},
                            **composed,
                        )
                        for kind in ("keepout", "speed")
                        for mask, used in [(value(f"{kind}_mask"), value(f"use_{kind}_zones"))]
                    ),
                    included(
                        "navigation_launch.py",
                        None,
                        graph=value("graph"),
                        use_keepout_zones=value("use_keepout_zones"),
                        use_speed_zones=value("use_speed_zones"),
                        **composed,
                    ),
                ]
            ),
        ]
    )
