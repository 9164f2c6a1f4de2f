"""RViz with the displays of navigation."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, EmitEvent, RegisterEventHandler
from launch.event_handlers import OnProcessExit
from launch.events import Shutdown
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    view = PathJoinSubstitution([FindPackageShare("nav2_bringup"), "rviz", "nav2_default_view.rviz"])
    rviz = Node(
        package="rviz2",
        executable="rviz2",
        namespace=LaunchConfiguration("namespace"),
        arguments=["-d", LaunchConfiguration("rviz_config")],
        parameters=[{"use_sim_time": LaunchConfiguration("use_sim_time")}],
        remappings=[("/tf", "tf"), ("/tf_static", "tf_static")],
        output="screen",
    )
    ended = EmitEvent(event=Shutdown(reason="rviz exited"))
    return LaunchDescription(
        [
            DeclareLaunchArgument("namespace", default_value="", description="namespace of what is shown"),
            DeclareLaunchArgument("rviz_config", default_value=view, description="file with the displays"),
            DeclareLaunchArgument("use_sim_time", default_value="false", description="whether the clock is simulated"),
            rviz,
            RegisterEventHandler(OnProcessExit(target_action=rviz, on_exit=ended)),
        ]
    )
