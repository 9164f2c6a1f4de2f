"""An arm on an ABB controller, real or simulated, that a joint_trajectory_controller guides by EGM."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, Shutdown
from launch.substitutions import Command, FindExecutable, LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    here = FindPackageShare("industrial_arm_description")
    given = [f"{name}:=" for name in ("robot", "egm_port", "listen", "rws_ip")]
    words = [part for name in given for part in (" ", name, LaunchConfiguration(name[:-2]))]
    model = Command([FindExecutable(name="xacro"), " ", PathJoinSubstitution([here, "urdf", "egm.urdf.xacro"]), *words])
    return LaunchDescription(
        [
            DeclareLaunchArgument("robot", default_value="irb120", description="arm, such as irb120"),
            DeclareLaunchArgument("egm_port", default_value="6510", description="port that is listened on"),
            DeclareLaunchArgument("listen", default_value="127.0.0.1", description="own address that is listened on"),
            DeclareLaunchArgument("rws_ip", default_value="", description="address of the controller (default: any)"),
            Node(
                package="robot_state_publisher",
                executable="robot_state_publisher",
                parameters=[{"robot_description": ParameterValue(model, value_type=str)}],
                output="screen",
            ),
            Node(
                package="controller_manager",
                executable="ros2_control_node",
                parameters=[PathJoinSubstitution([here, "config", "controllers.yaml"])],
                output="screen",
                on_exit=[Shutdown()],
            ),
            *(
                Node(package="controller_manager", executable="spawner", arguments=[name], output="screen")
                for name in ("joint_state_broadcaster", "joint_trajectory_controller")
            ),
        ]
    )
