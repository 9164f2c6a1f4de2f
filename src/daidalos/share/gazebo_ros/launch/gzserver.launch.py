"""The simulator alone."""

import shlex

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction, Shutdown
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue

from daidalos.nodes.packages import model_path_with_exports

SWITCHES = {
    "version": "say which one this is, and end",
    "verbose": "say more",
    "lockstep": "accepted, without effect",
    "help": "say what the server takes, and end",
    "pause": "begin with time standing still",
    "record": "accepted, without effect",
    "minimal_comms": "accepted, without effect",
}
VALUES = {
    "seed": "of all random numbers",
    "iters": "end after so many steps",
    "physics": "accepted, without effect",
    "play": "accepted, without effect",
    "record_encoding": "accepted, without effect",
    "record_path": "accepted, without effect",
    "record_period": "accepted, without effect",
    "record_filter": "accepted, without effect",
    "profile": "accepted, without effect",
}
OTHERS = {
    "world": ("", "an SDF world; an empty one by default"),
    "params_file": ("", "YAML file with parameters of the node gazebo"),
    "extra_gazebo_args": ("", "more arguments of the server"),
    "server": ("true", "whether to start the simulator"),
    "server_required": ("false", "whether everything ends with the simulator"),
    "real_time_factor": ("", "0: as fast as possible; the world's by default"),
    "contact_monitor": ("", "model whose contacts are told"),
    **dict.fromkeys(("gdb", "valgrind"), ("false", "accepted, without effect")),
    **dict.fromkeys(("init", "factory", "force_system"), ("true", "accepted: always there")),
}


def server(context):
    """Make the node from arguments that are known by now."""

    def value(name):
        return LaunchConfiguration(name).perform(context)

    def is_true(name):
        return value(name).lower() in ("true", "1")

    arguments = [value("world")] if value("world") else []
    arguments += [f"--{name}" for name in SWITCHES if is_true(name)]
    arguments += [word for name in VALUES if value(name) for word in (f"--{name}", value(name))]
    # The same as a node takes them: "--ros-args --params-file FILE" is common.
    arguments += shlex.split(value("extra_gazebo_args"))
    parameters = [value("params_file")] if value("params_file") else []
    if value("contact_monitor"):
        parameters.append({"contact_monitor": LaunchConfiguration("contact_monitor")})
    if value("real_time_factor"):
        speed = ParameterValue(LaunchConfiguration("real_time_factor"), value_type=float)
        parameters.append({"real_time_factor": speed})
    node = Node(
        package="gazebo_ros",
        executable="gzserver",
        arguments=arguments,
        parameters=parameters,
        output="screen",
        additional_env=model_path_with_exports(context.environment),
        on_exit=[Shutdown()] if is_true("server_required") else [],
    )
    return [node] if is_true("server") else []


def generate_launch_description():
    return LaunchDescription(
        [
            *(
                DeclareLaunchArgument(name, default_value=value, description=text)
                for name, (value, text) in OTHERS.items()
            ),
            *(DeclareLaunchArgument(name, default_value="false", description=text) for name, text in SWITCHES.items()),
            *(DeclareLaunchArgument(name, default_value="", description=text) for name, text in VALUES.items()),
            OpaqueFunction(function=server),
        ]
    )
