"""`spawner`: loads, configures and starts controllers."""

from __future__ import annotations

import argparse
import sys
from itertools import pairwise
from pathlib import Path
from typing import Any

from rclpy.impl.arguments import split_ros_args

from daidalos.nodes.controller_manager._client import ManagerClient, add_manager_arguments
from daidalos.nodes.runner import UserError, run_program


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="spawner", description="Load, configure and start controllers.")
    parser.add_argument("controller_names", nargs="+", metavar="controller", help="names of the controllers")
    add_manager_arguments(parser)
    parser.add_argument(
        "-p",
        "--param-file",
        action="append",
        default=[],
        metavar="FILE",
        help="a file with the controllers' parameters; it may be given several times",
    )
    parser.add_argument("-t", "--controller-type", default="", help="their type, where no parameter says it")
    parser.add_argument("-n", "--namespace", default="", help="namespace of the controller manager")
    parser.add_argument("--load-only", action="store_true", help="only load them")
    parser.add_argument("--inactive", "--stopped", action="store_true", help="load and configure, but do not start")
    parser.add_argument("--activate-as-group", action="store_true", help="start all of them at once: for chains")
    parser.add_argument("--switch-asap", action=argparse.BooleanOptionalAction, default=True, help=argparse.SUPPRESS)
    parser.add_argument(
        "--controller-ros-args",
        action="append",
        default=[],
        metavar="ARGS",
        help="ROS arguments for the controllers' nodes; it may be given several times",
    )
    parser.add_argument(
        "-u", "--unload-on-kill", action="store_true", help="wait for Ctrl-C, then stop and unload them"
    )
    words, rest = split_ros_args(sys.argv[1:])
    arguments = parser.parse_args(rest)
    # What a launch file gives the spawner as parameters is meant for the controllers.
    arguments.param_file += [file for flag, file in pairwise(words) if flag == "--params-file"]
    return arguments


def _type_in(files: list[str], name: str, namespace: str) -> str:
    """Return the type that parameter files give a controller, by its name with its namespace or without."""
    import yaml
    from rclpy.parameter import parameter_dict_from_yaml_file

    found = ""
    for file in files:
        for full in dict.fromkeys((f"/{name}", f"{namespace.rstrip('/')}/{name}")):
            try:
                values = parameter_dict_from_yaml_file(file, use_wildcard=True, target_nodes=[full])
            except (OSError, ValueError, yaml.YAMLError) as error:
                raise UserError(f"parameter file '{file}' cannot be read: {error}") from None
            except RuntimeError as error:
                if "does not contain" in str(error):
                    continue
                raise UserError(str(error)) from None
            if "type" in values:
                found = values["type"].value.string_value
    return found


def _load(manager: ManagerClient, arguments: argparse.Namespace, name: str, namespace: str) -> None:
    from controller_manager_msgs.srv import LoadController

    files = [str(Path(file).resolve()) for file in arguments.param_file]
    missing = next((file for file in files if not Path(file).is_file()), None)
    if missing is not None:
        raise UserError(f"there is no parameter file '{missing}'")
    type_name = arguments.controller_type or _type_in(files, name, namespace)
    if type_name:
        manager.set_parameter(f"{name}.type", type_name)
    if files:
        manager.set_parameter(f"{name}.params_file", files)
    if arguments.controller_ros_args:
        words = [word for given in arguments.controller_ros_args for word in given.split()]
        manager.set_parameter(f"{name}.node_options_args", [word for word in words if word != "--ros-args"])
    if not manager.ask(LoadController, "load_controller", name=name).ok:
        raise UserError(f"loading controller '{name}' failed; see the controller manager's log")


def _prepare(manager: ManagerClient, arguments: argparse.Namespace, node: Any, name: str) -> str:
    """Load and configure a controller as far as is wanted; return its state."""
    from controller_manager_msgs.srv import ConfigureController

    log = node.get_logger()
    known = manager.controllers()
    if name in known:
        log.warning(f"controller '{name}' is loaded already")
    else:
        _load(manager, arguments, name, manager.name.rpartition("/")[0])
        log.info(f"Loaded {name}")
    state = known[name].state if name in known else "unconfigured"
    if arguments.load_only or state == "active":
        return state
    if state == "unconfigured":
        if not manager.ask(ConfigureController, "configure_controller", name=name).ok:
            raise UserError(f"configuring controller '{name}' failed; see the controller manager's log")
        log.info(f"Configured {name}")
    return "inactive"


def _start(manager: ManagerClient, arguments: argparse.Namespace, node: Any, names: list[str]) -> None:
    for group in [names] if arguments.activate_as_group else [[name] for name in names]:
        if not group:
            continue
        problem = manager.switch(start=group, asap=arguments.switch_asap)
        if problem:
            raise UserError(f"starting {', '.join(group)} failed: {problem}")
        node.get_logger().info(f"Configured and activated {', '.join(group)}")


def _spawn(arguments: argparse.Namespace, node: Any) -> ManagerClient:
    names = list(dict.fromkeys(arguments.controller_names))
    if arguments.namespace:
        arguments.controller_manager = f"/{arguments.namespace.strip('/')}/{arguments.controller_manager}"
    manager = ManagerClient(node, arguments)
    waiting: list[str] = []
    for name in names:
        ready = _prepare(manager, arguments, node, name) == "inactive"
        if ready and not (arguments.load_only or arguments.inactive):
            waiting.append(name)
            if not arguments.activate_as_group:
                _start(manager, arguments, node, [waiting.pop()])
    _start(manager, arguments, node, waiting)
    return manager


def _unload_at_end(arguments: argparse.Namespace, node: Any) -> None:
    """Wait until the process is asked to end, then stop and unload the controllers."""
    import rclpy
    from rclpy.executors import ExternalShutdownException

    from daidalos.nodes.controller_manager.unspawner import unspawn

    node.get_logger().info("Waiting until interrupt to unload controllers")
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        # The context has been shut down: the last calls go out with one of their own.
        context = rclpy.Context()
        rclpy.init(context=context)
        helper = rclpy.create_node("spawner", context=context)
        unspawn(ManagerClient(helper, arguments), arguments.controller_names, helper)
        helper.destroy_node()
        rclpy.shutdown(context=context)


def main() -> int:
    """Run the program."""
    arguments = _arguments()

    def body() -> None:
        import rclpy

        rclpy.init()
        node = rclpy.create_node(f"spawner_{arguments.controller_names[0]}")
        _spawn(arguments, node)
        if arguments.unload_on_kill:
            _unload_at_end(arguments, node)
        node.destroy_node()

    return run_program(body, interrupted=130)
