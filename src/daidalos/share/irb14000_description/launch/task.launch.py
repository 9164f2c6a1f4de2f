"""The two-armed robot ABB IRB 14000 YuMi in the simulator, with an object, and a program that handles it."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, EmitEvent, IncludeLaunchDescription, RegisterEventHandler
from launch.event_handlers import OnProcessExit
from launch.events import Shutdown
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    here = FindPackageShare("irb14000_description")
    task = Node(
        package="irb14000_description",
        executable=LaunchConfiguration("task"),
        parameters=[{"use_sim_time": True}],
        output="screen",
    )
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                "task",
                default_value="hand_over",
                choices=["hand_over", "carry_together"],
                description="what the arms do",
            ),
            DeclareLaunchArgument("gui", default_value="true", description="whether to serve the studio"),
            IncludeLaunchDescription(
                PathJoinSubstitution([here, "launch", "bringup.launch.py"]),
                launch_arguments={
                    "world": PathJoinSubstitution([here, "worlds", [LaunchConfiguration("task"), ".world"]]),
                    "gui": LaunchConfiguration("gui"),
                }.items(),
            ),
            task,
            RegisterEventHandler(
                OnProcessExit(target_action=task, on_exit=[EmitEvent(event=Shutdown(reason="the task has ended"))])
            ),
        ]
    )
