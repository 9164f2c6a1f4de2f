"""Two EKFs and a receiver of satellite positions: one filter for the frame odom, one for the frame map."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare

PARAMETERS = "dual_ekf_navsat_example.yaml"


def generate_launch_description():
    parameters = PathJoinSubstitution([FindPackageShare("robot_localization"), "params", PARAMETERS])

    def node(executable, name, remappings):
        return Node(
            package="robot_localization",
            executable=executable,
            name=name,
            output="screen",
            parameters=[LaunchConfiguration("params_file"), {"use_sim_time": LaunchConfiguration("use_sim_time")}],
            remappings=remappings,
        )

    return LaunchDescription(
        [
            DeclareLaunchArgument("params_file", default_value=parameters, description="parameter file"),
            DeclareLaunchArgument("use_sim_time", default_value="false", description="whether time is simulated"),
            node("ekf_node", "ekf_filter_node_odom", [("odometry/filtered", "odometry/local")]),
            node("ekf_node", "ekf_filter_node_map", [("odometry/filtered", "odometry/global")]),
            node(
                "navsat_transform_node",
                "navsat_transform",
                [("imu", "imu/data"), ("odometry/filtered", "odometry/global")],
            ),
        ]
    )
