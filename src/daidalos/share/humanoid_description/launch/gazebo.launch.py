"""The humanoid in the simulator, its elbows under control; run `joint_publisher` to see it curl its arms."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.substitutions import Command, FindExecutable, LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    here = FindPackageShare("humanoid_description")
    model = PathJoinSubstitution([here, "urdf", "humanoid.urdf.xacro"])
    description = ParameterValue(Command([FindExecutable(name="xacro"), " ", model]), value_type=str)
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                "world",
                default_value=PathJoinSubstitution([here, "worlds", "ball.world"]),
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
                arguments=["-topic", "robot_description", "-entity", "humanoid", "-z", "0"],
                output="screen",
            ),
            *(
                Node(package="controller_manager", executable="spawner", arguments=[controller], output="screen")
                for controller in ("joint_state_broadcaster", "joint_trajectory_controller")
            ),
        ]
    )
