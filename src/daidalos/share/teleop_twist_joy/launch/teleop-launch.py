"""A game pad, and the node that drives with it."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    config = PathJoinSubstitution(
        [FindPackageShare("teleop_twist_joy"), "config", [LaunchConfiguration("joy_config"), ".config.yaml"]]
    )
    stamped = ParameterValue(LaunchConfiguration("publish_stamped_twist"), value_type=bool)
    device = ParameterValue(LaunchConfiguration("joy_dev"), value_type=int)
    return LaunchDescription(
        [
            DeclareLaunchArgument("joy_vel", default_value="cmd_vel", description="topic of the velocities"),
            DeclareLaunchArgument("joy_config", default_value="ps3", description="kind of the game pad: ps3, xbox ..."),
            DeclareLaunchArgument("joy_dev", default_value="0", description="which of the game pads, from 0"),
            DeclareLaunchArgument(
                "publish_stamped_twist", default_value="false", description="whether to publish TwistStamped"
            ),
            DeclareLaunchArgument("config_filepath", default_value=config, description="parameter file"),
            Node(
                package="joy",
                executable="joy_node",
                name="joy_node",
                parameters=[{"device_id": device, "deadzone": 0.3, "autorepeat_rate": 20.0}],
            ),
            Node(
                package="teleop_twist_joy",
                executable="teleop_node",
                name="teleop_twist_joy_node",
                parameters=[LaunchConfiguration("config_filepath"), {"publish_stamped_twist": stamped}],
                remappings=[("/cmd_vel", LaunchConfiguration("joy_vel"))],
            ),
        ]
    )
