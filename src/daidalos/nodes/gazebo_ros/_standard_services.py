"""The services and the action of `simulation_interfaces`, which every simulator may offer."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from daidalos.description.errors import DescriptionError
from daidalos.description.resolve import default_model_path, resolve_uri
from daidalos.nodes.gazebo_ros._entities import find_entity, motion_of, set_motion
from daidalos.nodes.gazebo_ros._filters import has_tags, matching
from daidalos.nodes.gazebo_ros._host import Host, read_entity, read_entity_file, read_world
from daidalos.nodes.gazebo_ros._states import pose_message, pose_of, twist_message, vector_of
from daidalos.nodes.gazebo_ros._worlds import world_folders, worlds_in
from daidalos.nodes.packages import package_share
from daidalos.samples.fields import time_message
from daidalos.simulation import Simulation
from daidalos.simulation.errors import NameTakenError, SimulationError, UnknownNameError

if TYPE_CHECKING:
    from daidalos.common.pose3 import Pose
    from daidalos.description.robot import Robot
    from daidalos.description.world import Model

_NOT_FOUND, _INCORRECT_STATE, _FAILED, _UNSUPPORTED, _OK = 2, 3, 4, 0, 1
_NAME_TAKEN, _NAME_INVALID, _NO_RESOURCE, _PARSE_ERROR = 101, 102, 104, 106
_WORLD_NO_RESOURCE, _WORLD_PARSE_ERROR = 102, 103
_STOPPED, _PLAYING, _PAUSED, _QUITTING = 0, 1, 2, 3
_FEATURES = (*range(7), *range(8, 15), *range(20, 27), *range(31, 34), 40, 41, *range(43, 46), 50)

_ROBOT = re.compile(r"<robot[^>]*\sname=")


@dataclass(frozen=True)
class Failure(Exception):
    """What a service answers instead: a code of its own or of `Result`, and words."""

    code: int
    words: str


class StandardServices:
    """Offers `simulation_interfaces` under the node's namespace.

    Parameters
    ----------
    node : Node
    host : Host
    group : CallbackGroup
    quit_simulator : callable
        Ends the process.
    """

    def __init__(self, node: Any, host: Host, group: Any, quit_simulator: Callable[[], None]) -> None:
        from rclpy.action import ActionServer, CancelResponse
        from simulation_interfaces import srv
        from simulation_interfaces.action import SimulateSteps

        self._host = host
        self._quit = quit_simulator
        self._infos: dict[str, Any] = {}
        for kind, name, work in (
            (srv.GetSimulatorFeatures, "get_simulator_features", self._features),
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
            (srv.ResetSimulation, "reset_simulation", self._reset),
            (srv.GetSimulationState, "get_simulation_state", self._simulation_state),
            (srv.SetSimulationState, "set_simulation_state", self._set_simulation_state),
            (srv.StepSimulation, "step_simulation", self._step),
            (srv.LoadWorld, "load_world", self._load_world),
            (srv.UnloadWorld, "unload_world", self._unload_world),
            (srv.GetCurrentWorld, "get_current_world", self._current_world),
            (srv.GetAvailableWorlds, "get_available_worlds", self._available_worlds),
        ):
            node.create_service(kind, f"~/{name}", _answering(work), callback_group=group)
        self._action = ActionServer(
            node,
            SimulateSteps,
            "~/simulate_steps",
            self._simulate_steps,
            cancel_callback=lambda _: CancelResponse.ACCEPT,
            callback_group=group,
        )
        self._stopped = False

    # Features

    def _features(self, request: Any, response: Any) -> None:
        response.features.features = list(_FEATURES)
        response.features.spawn_formats = ["urdf", "sdf"]
        response.features.custom_info = "Daidalos on MuJoCo"

    # Entities

    def _spawn(self, request: Any, response: Any) -> None:
        response.entity_name = self._spawned(request)

    def _spawn_several(self, request: Any, response: Any) -> None:
        from simulation_interfaces.msg import Result, SpawnResult

        for wanted in request.spawn_requests:
            try:
                response.results.append(SpawnResult(result=Result(result=_OK), entity_name=self._spawned(wanted)))
            except Failure as failure:
                result = Result(result=failure.code, error_message=failure.words)
                response.results.append(SpawnResult(result=result))
        if any(result.result.result != _OK for result in response.results):
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
            raise Failure(_UNSUPPORTED, "accelerations can not be set")
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

    # Time

    def _reset(self, request: Any, response: Any) -> None:
        scope = request.scope or 255
        if scope & 4:
            self._host.delete_spawned()
        if scope == 255:
            self._host.complete_world()
        if scope & 3:
            self._host.paced.call(lambda simulation: simulation.reset(keep_time=not scope & 1))

    def _simulation_state(self, request: Any, response: Any) -> None:
        paused = _STOPPED if self._stopped else _PAUSED
        response.state.state = paused if self._host.paced.paused else _PLAYING

    def _set_simulation_state(self, request: Any, response: Any) -> None:
        wanted = request.state.state
        current = _STOPPED if self._stopped else (_PAUSED if self._host.paced.paused else _PLAYING)
        if wanted == current:
            raise Failure(101, "it is in this state already")
        if wanted == _QUITTING:
            self._quit()
        elif wanted in (_STOPPED, _PAUSED, _PLAYING):
            self._host.paced.set_paused(wanted != _PLAYING)
            if wanted == _STOPPED:
                self._host.paced.call(lambda simulation: simulation.reset())
            self._stopped = wanted == _STOPPED
        else:
            raise Failure(103, f"there is no way into state {wanted}")

    def _step(self, request: Any, response: Any) -> None:
        self._require_standstill()
        self._host.step(request.steps)

    def _require_standstill(self) -> None:
        if not self._host.paced.paused:
            raise Failure(_INCORRECT_STATE, "pause the simulation before stepping it")

    def _simulate_steps(self, goal: Any) -> Any:
        from simulation_interfaces.action import SimulateSteps

        result = SimulateSteps.Result()
        steps = goal.request.steps
        if not self._host.paced.paused:
            goal.abort()
            result.result.result = _INCORRECT_STATE
            result.result.error_message = "pause the simulation before stepping it"
            return result

        def progress(done: int) -> bool:
            goal.publish_feedback(SimulateSteps.Feedback(completed_steps=done, remaining_steps=steps - done))
            return not goal.is_cancel_requested

        done = self._host.step(steps, progress)
        progress(done)
        if done < steps:
            goal.canceled()
        else:
            goal.succeed()
        result.result.result = _OK
        return result

    # Worlds

    def _load_world(self, request: Any, response: Any) -> None:
        resource = request.world_resource
        path = None if resource.resource_string else _file(resource.uri, _WORLD_NO_RESOURCE)
        try:
            world = read_world(path, resource.resource_string)
            self._host.load_world(world, path)
        except DescriptionError as error:
            raise Failure(_WORLD_PARSE_ERROR, str(error)) from None
        self._infos.clear()
        response.world = self._world_resource()

    def _unload_world(self, request: Any, response: Any) -> None:
        self._host.load_world(read_world(None, "<sdf version='1.9'><world name='empty'/></sdf>"))

    def _current_world(self, request: Any, response: Any) -> None:
        response.world = self._world_resource()

    def _world_resource(self) -> Any:
        from simulation_interfaces.msg import Resource, WorldResource

        path = self._host.world_path
        uri = Resource(uri="" if path is None else str(path.resolve()))
        return WorldResource(name=self._host.paced.simulation.world.name, world_resource=uri)

    def _available_worlds(self, request: Any, response: Any) -> None:
        from simulation_interfaces.msg import Resource, WorldResource

        if not has_tags((), request.filter):
            return
        folders = [*map(Path, request.additional_sources), *world_folders()]
        files = [file for folder in folders for file in sorted(worlds_in(folder))]
        response.worlds = [
            WorldResource(name=file.stem, world_resource=Resource(uri=str(file))) for file in dict.fromkeys(files)
        ]


def _answering(work: Callable[[Any, Any], None]) -> Callable[[Any, Any], Any]:
    """Return a callback that answers with a result, whatever happens."""

    def answer(request: Any, response: Any) -> Any:
        code, words = _OK, ""
        try:
            work(request, response)
        except Failure as failure:
            code, words = failure.code, failure.words
        except UnknownNameError as error:
            code, words = _NOT_FOUND, str(error)
        except (SimulationError, DescriptionError, ValueError) as error:
            code, words = _FAILED, str(error)
        if hasattr(response, "result"):
            response.result.result, response.result.error_message = code, words
        return response

    return answer


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
    path = _file(resource.uri, _NO_RESOURCE)
    try:
        return read_entity_file(path)
    except (OSError, UnicodeDecodeError) as error:
        raise Failure(_NO_RESOURCE, f"{path} can not be read: {error}") from None


def _file(uri: str, missing: int) -> Path:
    path = resolve_uri(uri, Path.cwd(), package_share, default_model_path()) if uri else None
    if path is None:
        raise Failure(missing, f"there is no resource {uri!r}" if uri else "no resource was given")
    return path


def _state(simulation: Simulation, name: str) -> Any:
    from simulation_interfaces.msg import EntityState

    motion = motion_of(simulation, find_entity(simulation, name))
    state = EntityState(pose=pose_message(motion.pose), twist=twist_message(motion.linear, motion.angular))
    state.header.frame_id, state.header.stamp = "world", time_message(simulation.time_ns)
    return state
