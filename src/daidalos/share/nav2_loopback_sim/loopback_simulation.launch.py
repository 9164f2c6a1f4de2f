"""Start the loopback simulator with a parameter file."""

from pathlib import Path

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description() -> LaunchDescription:
    """Return the simulator and its arguments."""
    parameters = Path(get_package_share_directory("nav2_bringup"), "params", "nav2_params.yaml")
    simulator = Node(
        package="nav2_loopback_sim",
        executable="loopback_simulator",
        name="loopback_simulator",
        output="screen",
        parameters=[LaunchConfiguration("params_file"), {"scan_frame_id": LaunchConfiguration("scan_frame_id")}],
    )
    return LaunchDescription(
        [
            DeclareLaunchArgument("params_file", default_value=str(parameters), description="Parameter file."),
            DeclareLaunchArgument("scan_frame_id", default_value="base_scan", description="Frame of the scans."),
            simulator,
        ]
    )
