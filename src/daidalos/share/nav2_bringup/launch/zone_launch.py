"""The servers of a costmap filter, of its mask and of what that means, each in a process or both in a container."""

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
    ("zone", "keepout", "keepout or speed, with which the names of the nodes begin"),
    ("mask", "", "map file of the mask; that of the parameter file where empty"),
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
    namespace, zone, mask = (value(name).perform(context) for name in ("namespace", "zone", "mask"))
    file = RewrittenYaml(
        source_file=value("params_file"), root_key=value("namespace"), param_rewrites={}, convert_types=True
    )
    clock = {"use_sim_time": value("use_sim_time")}
    params = [ParameterFile(file, allow_substs=True), clock]
    of_mask = [*params, {"yaml_filename": mask}] if mask else params
    names = f"{zone}_filter_mask_server", f"{zone}_costmap_filter_info_server"
    manager = [clock, {"autostart": value("autostart"), "node_names": list(names)}]
    remappings = [("/tf", "tf"), ("/tf_static", "tf_static")]
    info = "costmap_filter_info_server"
    listed = [
        ("nav2_map_server", "map_server", "MapServer", names[0], of_mask),
        ("nav2_map_server", info, "CostmapFilterInfoServer", names[1], params),
        ("nav2_lifecycle_manager", "lifecycle_manager", "LifecycleManager", f"lifecycle_manager_{zone}_zone", manager),
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
