"""A robot with controllers in the simulator: world, state publisher, the robot itself, and its controllers."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription, OpaqueFunction
from launch.substitutions import Command, FindExecutable, LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare


def spawn_controllers(context):
    return [
        Node(package="controller_manager", executable="spawner", arguments=[controller], output="screen")
        for controller in LaunchConfiguration("controllers").perform(context).split()
    ]


def generate_launch_description():
    model = Command([FindExecutable(name="xacro"), " ", LaunchConfiguration("model")])
    return LaunchDescription(
        [
            DeclareLaunchArgument("model", description="the robot's xacro file"),
            DeclareLaunchArgument("name", description="of the robot in the simulation"),
            DeclareLaunchArgument("z", default_value="0", description="height at which it comes in [m]"),
            DeclareLaunchArgument("controllers", description="names of its controllers, with spaces between them"),
            DeclareLaunchArgument("world", description="SDF world to simulate"),
            DeclareLaunchArgument("gui", default_value="true", description="whether to serve the studio"),
            IncludeLaunchDescription(
                PathJoinSubstitution([FindPackageShare("gazebo_ros"), "launch", "gazebo.launch.py"]),
                launch_arguments={"world": LaunchConfiguration("world"), "gui": LaunchConfiguration("gui")}.items(),
            ),
            Node(
                package="robot_state_publisher",
                executable="robot_state_publisher",
                parameters=[{"robot_description": ParameterValue(model, value_type=str), "use_sim_time": True}],
                output="screen",
            ),
            Node(
                package="gazebo_ros",
                executable="spawn_entity.py",
                arguments=[
                    *("-topic", "robot_description", "-entity", LaunchConfiguration("name")),
                    *("-z", LaunchConfiguration("z")),
                ],
                output="screen",
            ),
            OpaqueFunction(function=spawn_controllers),
        ]
    )
