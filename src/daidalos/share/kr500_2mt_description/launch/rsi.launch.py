"""A KUKA KR 500-2 MT on its controller, real or simulated, that a joint_trajectory_controller corrects by RSI."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, Shutdown
from launch.substitutions import Command, FindExecutable, LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    here = FindPackageShare("kr500_2mt_description")
    controllers = PathJoinSubstitution([FindPackageShare("industrial_arm_description"), "config", "controllers.yaml"])
    given = [f"{name}:=" for name in ("client_ip", "client_port", "robot_ip")]
    words = [part for name in given for part in (" ", name, LaunchConfiguration(name[:-2]))]
    model = Command([FindExecutable(name="xacro"), " ", PathJoinSubstitution([here, "urdf", "rsi.urdf.xacro"]), *words])
    return LaunchDescription(
        [
            DeclareLaunchArgument("client_port", default_value="59152", description="port that is listened on"),
            DeclareLaunchArgument(
                "client_ip", default_value="127.0.0.1", description="own address that is listened on"
            ),
            DeclareLaunchArgument("robot_ip", default_value="", description="address of the robot (default: any)"),
            Node(
                package="robot_state_publisher",
                executable="robot_state_publisher",
                parameters=[{"robot_description": ParameterValue(model, value_type=str)}],
                output="screen",
            ),
            Node(
                package="controller_manager",
                executable="ros2_control_node",
                parameters=[controllers],
                output="screen",
                on_exit=[Shutdown()],
            ),
            *(
                Node(package="controller_manager", executable="spawner", arguments=[name], output="screen")
                for name in ("joint_state_broadcaster", "joint_trajectory_controller")
            ),
        ]
    )
