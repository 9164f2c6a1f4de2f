"""`spawn_entity.py`: adds a robot or model to the running simulation."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.duration import Duration

from daidalos.nodes.description_files import read_description
from daidalos.nodes.gazebo_ros._command_line import bind_numbers
from daidalos.nodes.runner import UserError, program_arguments, run_program
from daidalos.nodes.waiting import answer, wait_in_launch

_TIMEOUT_S = 30.0
"""How long to wait outside of a launch, as in ROS 2 [s]."""


def parse(words: Sequence[str], prog: str) -> argparse.Namespace:
    """Read the command line."""
    parser = argparse.ArgumentParser(prog=prog, description="Spawn an entity in the simulation.")
    source = parser.add_mutually_exclusive_group(required=True)
    source.add_argument("-file", metavar="FILE", help="a URDF, xacro or SDF file")
    source.add_argument("-topic", metavar="TOPIC", help="a topic with the description, such as robot_description")
    source.add_argument("-database", metavar="NAME", help="a model of the model path")
    source.add_argument("-stdin", action="store_true", help="read the description from standard input")
    parser.add_argument("-entity", required=True, metavar="NAME", help="name of the entity")
    parser.add_argument("-reference_frame", default="", metavar="NAME", help="entity that the pose is relative to")
    parser.add_argument("-gazebo_namespace", default="", metavar="NAMESPACE", help="namespace of the simulator")
    parser.add_argument("-robot_namespace", default="", metavar="NAMESPACE", help="namespace of the entity's topics")
    parser.add_argument(
        "-timeout",
        type=float,
        metavar="SECONDS",
        help=f"how long to wait (default: {_TIMEOUT_S:g}, and in a launch as long as it is running)",
    )
    parser.add_argument("-unpause", action="store_true", help="let time go on after spawning")
    parser.add_argument("-wait", metavar="NAME", help="wait for this entity before spawning")
    parser.add_argument(
        "-spawn_service_timeout", dest="timeout", type=float, metavar="SECONDS", help="old name of -timeout"
    )
    parser.add_argument("-package_to_model", action="store_true", help="accepted: package:// addresses are understood")
    parser.add_argument("-b", dest="bond", action="store_true", help="delete the entity when this program ends")
    for name in ("x", "y", "z", "R", "P", "Y"):
        parser.add_argument(f"-{name}", type=float, default=0.0, help="pose [m, rad]")
    return parser.parse_args(bind_numbers(words))


def _description(arguments: argparse.Namespace, node: Any) -> str:
    """Return the URDF or SDF text."""
    if arguments.stdin:
        return sys.stdin.read()
    if arguments.topic:
        return _from_topic(node, arguments.topic, arguments)
    path = _model_file(arguments.database) if arguments.database else Path(arguments.file)
    return read_description(path)


def _model_file(name: str) -> Path:
    from daidalos.description.resolve import default_model_path, resolve_uri

    folder = resolve_uri(f"model://{name}", model_path=default_model_path())
    if folder is None:
        raise UserError(f"there is no model '{name}' in the model path (GAZEBO_MODEL_PATH)")
    return folder / "model.sdf"


def _comes(ready: Callable[[float], bool], arguments: argparse.Namespace, what: str, node: Any) -> bool:
    """Return whether something comes in time: within `arguments.timeout`, or while the launch is running."""
    if arguments.timeout is not None:
        return ready(arguments.timeout)
    return wait_in_launch(
        ready, _TIMEOUT_S, lambda: node.get_logger().warning(f"waiting for {what}, as the launch is running")
    )


def _from_topic(node: Any, topic: str, arguments: argparse.Namespace) -> str:
    from rclpy.qos import DurabilityPolicy, QoSProfile
    from rclpy.wait_for_message import wait_for_message
    from std_msgs.msg import String

    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    node.get_logger().info(f"Waiting for entity xml on {topic}")
    texts: list[str] = []

    def ready(limit_s: float) -> bool:
        found, message = wait_for_message(String, node, topic, qos_profile=latched, time_to_wait=limit_s)
        texts.extend([str(message.data)] if found else [])
        return found

    if not _comes(ready, arguments, f"a description on '{topic}'", node):
        raise UserError(f"nothing came on '{topic}' within {_limit(arguments):g} s")
    return texts[0]


def _limit(arguments: argparse.Namespace) -> float:
    return _TIMEOUT_S if arguments.timeout is None else float(arguments.timeout)


def _request(arguments: argparse.Namespace, text: str) -> Any:
    from gazebo_msgs.srv import SpawnEntity

    from daidalos.common.pose3 import Pose
    from daidalos.nodes.gazebo_ros._states import pose_message

    pose = Pose.from_xyz_rpy((arguments.x, arguments.y, arguments.z), (arguments.R, arguments.P, arguments.Y))
    return SpawnEntity.Request(
        name=arguments.entity,
        xml=text,
        robot_namespace=arguments.robot_namespace,
        initial_pose=pose_message(pose),
        reference_frame=arguments.reference_frame,
    )


def _spawn(arguments: argparse.Namespace, node: Any) -> None:
    from gazebo_msgs.srv import SpawnEntity
    from std_srvs.srv import Empty

    base = arguments.gazebo_namespace
    timeout = _limit(arguments)
    text = _description(arguments, node)
    if arguments.wait:
        _wait_for(arguments, node, base)
    client = node.create_client(SpawnEntity, f"{base}/spawn_entity")
    node.get_logger().info(f"Waiting for service {base}/spawn_entity, timeout = {timeout:g}")
    if not _comes(client.wait_for_service, arguments, f"{base}/spawn_entity", node):
        raise UserError(f"the service {base}/spawn_entity is not there; was the simulator started?")
    response = answer(client, _request(arguments, text), node.get_logger().warning, arguments.timeout)
    if not response.success:
        raise UserError(f"spawning '{arguments.entity}' failed: {response.status_message}")
    node.get_logger().info(response.status_message)
    if arguments.unpause:
        unpause = node.create_client(Empty, f"{base}/unpause_physics")
        if unpause.wait_for_service(timeout):
            unpause.call(Empty.Request(), timeout)


def _wait_for(arguments: argparse.Namespace, node: Any, base: str) -> None:
    """Wait until an entity is in the simulation."""
    from gazebo_msgs.srv import GetModelList
    from rclpy.executors import ExternalShutdownException

    entity = arguments.wait
    node.get_logger().info(f"Waiting for entity {entity}")
    client = node.create_client(GetModelList, f"{base}/get_model_list")
    clock = Clock(clock_type=ClockType.STEADY_TIME)

    def ready(limit_s: float) -> bool:
        end = clock.now() + Duration(seconds=limit_s)
        # Requested by a service, since a paused simulation publishes nothing.
        while client.wait_for_service(max(0.0, (end - clock.now()).nanoseconds * 1e-9)):
            response = client.call(GetModelList.Request(), limit_s)
            if response is not None and entity in response.model_names:
                return True
            if not clock.sleep_for(Duration(seconds=0.2)):
                raise ExternalShutdownException
        return False

    if not _comes(ready, arguments, f"entity '{entity}'", node):
        raise UserError(f"there was no entity '{entity}' within {_limit(arguments):g} s")


def _place_joints(joints: Mapping[str, float], arguments: argparse.Namespace, node: Any) -> None:
    from gazebo_msgs.srv import SetModelConfiguration

    client = node.create_client(SetModelConfiguration, f"{arguments.gazebo_namespace}/set_model_configuration")
    request = SetModelConfiguration.Request(
        model_name=arguments.entity, joint_names=list(joints), joint_positions=list(joints.values())
    )
    limit_s = _limit(arguments)
    response = client.call(request, limit_s) if client.wait_for_service(limit_s) else None
    if response is None or not response.success:
        raise UserError(f"joints could not be placed: {'no answer' if response is None else response.status_message}")


def _delete_at_end(arguments: argparse.Namespace, node: Any) -> None:
    """Wait until the process is asked to end, then delete the entity."""
    import rclpy
    from gazebo_msgs.srv import DeleteEntity
    from rclpy.executors import ExternalShutdownException

    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        # The context has been shut down: the last call goes out with one of its own.
        context = rclpy.Context()
        rclpy.init(context=context)
        helper = rclpy.create_node("spawn_entity", context=context)
        client = helper.create_client(DeleteEntity, f"{arguments.gazebo_namespace}/delete_entity")
        if client.wait_for_service(2.0):
            client.call(DeleteEntity.Request(name=arguments.entity), 2.0)
        helper.destroy_node()
        rclpy.shutdown(context=context)


def spawn(words: Sequence[str], joints: Mapping[str, float], prog: str) -> None:
    """Run the command line.

    Parameters
    ----------
    words : sequence of str
        The arguments.
    joints : mapping
        Where joints begin [rad, m].
    prog : str
        Name of the program.

    Raises
    ------
    UserError
    """
    import rclpy

    arguments = parse(words, prog)
    rclpy.init()
    node = rclpy.create_node("spawn_entity")
    _spawn(arguments, node)
    if joints:
        _place_joints(joints, arguments, node)
    if arguments.bond:
        _delete_at_end(arguments, node)
    node.destroy_node()


def main() -> int:
    """Run the program."""
    return run_program(lambda: spawn(program_arguments(), {}, "spawn_entity.py"), interrupted=130)
