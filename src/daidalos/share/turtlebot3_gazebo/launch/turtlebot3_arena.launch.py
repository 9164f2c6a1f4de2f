"""A TurtleBot3 in the arena."""

from pathlib import Path

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition, UnlessCondition
from launch.substitutions import Command, FindExecutable, LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import LoadComposableNodes, Node
from launch_ros.descriptions import ComposableNode
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    arena = Path(get_package_share_directory("turtlebot3_gazebo")) / "worlds" / "arena.world"
    model = PathJoinSubstitution([FindPackageShare("turtlebot3_description"), "urdf", LaunchConfiguration("urdf")])
    description = Command([FindExecutable(name="xacro"), " ", model])
    simulator = {
        "seed": ParameterValue(LaunchConfiguration("seed"), value_type=int),
        "contact_monitor": ParameterValue(LaunchConfiguration("name"), value_type=str),
    }
    robot = {"robot_description": ParameterValue(description, value_type=str), "use_sim_time": True}
    composed = LaunchConfiguration("use_composition")
    return LaunchDescription(
        [
            DeclareLaunchArgument("world", default_value=str(arena), description="SDF world to simulate"),
            DeclareLaunchArgument("urdf", default_value="turtlebot3_waffle.urdf.xacro", description="robot to spawn"),
            DeclareLaunchArgument("name", default_value="waffle", description="name of the robot"),
            DeclareLaunchArgument("x_pose", default_value="0.0", description="where it stands [m]"),
            DeclareLaunchArgument("y_pose", default_value="0.0", description="where it stands [m]"),
            DeclareLaunchArgument("yaw", default_value="0.0", description="where it looks [rad]"),
            DeclareLaunchArgument("seed", default_value="0", description="of all random numbers"),
            DeclareLaunchArgument("use_composition", default_value="False", description="whether to load the nodes"),
            DeclareLaunchArgument("container_name", default_value="", description="container that loads them"),
            Node(
                package="gazebo_ros",
                executable="gzserver",
                arguments=[LaunchConfiguration("world")],
                parameters=[simulator],
                condition=UnlessCondition(composed),
                output="screen",
            ),
            Node(
                package="robot_state_publisher",
                executable="robot_state_publisher",
                parameters=[robot],
                condition=UnlessCondition(composed),
                output="screen",
            ),
            LoadComposableNodes(
                target_container=LaunchConfiguration("container_name"),
                composable_node_descriptions=[
                    ComposableNode(
                        package="ros_gz_sim",
                        plugin="ros_gz_sim::GzServer",
                        name="gazebo",
                        parameters=[{"world_sdf_file": LaunchConfiguration("world")}, simulator],
                    ),
                    ComposableNode(
                        package="robot_state_publisher",
                        plugin="robot_state_publisher::RobotStatePublisher",
                        name="robot_state_publisher",
                        parameters=[robot],
                    ),
                ],
                condition=IfCondition(composed),
            ),
            Node(
                package="gazebo_ros",
                executable="spawn_entity.py",
                arguments=[
                    *("-topic", "robot_description", "-entity", LaunchConfiguration("name"), "-z", "0.01"),
                    *("-x", LaunchConfiguration("x_pose"), "-y", LaunchConfiguration("y_pose")),
                    *("-Y", LaunchConfiguration("yaw")),
                ],
                output="screen",
            ),
        ]
    )
