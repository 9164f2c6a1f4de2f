"""A simulated moving head whose axes a controller of ros2_control drives, from its trajectories to Art-Net.

The controller manager sends Art-Net; `simulated_head` receives it, as a real head would. The node `moving_head` makes
trajectories of points and frames; whoever sends the action `head_controller/follow_joint_trajectory` drives it as well.
"""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, Shutdown
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare


def share(*parts):
    return PathJoinSubstitution([FindPackageShare("daidalos_lighting"), *parts])


def generate_launch_description():
    urdf = share("urdf", "moving_head.urdf")
    studio = {"port": ParameterValue(LaunchConfiguration("port"), value_type=int)}
    return LaunchDescription(
        [
            DeclareLaunchArgument("studio", default_value="true", description="whether to serve the studio"),
            DeclareLaunchArgument("port", default_value="8765", description="of the studio"),
            Node(
                package="gazebo_ros",
                executable="gzserver",
                arguments=[share("worlds", "cell.world")],
                output="screen",
                on_exit=[Shutdown()],
            ),
            Node(package="gazebo_ros", executable="spawn_entity.py", arguments=["-file", urdf, "-entity", "head"]),
            Node(package="robot_state_publisher", executable="robot_state_publisher", arguments=[urdf]),
            Node(
                package="controller_manager",
                executable="ros2_control_node",
                parameters=[share("config", "controllers.yaml")],
                output="screen",
            ),
            Node(package="controller_manager", executable="spawner", arguments=["head_controller"], output="screen"),
            Node(
                package="daidalos_lighting",
                executable="moving_head",
                parameters=[{"controller": "head_controller"}],
                remappings=[("joint_states", "aimed_joint_states"), ("point", "clicked_point")],
                output="screen",
            ),
            Node(package="daidalos_lighting", executable="simulated_head", output="screen", on_exit=[Shutdown()]),
            Node(package="daidalos_lighting", executable="cell_view", output="screen"),
            Node(
                package="foxglove_bridge",
                executable="foxglove_bridge",
                parameters=[studio],
                condition=IfCondition(LaunchConfiguration("studio")),
                output="screen",
            ),
        ]
    )
