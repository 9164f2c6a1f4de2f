"""The services and the action of `simulation_interfaces`: features, time and worlds; entities have a file of theirs."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from daidalos.description.errors import DescriptionError
from daidalos.nodes.gazebo_ros._descriptions import read_world
from daidalos.nodes.gazebo_ros._entity_services import EntityServices
from daidalos.nodes.gazebo_ros._filters import has_tags
from daidalos.nodes.gazebo_ros._host import Host
from daidalos.nodes.gazebo_ros._service_results import INCORRECT_STATE, OK, Failure, create_services, find_resource
from daidalos.nodes.gazebo_ros._worlds import world_folders, worlds_in

_WORLD_NO_RESOURCE, _WORLD_PARSE_ERROR = 102, 103
_STOPPED, _PLAYING, _PAUSED, _QUITTING = 0, 1, 2, 3
_FEATURES = (*range(7), *range(8, 15), *range(20, 27), *range(31, 34), 40, 41, *range(43, 46), 50)


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
        services = (
            (srv.GetSimulatorFeatures, "get_simulator_features", self._features),
            (srv.ResetSimulation, "reset_simulation", self._reset),
            (srv.GetSimulationState, "get_simulation_state", self._simulation_state),
            (srv.SetSimulationState, "set_simulation_state", self._set_simulation_state),
            (srv.StepSimulation, "step_simulation", self._step),
            (srv.LoadWorld, "load_world", self._load_world),
            (srv.UnloadWorld, "unload_world", self._unload_world),
            (srv.GetCurrentWorld, "get_current_world", self._current_world),
            (srv.GetAvailableWorlds, "get_available_worlds", self._available_worlds),
        )
        create_services(node, services, group)
        self._entities = EntityServices(node, host, group)
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
            raise Failure(INCORRECT_STATE, "pause the simulation before stepping it")

    def _simulate_steps(self, goal: Any) -> Any:
        from simulation_interfaces.action import SimulateSteps

        result = SimulateSteps.Result()
        steps = goal.request.steps
        if not self._host.paced.paused:
            goal.abort()
            result.result.result = INCORRECT_STATE
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
        result.result.result = OK
        return result

    # Worlds

    def _load_world(self, request: Any, response: Any) -> None:
        resource = request.world_resource
        path = None if resource.resource_string else find_resource(resource.uri, _WORLD_NO_RESOURCE)
        try:
            world = read_world(path, resource.resource_string)
            self._host.load_world(world, path)
        except DescriptionError as error:
            raise Failure(_WORLD_PARSE_ERROR, str(error)) from None
        self._entities.forget_infos()
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
