"""`unspawner`: stops and unloads controllers."""

from __future__ import annotations

import argparse
from collections.abc import Iterable
from typing import Any

from daidalos.nodes.controller_manager._client import ManagerClient, add_manager_arguments
from daidalos.nodes.runner import UserError, program_arguments, run_program


def unspawn(manager: ManagerClient, names: Iterable[str], node: Any) -> None:
    """Stop controllers, all at once, and unload them.

    Raises
    ------
    UserError
        When that cannot be done.
    """
    from controller_manager_msgs.srv import UnloadController

    names = list(dict.fromkeys(names))
    known = manager.controllers()
    missing = [name for name in names if name not in known]
    if missing:
        there = ", ".join(known) or "none"
        raise UserError(f"not loaded: {', '.join(missing)}; there are: {there}")
    active = [name for name in names if known[name].state == "active"]
    problem = manager.switch(stop=active) if active else ""
    if problem:
        raise UserError(f"stopping {', '.join(active)} failed: {problem}")
    for name in names:
        if not manager.ask(UnloadController, "unload_controller", name=name).ok:
            raise UserError(f"unloading controller '{name}' failed; see the controller manager's log")
        node.get_logger().info(f"Unloaded {name}")


def main() -> int:
    """Run the program."""
    parser = argparse.ArgumentParser(prog="unspawner", description="Stop and unload controllers.")
    parser.add_argument("controller_names", nargs="+", metavar="controller", help="names of the controllers")
    add_manager_arguments(parser)
    arguments = parser.parse_args(program_arguments())

    def body() -> None:
        import rclpy

        rclpy.init()
        node = rclpy.create_node(f"unspawner_{arguments.controller_names[0]}")
        unspawn(ManagerClient(node, arguments), arguments.controller_names, node)
        node.destroy_node()

    return run_program(body, interrupted=130)
