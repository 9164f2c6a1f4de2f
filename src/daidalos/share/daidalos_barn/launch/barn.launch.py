"""A Jackal at the start of a BARN world, with odometry of its wheels and gyroscope, and navigation without a map."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.substitutions import Command, LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare

START = ("-x", "-2.0", "-y", "3.0", "-Y", "1.5707963")


def generate_launch_description():
    here = FindPackageShare("daidalos_barn")
    value = LaunchConfiguration
    parameters = value("params_file")
    clock = {"use_sim_time": True}
    description = Command(["xacro ", PathJoinSubstitution([here, "urdf", "jackal.urdf.xacro"])])
    return LaunchDescription(
        [
            DeclareLaunchArgument("world", description="SDF world, such as `daidalos bench barn` keeps of a failure"),
            DeclareLaunchArgument("seed", default_value="0", description="of all random numbers"),
            DeclareLaunchArgument(
                "params_file",
                default_value=PathJoinSubstitution([here, "config", "nav2_params.yaml"]),
                description="parameter file",
            ),
            Node(
                package="gazebo_ros",
                executable="gzserver",
                arguments=[value("world")],
                parameters=[{"seed": ParameterValue(value("seed"), value_type=int)}],
                output="screen",
            ),
            Node(
                package="robot_state_publisher",
                executable="robot_state_publisher",
                parameters=[clock, {"robot_description": ParameterValue(description, value_type=str)}],
                output="screen",
            ),
            Node(
                package="gazebo_ros",
                executable="spawn_entity.py",
                arguments=["-topic", "robot_description", "-entity", "jackal", "-z", "0.01", *START],
                output="screen",
            ),
            Node(
                package="robot_localization",
                executable="ekf_node",
                name="ekf_filter_node",
                parameters=[parameters, clock],
                remappings=[("odometry/filtered", "odom")],
                output="screen",
            ),
            IncludeLaunchDescription(
                PathJoinSubstitution([FindPackageShare("nav2_bringup"), "launch", "navigation_launch.py"]),
                launch_arguments={"params_file": parameters, "use_sim_time": "true"}.items(),
            ),
        ]
    )
