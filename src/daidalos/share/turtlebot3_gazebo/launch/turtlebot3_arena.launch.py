"""A TurtleBot3 in the arena."""

from pathlib import Path

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import Command, FindExecutable, LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    arena = Path(get_package_share_directory("turtlebot3_gazebo")) / "worlds" / "arena.world"
    model = PathJoinSubstitution([FindPackageShare("turtlebot3_description"), "urdf", LaunchConfiguration("urdf")])
    description = Command([FindExecutable(name="xacro"), " ", model])
    return LaunchDescription(
        [
            DeclareLaunchArgument("world", default_value=str(arena), description="SDF world to simulate"),
            DeclareLaunchArgument("urdf", default_value="turtlebot3_waffle.urdf.xacro", description="robot to spawn"),
            DeclareLaunchArgument("name", default_value="waffle", description="name of the robot"),
            DeclareLaunchArgument("x_pose", default_value="0.0", description="where it stands [m]"),
            DeclareLaunchArgument("y_pose", default_value="0.0", description="where it stands [m]"),
            DeclareLaunchArgument("yaw", default_value="0.0", description="where it looks [rad]"),
            DeclareLaunchArgument("seed", default_value="0", description="of all random numbers"),
            Node(
                package="gazebo_ros",
                executable="gzserver",
                arguments=[LaunchConfiguration("world")],
                parameters=[
                    {
                        "seed": ParameterValue(LaunchConfiguration("seed"), value_type=int),
                        "contact_monitor": LaunchConfiguration("name"),
                    }
                ],
                output="screen",
            ),
            Node(
                package="robot_state_publisher",
                executable="robot_state_publisher",
                parameters=[{"robot_description": ParameterValue(description, value_type=str), "use_sim_time": True}],
                output="screen",
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
