"""`remove`: removes an entity from the running simulation, with gz's options."""

from __future__ import annotations

import argparse
from dataclasses import dataclass

from daidalos.common.parameters import Parameters, parameter
from daidalos.nodes.parameters import declare, warn_of_undeclared
from daidalos.nodes.ros_gz_sim.create import find_service
from daidalos.nodes.runner import UserError, program_arguments, run_program


@dataclass(frozen=True)
class RemoveParameters(Parameters):
    """Parameters of ``remove``, for what its options leave out."""

    entity_name: str = parameter("", "Entity to remove.")
    world: str = parameter("", "World with the entity; the only one where empty.")


def _remove(world: str, name: str) -> None:
    import rclpy
    from ros_gz_interfaces.msg import Entity
    from ros_gz_interfaces.srv import DeleteEntity

    rclpy.init()
    node = rclpy.create_node("entity_remover")
    settings = declare(node, RemoveParameters)
    warn_of_undeclared(node)
    name, world = name or settings.entity_name, world or settings.world
    if not name:
        raise UserError("say what to remove: -name, or the parameter entity_name")
    service = find_service(node, world, "remove", "ros_gz_interfaces/srv/DeleteEntity")
    request = DeleteEntity.Request(entity=Entity(name=name, type=Entity.MODEL))
    response = node.create_client(DeleteEntity, service).call(request, 30.0)
    if response is None or not response.success:
        raise UserError(f"the entity '{name}' was not removed; the simulator says why")
    node.get_logger().info("Entity removal successful.")
    node.destroy_node()


def main() -> int:
    """Run the program."""
    parser = argparse.ArgumentParser(prog="remove", description="Take an entity out of the simulation.")
    parser.add_argument("-world", "--world", default="", help="that it is in")
    parser.add_argument("-name", "--name", default="", help="of the entity")
    arguments = parser.parse_args(program_arguments())
    return run_program(lambda: _remove(arguments.world, arguments.name), interrupted=130)
