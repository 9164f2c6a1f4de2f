"""The navigation stack: planner, controller, behaviours and navigator, each in a process or all in a container."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction
from launch.conditions import IfCondition, UnlessCondition
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import LoadComposableNodes, Node
from launch_ros.descriptions import ComposableNode
from launch_ros.substitutions import FindPackageShare

NODES = [
    ("nav2_controller", "controller_server", "nav2_controller::ControllerServer", "controller_server"),
    ("nav2_planner", "planner_server", "nav2_planner::PlannerServer", "planner_server"),
    ("nav2_behaviors", "behavior_server", "behavior_server::BehaviorServer", "behavior_server"),
    ("nav2_bt_navigator", "bt_navigator", "nav2_bt_navigator::BtNavigator", "bt_navigator"),
    (
        "nav2_lifecycle_manager",
        "lifecycle_manager",
        "nav2_lifecycle_manager::LifecycleManager",
        "lifecycle_manager_navigation",
    ),
]


def generate_launch_description():
    default = PathJoinSubstitution([FindPackageShare("nav2_bringup"), "params", "nav2_params.yaml"])
    parameters = LaunchConfiguration("params_file")
    composed = LaunchConfiguration("use_composition")
    processes = [
        Node(package=package, executable=executable, name=name, parameters=[parameters], output="screen")
        for package, executable, _, name in NODES
    ]
    components = [
        ComposableNode(package=package, plugin=plugin, name=name, parameters=[parameters])
        for package, _, plugin, name in NODES
    ]
    return LaunchDescription(
        [
            DeclareLaunchArgument("params_file", default_value=default, description="parameter file"),
            DeclareLaunchArgument("use_composition", default_value="False", description="load into a container"),
            DeclareLaunchArgument("container_name", default_value="nav2_container", description="its name"),
            GroupAction(processes, condition=UnlessCondition(composed)),
            LoadComposableNodes(
                target_container=LaunchConfiguration("container_name"),
                composable_node_descriptions=components,
                condition=IfCondition(composed),
            ),
        ]
    )
