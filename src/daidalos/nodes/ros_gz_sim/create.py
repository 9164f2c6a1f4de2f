"""`create`: adds a robot or model to the running simulation, with gz's options."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from daidalos.common.parameters import Parameters, parameter, values_of
from daidalos.nodes.gazebo_ros._command_line import bind_numbers
from daidalos.nodes.parameters import declare, declare_given
from daidalos.nodes.runner import UserError, program_arguments, run_program
from daidalos.nodes.waiting import answer, wait_in_launch

_TIMEOUT = 30.0
_NUMBERS = ("x", "y", "z", "R", "P", "Y")
_TEXTS = ("world", "file", "topic", "param", "string", "name")


def _pose(what: str, unit: str) -> Any:
    return parameter(0.0, f"Of the entity's pose: {what}.", unit=unit, takes_integer=True)


@dataclass(frozen=True)
class CreateParameters(Parameters):
    """Parameters of ``create``, for what its options leave out."""

    world: str = parameter("", "World to spawn in; the only one where empty.")
    file: str = parameter("", "File or model with the description.")
    topic: str = parameter("", "Topic with the description.")
    param: str = parameter("", "Parameter of the node with the description.")
    string: str = parameter("", "The description itself.")
    name: str = parameter("", "Name of the entity; that of the description where empty.")
    x: float = _pose("x", "m")
    y: float = _pose("y", "m")
    z: float = _pose("z", "m")
    R: float = _pose("roll", "rad")
    P: float = _pose("pitch", "rad")
    Y: float = _pose("yaw", "rad")
    allow_renaming: bool = parameter(False, "Whether to choose another name where it is taken.")


def parse(words: Sequence[str]) -> argparse.Namespace:
    """Read the command line; one dash or two, a value after a space or an equals sign.

    As in ROS, what is not known is left out; and what is not given is None, for parameters to say.
    """
    parser = argparse.ArgumentParser(
        prog="create", description="Spawn an entity in the simulation.", allow_abbrev=False
    )
    source = "the description: a file, a topic, a parameter of this node, or the text itself"
    for name in _TEXTS:
        text = {"world": "the world to spawn in", "name": "of the entity"}.get(name, source)
        parser.add_argument(f"-{name}", f"--{name}", help=text)
    for name in _NUMBERS:
        parser.add_argument(f"-{name}", f"--{name}", type=float, help="pose [m, rad]")
    parser.add_argument(
        "-allow_renaming", "--allow_renaming", nargs="?", const=True, type=_is_true, help="choose another name if taken"
    )
    arguments, unknown = parser.parse_known_args(bind_numbers(words))
    if unknown:
        print(f"warning: create does not know {' '.join(unknown)}, left out", file=sys.stderr)
    return arguments


def take_parameters(arguments: argparse.Namespace, node: Any) -> None:
    """Fill in what the command line does not say from the node's parameters of the same names, or the default."""
    for name, value in values_of(declare(node, CreateParameters)).items():
        if getattr(arguments, name) is None:
            setattr(arguments, name, value)
    declare_given(node)  # one of them may be the description


def _is_true(text: str) -> bool:
    return text.lower() in ("true", "1")


def find_service(node: Any, world: str, name: str, kind: str, timeout: float = _TIMEOUT) -> str:
    """Return a service of a world; without a world that of the first one that there is.

    Raises
    ------
    UserError
    """
    from rclpy.clock import Clock
    from rclpy.clock_type import ClockType
    from rclpy.duration import Duration
    from rclpy.executors import ExternalShutdownException

    clock = Clock(clock_type=ClockType.STEADY_TIME)
    found: list[str] = []

    def ready(limit_s: float) -> bool:
        end = clock.now() + Duration(seconds=limit_s)
        while clock.now() < end and not found:
            for service, kinds in node.get_service_names_and_types():
                parts = service.split("/")
                if kind in kinds and len(parts) == 4 and parts[3] == name and world in ("", parts[2]):
                    found.append(service)
            if not found and not clock.sleep_for(Duration(seconds=0.1)):
                raise ExternalShutdownException
        return bool(found)

    wanted = f"/world/{world or '<name>'}/{name}"
    if not wait_in_launch(ready, timeout, lambda: node.get_logger().warning(f"waiting for {wanted}")):
        raise UserError(f"no simulator offers {wanted}; was it started?")
    return found[0]


def _description(arguments: argparse.Namespace, node: Any) -> str:
    if arguments.string:
        return str(arguments.string)
    if arguments.topic:
        return _from_topic(node, arguments.topic)
    if arguments.param:
        if not node.has_parameter(arguments.param):
            raise UserError(f"the parameter '{arguments.param}' is not set")
        return str(node.get_parameter(arguments.param).value)
    if arguments.file:
        return _from_file(arguments.file)
    raise UserError("say what to spawn: -file, -topic, -param or -string")


def _from_topic(node: Any, topic: str) -> str:
    from rclpy.qos import DurabilityPolicy, QoSProfile
    from rclpy.wait_for_message import wait_for_message
    from std_msgs.msg import String

    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    texts: list[str] = []

    def ready(limit_s: float) -> bool:
        found, message = wait_for_message(String, node, topic, qos_profile=latched, time_to_wait=limit_s)
        texts.extend([str(message.data)] if found else [])
        return found

    if not wait_in_launch(ready, _TIMEOUT, lambda: node.get_logger().warning(f"waiting for '{topic}'")):
        raise UserError(f"nothing came on '{topic}' within {_TIMEOUT:g} s")
    return texts[0]


def _from_file(name: str) -> str:
    from daidalos.description.resolve import default_model_path, resolve_uri
    from daidalos.nodes.packages import package_share

    path = resolve_uri(name, Path.cwd(), package_share, default_model_path())
    if path is None:
        raise UserError(f"there is no file or model '{name}'")
    if path.is_dir():
        path = path / "model.sdf"
    try:
        return path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise UserError(f"cannot read '{path}': {error}") from None


def _create(arguments: argparse.Namespace) -> None:
    import rclpy
    from ros_gz_interfaces.msg import EntityFactory
    from ros_gz_interfaces.srv import SpawnEntity

    from daidalos.common.pose3 import Pose
    from daidalos.nodes.gazebo_ros._states import pose_message

    rclpy.init()
    node = rclpy.create_node("ros_gz_sim")
    take_parameters(arguments, node)
    factory = EntityFactory(
        name=arguments.name,
        allow_renaming=arguments.allow_renaming,
        sdf=_description(arguments, node),
        pose=pose_message(
            Pose.from_xyz_rpy((arguments.x, arguments.y, arguments.z), (arguments.R, arguments.P, arguments.Y))
        ),
    )
    service = find_service(node, arguments.world, "create", "ros_gz_interfaces/srv/SpawnEntity")
    client = node.create_client(SpawnEntity, service)
    response = answer(client, SpawnEntity.Request(entity_factory=factory), node.get_logger().warning)
    if not response.success:
        raise UserError(f"the entity '{arguments.name}' was not created; the simulator says why")
    node.get_logger().info("Entity creation successful.")
    node.destroy_node()


def main() -> int:
    """Run the program."""
    arguments = parse(program_arguments())
    return run_program(lambda: _create(arguments), interrupted=130)
