"""The services of `simulation_interfaces` about entities: robots, models and what could be spawned."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from daidalos.description.errors import DescriptionError
from daidalos.description.resolve import default_model_path
from daidalos.nodes.gazebo_ros._descriptions import read_entity, read_entity_file
from daidalos.nodes.gazebo_ros._entities import find_entity, motion_of, set_motion
from daidalos.nodes.gazebo_ros._filters import has_tags, matching
from daidalos.nodes.gazebo_ros._host import Host
from daidalos.nodes.gazebo_ros._service_results import OK, UNSUPPORTED, Failure, create_services, find_resource
from daidalos.nodes.gazebo_ros._states import pose_message, pose_of, twist_message, vector_of
from daidalos.samples.fields import time_message
from daidalos.simulation import Simulation
from daidalos.simulation.errors import NameTakenError, UnknownNameError

if TYPE_CHECKING:
    from daidalos.common.pose3 import Pose
    from daidalos.description.robot import Robot
    from daidalos.description.world import Model

_NAME_TAKEN, _NAME_INVALID, _NO_RESOURCE, _PARSE_ERROR = 101, 102, 104, 106
_ROBOT = re.compile(r"<robot[^>]*\sname=")


class EntityServices:
    """Offers the services about entities under the node's namespace.

    Parameters
    ----------
    node : Node
    host : Host
    group : CallbackGroup
    """

    def __init__(self, node: Any, host: Host, group: Any) -> None:
        from simulation_interfaces import srv

        self._host = host
        self._infos: dict[str, Any] = {}
        services = (
            (srv.SpawnEntity, "spawn_entity", self._spawn),
            (srv.SpawnEntities, "spawn_entities", self._spawn_several),
            (srv.DeleteEntity, "delete_entity", self._delete),
            (srv.GetEntities, "get_entities", self._entities),
            (srv.GetEntityState, "get_entity_state", self._state),
            (srv.GetEntitiesStates, "get_entities_states", self._states),
            (srv.SetEntityState, "set_entity_state", self._set_state),
            (srv.GetEntityInfo, "get_entity_info", self._info),
            (srv.SetEntityInfo, "set_entity_info", self._set_info),
            (srv.GetEntityBounds, "get_entity_bounds", self._bounds),
            (srv.GetNamedPoses, "get_named_poses", self._named_poses),
            (srv.GetNamedPoseBounds, "get_named_pose_bounds", self._named_pose_bounds),
            (srv.GetSpawnables, "get_spawnables", self._spawnables),
        )
        create_services(node, services, group)

    def forget_infos(self) -> None:
        """Remove the infos of entities, since the world was replaced."""
        self._infos.clear()

    def _spawn(self, request: Any, response: Any) -> None:
        response.entity_name = self._spawned(request)

    def _spawn_several(self, request: Any, response: Any) -> None:
        from simulation_interfaces.msg import Result, SpawnResult

        for wanted in request.spawn_requests:
            try:
                response.results.append(SpawnResult(result=Result(result=OK), entity_name=self._spawned(wanted)))
            except Failure as failure:
                result = Result(result=failure.code, error_message=failure.words)
                response.results.append(SpawnResult(result=result))
        if any(result.result.result != OK for result in response.results):
            raise Failure(150, "not all entities were spawned; see the results")

    def _spawned(self, request: Any) -> str:
        if request.name and not re.fullmatch(r"[\w.:/ -]+", request.name):
            raise Failure(_NAME_INVALID, f"{request.name!r} is not a name for an entity")
        stamped = request.initial_pose
        try:
            return self._host.insert(
                _entity(request.entity_resource),
                request.name or None,
                pose_of(stamped.pose),
                stamped.header.frame_id,
                request.entity_namespace,
                rename=request.allow_renaming,
            )
        except NameTakenError as error:
            raise Failure(_NAME_TAKEN, str(error)) from None
        except DescriptionError as error:
            raise Failure(_PARSE_ERROR, str(error)) from None

    def _delete(self, request: Any, response: Any) -> None:
        self._host.delete(request.entity)

    def _entities(self, request: Any, response: Any) -> None:
        response.entities = self._host.paced.call(lambda s: self._filtered(s, request.filters))

    def _states(self, request: Any, response: Any) -> None:
        def work(simulation: Simulation) -> None:
            response.entities = self._filtered(simulation, request.filters)
            response.states = [_state(simulation, name) for name in response.entities]

        self._host.paced.call(work)

    def _state(self, request: Any, response: Any) -> None:
        response.state = self._host.paced.call(lambda simulation: _state(simulation, request.entity))

    def _set_state(self, request: Any, response: Any) -> None:
        if request.set_acceleration:
            raise Failure(UNSUPPORTED, "accelerations cannot be set")
        state = request.state
        twist = state.twist
        velocity = np.array(vector_of(twist.linear)), np.array(vector_of(twist.angular))
        self._host.paced.call(
            lambda simulation: set_motion(
                simulation,
                find_entity(simulation, request.entity),
                state.header.frame_id,
                pose_of(state.pose) if request.set_pose else None,
                velocity if request.set_twist else None,
            )
        )

    def _info(self, request: Any, response: Any) -> None:
        response.info = self._host.paced.call(lambda simulation: self._info_of(simulation, request.entity))

    def _set_info(self, request: Any, response: Any) -> None:
        self._host.paced.call(lambda simulation: simulation.instance(request.entity))
        self._infos[request.entity] = request.info

    def _info_of(self, simulation: Simulation, name: str) -> Any:
        from simulation_interfaces.msg import EntityCategory, EntityInfo

        model = simulation.instance(name).model
        if name in self._infos:
            return self._infos[name]
        moves = (
            EntityCategory.CATEGORY_ROBOT if model.joints or model.plugins else (EntityCategory.CATEGORY_DYNAMIC_OBJECT)
        )
        category = EntityCategory.CATEGORY_STATIC_OBJECT if model.static else moves
        return EntityInfo(category=EntityCategory(category=category), description=model.source)

    def _bounds(self, request: Any, response: Any) -> None:
        from geometry_msgs.msg import Vector3
        from simulation_interfaces.msg import Bounds

        low, high = self._host.paced.call(lambda simulation: simulation.bounds(request.entity))
        points = [Vector3(x=float(x), y=float(y), z=float(z)) for x, y, z in (high, low)]
        response.bounds = Bounds(type=Bounds.TYPE_BOX, points=points)

    def _filtered(self, simulation: Simulation, filters: Any) -> list[str]:
        return matching(simulation, filters, lambda name: self._info_of(simulation, name))

    def _named_poses(self, request: Any, response: Any) -> None:
        from simulation_interfaces.msg import NamedPose

        if has_tags((), request.tags):
            response.poses = [NamedPose(name=name, pose=pose_message(pose)) for name, pose in self._frames().items()]

    def _named_pose_bounds(self, request: Any, response: Any) -> None:
        if request.name not in self._frames():
            raise UnknownNameError("named pose", request.name, self._frames())
        response.bounds.type = response.bounds.TYPE_EMPTY  # a frame takes up no space

    def _frames(self) -> dict[str, Pose]:
        """Return the frames that belong to the world itself."""
        world = self._host.paced.simulation.world
        owners = {model.name for model in world.models} | {"world"}
        return {name: pose for name, pose in world.frames.items() if name.partition("::")[0] not in owners}

    def _spawnables(self, request: Any, response: Any) -> None:
        from simulation_interfaces.msg import Resource, Spawnable

        folders = [Path(source) for source in request.sources] + list(default_model_path())
        configs = [config for folder in folders if folder.is_dir() for config in sorted(folder.glob("*/model.config"))]
        found = [(f"model://{config.parent.name}", config.parent) for config in configs]
        response.spawnables = [
            Spawnable(entity_resource=Resource(uri=uri), description=str(path))
            for uri, path in (*found, *(() if request.sources else _robots()))
        ]


def _robots() -> Iterator[tuple[str, Path]]:
    """Yield addresses and files of the robots that packages describe."""
    from ament_index_python.packages import get_packages_with_prefixes

    for package, prefix in sorted(get_packages_with_prefixes().items()):
        folder = Path(prefix, "share", package, "urdf")
        for path in sorted(folder.glob("*.urdf*")):
            # What has no name is a part that others include.
            if path.suffix in (".urdf", ".xacro") and _ROBOT.search(path.read_text(encoding="utf-8", errors="replace")):
                yield f"package://{package}/urdf/{path.name}", path


def _entity(resource: Any) -> Robot | Model:
    """Read a description that is given as text or by its address."""
    if resource.resource_string:
        return read_entity(resource.resource_string)
    path = find_resource(resource.uri, _NO_RESOURCE)
    try:
        return read_entity_file(path)
    except (OSError, UnicodeDecodeError) as error:
        raise Failure(_NO_RESOURCE, f"{path} cannot be read: {error}") from None


def _state(simulation: Simulation, name: str) -> Any:
    from simulation_interfaces.msg import EntityState

    motion = motion_of(simulation, find_entity(simulation, name))
    state = EntityState(pose=pose_message(motion.pose), twist=twist_message(motion.linear, motion.angular))
    state.header.frame_id, state.header.stamp = "world", time_message(simulation.time_ns)
    return state
