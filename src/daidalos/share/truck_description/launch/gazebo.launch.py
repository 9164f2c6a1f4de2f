"""The truck in its yard; run `diff_drive_publisher` to see it drive an arc."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.substitutions import Command, FindExecutable, LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    here = FindPackageShare("truck_description")
    model = PathJoinSubstitution([here, "urdf", "truck.urdf.xacro"])
    description = ParameterValue(Command([FindExecutable(name="xacro"), " ", model]), value_type=str)
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                "world",
                default_value=PathJoinSubstitution([here, "worlds", "walled.world"]),
                description="SDF world to simulate",
            ),
            DeclareLaunchArgument("gui", default_value="true", description="whether to serve the studio"),
            IncludeLaunchDescription(
                PathJoinSubstitution([FindPackageShare("gazebo_ros"), "launch", "gazebo.launch.py"]),
                launch_arguments={"world": LaunchConfiguration("world"), "gui": LaunchConfiguration("gui")}.items(),
            ),
            Node(
                package="robot_state_publisher",
                executable="robot_state_publisher",
                parameters=[{"robot_description": description, "use_sim_time": True}],
                output="screen",
            ),
            Node(
                package="gazebo_ros",
                executable="spawn_entity.py",
                arguments=["-topic", "robot_description", "-entity", "truck", "-z", "0.45"],
                output="screen",
            ),
            *(
                Node(package="controller_manager", executable="spawner", arguments=[controller], output="screen")
                for controller in (
                    "joint_state_broadcaster",
                    "diff_drive_base_controller",
                    "joint_trajectory_controller",
                )
            ),
        ]
    )
