"""Services that ros_gz_bridge offers for gz, such as ``/world/<name>/create``, and wrenches on links."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from daidalos.description.errors import DescriptionError
from daidalos.description.resolve import default_model_path, resolve_uri
from daidalos.nodes.gazebo_ros._entities import find_entity, set_motion
from daidalos.nodes.gazebo_ros._host import Host
from daidalos.nodes.gazebo_ros._states import pose_of
from daidalos.nodes.packages import package_share
from daidalos.simulation import Simulation
from daidalos.simulation.errors import SimulationError


class GzServices:
    """Offers `ros_gz_interfaces` for the world that was loaded first.

    Parameters
    ----------
    node : Node
    host : Host
    group : CallbackGroup
    """

    def __init__(self, node: Any, host: Host, group: Any) -> None:
        from ros_gz_interfaces.msg import Entity, EntityWrench
        from ros_gz_interfaces.srv import ControlWorld, DeleteEntity, SetEntityPose, SpawnEntity

        self._node = node
        self._host = host
        base = f"/world/{host.paced.simulation.world.name}"
        for kind, name, work in (
            (ControlWorld, "control", self._control),
            (SpawnEntity, "create", self._create),
            (DeleteEntity, "remove", self._remove),
            (SetEntityPose, "set_pose", self._set_pose),
        ):
            node.create_service(kind, f"{base}/{name}", self._answering(work), callback_group=group)
        for message, name, take in (
            (EntityWrench, "wrench", lambda request: self._push(request, lasts=False)),
            (EntityWrench, "wrench/persistent", lambda request: self._push(request, lasts=True)),
            (Entity, "wrench/clear", self._stop_pushing),
        ):
            node.create_subscription(message, f"{base}/{name}", self._warning(take), 10, callback_group=group)

    def _control(self, request: Any) -> None:
        control, paced = request.world_control, self._host.paced
        reset = control.reset
        if reset.all or reset.time_only or reset.model_only:
            paced.call(lambda simulation: simulation.reset(keep_time=reset.model_only and not reset.all))
        steps = control.multi_step or int(control.step)
        if steps:
            paced.set_paused(True)
            self._host.step(steps)
        else:
            paced.set_paused(control.pause)

    def _create(self, request: Any) -> None:
        factory = request.entity_factory
        text = factory.sdf or _text(factory.sdf_filename)
        pose, reference = pose_of(factory.pose), factory.relative_to
        self._host.spawn(text, factory.name or None, pose, reference, rename=factory.allow_renaming)

    def _remove(self, request: Any) -> None:
        self._host.delete(request.entity.name)

    def _set_pose(self, request: Any) -> None:
        name, pose = request.entity.name, pose_of(request.pose)
        self._host.paced.call(lambda simulation: set_motion(simulation, find_entity(simulation, name), "", pose, None))

    def _push(self, request: Any, lasts: bool) -> None:
        force, torque = request.wrench.force, request.wrench.torque

        def work(simulation: Simulation) -> None:
            values = (force.x, force.y, force.z), (torque.x, torque.y, torque.z)
            duration = None if lasts else simulation.step_ns
            simulation.push(*_link(simulation, request.entity.name), *values, duration_ns=duration)

        self._host.paced.call(work)

    def _stop_pushing(self, request: Any) -> None:
        self._host.paced.call(lambda simulation: simulation.stop_pushing(*_link(simulation, request.name)))

    def _warning(self, take: Callable[[Any], None]) -> Callable[[Any], None]:
        def take_command(message: Any) -> None:
            try:
                take(message)
            except SimulationError as error:
                self._node.get_logger().warning(str(error))

        return take_command

    def _answering(self, work: Callable[[Any], None]) -> Callable[[Any, Any], Any]:
        def answer(request: Any, response: Any) -> Any:
            try:
                work(request)
                response.success = True
            except (SimulationError, DescriptionError, OSError, ValueError) as error:
                self._node.get_logger().error(str(error))
                response.success = False
            return response

        return answer


def _link(simulation: Simulation, name: str) -> tuple[str, str]:
    """Return model and link of a name; of a model the first link."""
    entity = find_entity(simulation, name)
    return entity.model, entity.link or next(iter(simulation.instance(entity.model).model.links))


def _text(uri: str) -> str:
    path = resolve_uri(uri, Path.cwd(), package_share, default_model_path())
    if path is None:
        raise FileNotFoundError(f"there is no model {uri!r}")
    return (path / "model.sdf" if path.is_dir() else path).read_text(encoding="utf-8")
