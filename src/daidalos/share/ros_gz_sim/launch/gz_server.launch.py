"""The simulator alone, running at once: as a process, in a container of its own, or in one that runs."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition
from launch.substitutions import AndSubstitution, LaunchConfiguration, NotSubstitution
from launch_ros.actions import ComposableNodeContainer, LoadComposableNodes, Node
from launch_ros.descriptions import ComposableNode
from launch_ros.parameter_descriptions import ParameterValue

ARGUMENTS = [
    ("world_sdf_file", "", "SDF world"),
    ("world_sdf_string", "", "the world itself"),
    ("container_name", "ros_gz_container", "container that loads the simulator"),
    ("create_own_container", "False", "whether to start that container"),
    ("use_composition", "False", "whether to load the simulator into a container"),
]


def generate_launch_description():
    value = LaunchConfiguration
    composed, own = value("use_composition"), value("create_own_container")
    world = {name: ParameterValue(value(name), value_type=str) for name in ("world_sdf_file", "world_sdf_string")}
    nodes = [ComposableNode(package="ros_gz_sim", plugin="ros_gz_sim::GzServer", name="gz_server", parameters=[world])]
    return LaunchDescription(
        [
            *(DeclareLaunchArgument(name, default_value=text, description=what) for name, text, what in ARGUMENTS),
            Node(
                package="ros_gz_sim",
                executable="gzserver",
                parameters=[world],
                condition=IfCondition(NotSubstitution(composed)),
                output="screen",
            ),
            ComposableNodeContainer(
                name=value("container_name"),
                namespace="",
                package="rclcpp_components",
                executable="component_container",
                composable_node_descriptions=nodes,
                condition=IfCondition(AndSubstitution(composed, own)),
                output="screen",
            ),
            LoadComposableNodes(
                target_container=value("container_name"),
                composable_node_descriptions=nodes,
                condition=IfCondition(AndSubstitution(composed, NotSubstitution(own))),
            ),
        ]
    )
