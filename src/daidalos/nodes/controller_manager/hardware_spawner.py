"""`hardware_spawner`: configures or activates hardware."""

from __future__ import annotations

import argparse

from daidalos.nodes.controller_manager._client import ManagerClient, add_manager_arguments
from daidalos.nodes.runner import UserError, program_arguments, run_program


def main() -> int:
    """Run the program."""
    parser = argparse.ArgumentParser(prog="hardware_spawner", description="Configure or activate hardware.")
    parser.add_argument("hardware_component_names", nargs="+", metavar="hardware", help="names of the hardware")
    wanted = parser.add_mutually_exclusive_group(required=True)
    wanted.add_argument("--activate", action="store_true", help="make it active")
    wanted.add_argument("--configure", action="store_true", help="make it inactive: configured, but without power")
    add_manager_arguments(parser)
    arguments = parser.parse_args(program_arguments())

    def body() -> None:
        import rclpy
        from controller_manager_msgs.srv import SetHardwareComponentState
        from lifecycle_msgs.msg import State

        rclpy.init()
        node = rclpy.create_node("hardware_spawner")
        manager = ManagerClient(node, arguments)
        state = (
            State(id=State.PRIMARY_STATE_ACTIVE, label="active")
            if arguments.activate
            else State(id=State.PRIMARY_STATE_INACTIVE, label="inactive")
        )
        for name in arguments.hardware_component_names:
            service = "set_hardware_component_state"
            if not manager.ask(SetHardwareComponentState, service, name=name, target_state=state).ok:
                raise UserError(f"hardware '{name}' did not become {state.label}; see the controller manager's log")
            node.get_logger().info(f"hardware '{name}' is {state.label}")
        node.destroy_node()

    return run_program(body, interrupted=130)
