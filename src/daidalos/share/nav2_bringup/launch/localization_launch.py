"""Localization in a saved map: the map server and AMCL, each in a process or both in a container."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.conditions import IfCondition, UnlessCondition
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import LoadComposableNodes, Node
from launch_ros.descriptions import ComposableNode, ParameterFile
from launch_ros.substitutions import FindPackageShare
from nav2_common.launch import RewrittenYaml

ARGUMENTS = [
    ("namespace", "", "namespace of all nodes"),
    ("map", "", "map file; that of the parameter file where empty"),
    ("use_sim_time", "false", "whether the simulator's clock is used"),
    ("autostart", "true", "whether the nodes are activated at once"),
    ("use_composition", "False", "whether the nodes are loaded into a container"),
    ("container_name", "nav2_container", "name of that container"),
    ("use_respawn", "True", "whether a process that ends is started again"),
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
            OpaqueFunction(function=nodes),
        ]
    )


def nodes(context):
    """Return the actions that start the nodes, given what the arguments are."""
    value = LaunchConfiguration
    namespace, map_file = value("namespace").perform(context), value("map").perform(context)
    file = RewrittenYaml(
        source_file=value("params_file"), root_key=value("namespace"), param_rewrites={}, convert_types=True
    )
    clock = {"use_sim_time": value("use_sim_time")}
    params = [ParameterFile(file, allow_substs=True), clock]
    of_map = [*params, {"yaml_filename": map_file}] if map_file else params
    manager = [clock, {"autostart": value("autostart"), "node_names": ["map_server", "amcl"]}]
    remappings = [("/tf", "tf"), ("/tf_static", "tf_static")]
    listed = [
        ("nav2_map_server", "map_server", "MapServer", "map_server", of_map),
        ("nav2_amcl", "amcl", "AmclNode", "amcl", params),
        ("nav2_lifecycle_manager", "lifecycle_manager", "LifecycleManager", "lifecycle_manager_localization", manager),
    ]
    processes = [
        Node(
            package=package,
            executable=executable,
            name=name,
            namespace=namespace,
            parameters=parameters,
            remappings=remappings,
            respawn=value("use_respawn"),
            respawn_delay=2.0,
            output="screen",
            arguments=["--ros-args", "--log-level", value("log_level")],
            condition=UnlessCondition(value("use_composition")),
        )
        for package, executable, _, name, parameters in listed
    ]
    components = [
        ComposableNode(
            package=package,
            plugin=f"{package}::{kind}",
            name=name,
            namespace=namespace,
            parameters=parameters,
            remappings=remappings,
        )
        for package, _, kind, name, parameters in listed
    ]
    load = LoadComposableNodes(
        target_container=(namespace, "/", value("container_name")),
        composable_node_descriptions=components,
        condition=IfCondition(value("use_composition")),
    )
    return [*processes, load]
