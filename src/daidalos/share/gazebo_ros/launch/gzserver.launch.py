"""The simulator alone."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue


def server(context):
    """Make the node from arguments that are known by now."""

    def is_true(name):
        return LaunchConfiguration(name).perform(context).lower() in ("true", "1")

    world = LaunchConfiguration("world").perform(context)
    arguments = [world] if world and world != "empty.world" else []
    arguments += ["--pause"] if is_true("pause") else []
    arguments += ["--verbose"] if is_true("verbose") else []
    parameters = {
        "seed": ParameterValue(LaunchConfiguration("seed"), value_type=int),
        "contact_monitor": LaunchConfiguration("contact_monitor"),
    }
    speed = LaunchConfiguration("real_time_factor").perform(context)
    if speed:
        parameters["real_time_factor"] = float(speed)
    node = Node(
        package="gazebo_ros",
        executable="gzserver",
        arguments=arguments,
        parameters=[parameters],
        output="screen",
    )
    return [node] if is_true("server") else []


def generate_launch_description():
    # What Gazebo's launch file also takes; the simulator needs none of it.
    accepted = (
        *("gdb", "valgrind", "lockstep", "init", "factory", "force_system", "minimal_comms", "record"),
        *("profile", "iters", "physics", "play", "extra_gazebo_args", "server_required", "gui_required"),
    )
    return LaunchDescription(
        [
            DeclareLaunchArgument("world", default_value="", description="SDF world; an empty one by default"),
            DeclareLaunchArgument("pause", default_value="false", description="begin with time standing still"),
            DeclareLaunchArgument("verbose", default_value="false", description="say more"),
            DeclareLaunchArgument("server", default_value="true", description="whether to start the simulator"),
            DeclareLaunchArgument("seed", default_value="0", description="of all random numbers"),
            DeclareLaunchArgument(
                "real_time_factor", default_value="", description="0: as fast as possible; the world's by default"
            ),
            DeclareLaunchArgument("contact_monitor", default_value="", description="model whose contacts are told"),
            *(
                DeclareLaunchArgument(name, default_value="", description="accepted, without effect")
                for name in accepted
            ),
            OpaqueFunction(function=server, condition=IfCondition(LaunchConfiguration("server"))),
        ]
    )
