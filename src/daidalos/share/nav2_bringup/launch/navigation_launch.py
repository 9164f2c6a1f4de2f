"""The navigation stack, each server in a process or all in a container.

Commands of the controller and the behaviours go through the velocity smoother and the collision monitor to `cmd_vel`.
The docking, following and route servers are started where the parameter file has something for them.
"""

import re
from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.conditions import IfCondition, UnlessCondition
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import LoadComposableNodes, Node, SetParameter
from launch_ros.descriptions import ComposableNode, ParameterFile
from launch_ros.substitutions import FindPackageShare
from nav2_common.launch import RewrittenYaml

COMMANDS = [("cmd_vel", "cmd_vel_nav")]
SERVERS = [
    ("nav2_controller", "controller_server", "nav2_controller::ControllerServer", COMMANDS),
    ("nav2_smoother", "smoother_server", "nav2_smoother::SmootherServer", []),
    ("nav2_planner", "planner_server", "nav2_planner::PlannerServer", []),
    ("nav2_route", "route_server", "nav2_route::RouteServer", []),
    ("nav2_behaviors", "behavior_server", "behavior_server::BehaviorServer", COMMANDS),
    ("nav2_velocity_smoother", "velocity_smoother", "nav2_velocity_smoother::VelocitySmoother", COMMANDS),
    ("nav2_collision_monitor", "collision_monitor", "nav2_collision_monitor::CollisionMonitor", []),
    ("nav2_bt_navigator", "bt_navigator", "nav2_bt_navigator::BtNavigator", []),
    ("nav2_waypoint_follower", "waypoint_follower", "nav2_waypoint_follower::WaypointFollower", []),
    ("opennav_docking", "docking_server", "opennav_docking::DockingServer", []),
    ("opennav_following", "following_server", "opennav_following::FollowingServer", COMMANDS),
]
OPTIONAL = ("route_server", "docking_server", "following_server")
EXECUTABLES = {"docking_server": "opennav_docking", "following_server": "opennav_following"}
MANAGER = ("nav2_lifecycle_manager", "lifecycle_manager", "nav2_lifecycle_manager::LifecycleManager")
ARGUMENTS = [
    ("namespace", "", "namespace of all nodes"),
    ("use_sim_time", "false", "whether the simulator's clock is used, where the parameter file does not say"),
    ("autostart", "true", "whether the nodes are activated at once"),
    ("use_composition", "False", "whether the nodes are loaded into a container"),
    ("container_name", "nav2_container", "name of that container"),
    ("use_respawn", "True", "whether a process that ends is started again"),
    ("graph", "", "file of the graph of routes; starts the route server"),
    ("use_keepout_zones", "True", "what KEEPOUT_ZONE_ENABLED in the parameter file stands for"),
    ("use_speed_zones", "True", "what SPEED_ZONE_ENABLED in the parameter file stands for"),
    ("log_level", "info", "log level"),
]


def generate_launch_description():
    return LaunchDescription(
        [
            *(DeclareLaunchArgument(name, default_value=text, description=what) for name, text, what in ARGUMENTS),
            DeclareLaunchArgument(
                "params_file",
                default_value=PathJoinSubstitution([FindPackageShare("nav2_bringup"), "params", "nav2_params.yaml"]),
                description="parameter file",
            ),
            SetParameter("use_sim_time", LaunchConfiguration("use_sim_time")),
            OpaqueFunction(function=nodes),
        ]
    )


def nodes(context):
    """Return the actions that start the nodes, given what the arguments are."""
    value = LaunchConfiguration
    namespace = value("namespace").perform(context)
    zones = {"KEEPOUT_ZONE_ENABLED": value("use_keepout_zones"), "SPEED_ZONE_ENABLED": value("use_speed_zones")}
    file = RewrittenYaml(
        source_file=value("params_file"),
        root_key=value("namespace"),
        param_rewrites={},
        value_rewrites=zones,
        convert_types=True,
    )
    given = ParameterFile(file, allow_substs=True)
    graph = value("graph").perform(context)
    path = Path(value("params_file").perform(context))
    text = path.read_text(encoding="utf-8", errors="replace") if path.is_file() else ""
    servers = [server for server in SERVERS if is_wanted(server[1], text, graph)]
    of_server = {"route_server": [given, {"graph_filepath": graph}]} if graph else {}
    transforms = [("/tf", "tf"), ("/tf_static", "tf_static")]
    manager = {"autostart": value("autostart"), "node_names": [name for _, name, *_ in servers]}
    listed = [
        *(
            (package, EXECUTABLES.get(name, name), plugin, name, of_server.get(name, [given]), remappings)
            for package, name, plugin, remappings in servers
        ),
        (*MANAGER, "lifecycle_manager_navigation", [given, manager], []),
    ]
    processes = [
        Node(
            package=package,
            executable=executable,
            name=name,
            namespace=namespace,
            parameters=parameters,
            remappings=[*transforms, *remappings],
            respawn=value("use_respawn"),
            respawn_delay=2.0,
            output="screen",
            arguments=["--ros-args", "--log-level", value("log_level")],
            condition=UnlessCondition(value("use_composition")),
        )
        for package, executable, _, name, parameters, remappings in listed
    ]
    components = [
        ComposableNode(
            package=package,
            plugin=plugin,
            name=name,
            namespace=namespace,
            parameters=parameters,
            remappings=[*transforms, *remappings],
        )
        for package, _, plugin, name, parameters, remappings in listed
    ]
    load = LoadComposableNodes(
        target_container=(namespace, "/", value("container_name")),
        composable_node_descriptions=components,
        condition=IfCondition(value("use_composition")),
    )
    return [*processes, load]


def is_wanted(name, text, graph):
    """Return whether a server is started: one that not all robots need, where the parameters or the graph name it."""
    if name not in OPTIONAL or (name == "route_server" and graph):
        return True
    return re.search(rf"^\s*['\"]?(/\S*/)?{name}['\"]?:", text, re.MULTILINE) is not None
