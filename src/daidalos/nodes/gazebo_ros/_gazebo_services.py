"""Services of Gazebo classic's ROS packages, for ROS 2 and ROS 1."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from daidalos.description.errors import DescriptionError
from daidalos.nodes.gazebo_ros import _gazebo_answers as answers
from daidalos.nodes.gazebo_ros._descriptions import state_namespaces
from daidalos.nodes.gazebo_ros._entities import find_joint
from daidalos.nodes.gazebo_ros._host import Host
from daidalos.nodes.gazebo_ros._states import pose_of, require_finite, vector_of
from daidalos.samples.fields import time_message
from daidalos.simulation import Simulation
from daidalos.simulation.errors import SimulationError

Work = Callable[[Simulation, Any, Any], None]


class GazeboServices:
    """Offers `gazebo_msgs` and the plain services of time.

    Parameters
    ----------
    node : Node
    host : Host
    group : CallbackGroup
    """

    def __init__(self, node: Any, host: Host, group: Any) -> None:
        self._node = node
        self._host = host
        self._group = group
        self._create_time_services()
        self._create_entity_services()
        self._create_state_services()
        self._create_property_services()
        self._create_force_services()

    # Time

    def _create_time_services(self) -> None:
        from std_srvs.srv import Empty, Trigger

        paced = self._host.paced
        actions: dict[str, Callable[[], object]] = {
            "pause_physics": lambda: paced.set_paused(True),
            "unpause_physics": lambda: paced.set_paused(False),
            "reset_simulation": lambda: paced.call(lambda simulation: simulation.reset()),
            "reset_world": lambda: paced.call(lambda simulation: simulation.reset(keep_time=True)),
        }
        for name, action in actions.items():
            self._offer(Empty, (f"/{name}", f"/gazebo/{name}"), _without_answer(action))
        self._offer(Trigger, ("/gazebo/save_state",), _reporting("message", lambda _: self._host.save_state()))
        self._offer(Trigger, ("/gazebo/restore_state",), _reporting("message", lambda _: self._host.restore_state()))

    # Entities

    def _create_entity_services(self) -> None:
        from gazebo_msgs.srv import DeleteEntity, DeleteLight, DeleteModel, GetModelList, SpawnEntity, SpawnModel

        self._offer(SpawnEntity, ("/spawn_entity",), self._spawn_entity)
        self._offer(SpawnModel, ("/gazebo/spawn_urdf_model", "/gazebo/spawn_sdf_model"), self._spawn_model)
        self._offer(DeleteEntity, ("/delete_entity",), self._delete(lambda request: request.name))
        self._offer(DeleteModel, ("/gazebo/delete_model",), self._delete(lambda request: request.model_name))
        self._offer(GetModelList, ("/get_model_list",), self._list)
        self._simulate(DeleteLight, ("delete_light",), lambda s, q, r: s.stage.remove_light(q.light_name))

    def _spawn_entity(self, request: Any, response: Any) -> Any:
        return self._spawn(request.name, request.xml, request, response)

    def _spawn_model(self, request: Any, response: Any) -> Any:
        return self._spawn(request.model_name, request.model_xml, request, response)

    def _spawn(self, name: str, text: str, request: Any, response: Any) -> Any:
        def work(_: Any) -> str:
            pose, reference = pose_of(request.initial_pose), request.reference_frame
            spawned = self._host.spawn(text, name or None, pose, reference, request.robot_namespace)
            self._node.get_logger().info(f"spawned '{spawned}'")
            return f"SpawnEntity: Successfully spawned entity [{spawned}]"

        return _reporting("status_message", work)(request, response)

    def _delete(self, name_of: Callable[[Any], str]) -> Callable[[Any, Any], Any]:
        def work(request: Any) -> str:
            self._host.delete(name_of(request))
            return f"Successfully deleted entity [{name_of(request)}]"

        return _reporting("status_message", work)

    def _list(self, request: Any, response: Any) -> Any:
        def work(simulation: Simulation) -> None:
            response.header.stamp, response.header.frame_id = time_message(simulation.time_ns), "world"
            response.model_names = list(simulation.models)

        self._host.paced.call(work)
        response.success = True
        return response

    # States

    def _create_state_services(self) -> None:
        from gazebo_msgs.srv import (
            GetEntityState,
            GetLinkState,
            GetModelState,
            SetEntityState,
            SetJointTrajectory,
            SetLinkState,
            SetModelConfiguration,
            SetModelState,
        )

        places = state_namespaces(self._host.paced.simulation.world)
        self._simulate(GetEntityState, ("get_entity_state",), answers.get_entity_state, places)
        self._simulate(SetEntityState, ("set_entity_state",), answers.set_entity_state, places)
        self._simulate(GetModelState, ("get_model_state",), answers.get_model_state)
        self._simulate(SetModelState, ("set_model_state",), answers.set_model_state)
        self._simulate(GetLinkState, ("get_link_state",), answers.get_link_state)
        self._simulate(SetLinkState, ("set_link_state",), answers.set_link_state)
        self._simulate(SetModelConfiguration, ("set_model_configuration",), answers.set_configuration)
        self._simulate(SetJointTrajectory, ("set_joint_trajectory",), answers.follow)

    # Properties

    def _create_property_services(self) -> None:
        from gazebo_msgs.srv import (
            GetJointProperties,
            GetLightProperties,
            GetLinkProperties,
            GetModelProperties,
            GetPhysicsProperties,
            GetWorldProperties,
            SetJointProperties,
            SetLightProperties,
            SetLinkProperties,
            SetPhysicsProperties,
        )

        self._simulate(GetModelProperties, ("get_model_properties",), answers.get_model_properties)
        self._simulate(GetJointProperties, ("get_joint_properties",), answers.get_joint_properties)
        self._simulate(SetJointProperties, ("set_joint_properties",), answers.set_joint_properties)
        self._simulate(GetLinkProperties, ("get_link_properties",), answers.get_link_properties)
        self._simulate(SetLinkProperties, ("set_link_properties",), answers.set_link_properties)
        self._simulate(GetLightProperties, ("get_light_properties",), answers.get_light_properties)
        self._simulate(SetLightProperties, ("set_light_properties",), answers.set_light_properties)
        self._simulate(GetWorldProperties, ("get_world_properties",), answers.get_world_properties)
        self._simulate(GetPhysicsProperties, ("get_physics_properties",), self._get_physics)
        self._simulate(SetPhysicsProperties, ("set_physics_properties",), self._set_physics)

    def _get_physics(self, simulation: Simulation, request: Any, response: Any) -> None:
        x, y, z = simulation.gravity
        response.time_step = simulation.step_ns * 1e-9
        response.pause = self._host.paced.paused
        response.max_update_rate = self._host.paced.real_time_factor / response.time_step
        response.gravity.x, response.gravity.y, response.gravity.z = x, y, z

    def _set_physics(self, simulation: Simulation, request: Any, response: Any) -> None:
        """Set step, gravity, and by both rates the wanted speed; 0 updates a second is as fast as possible."""
        require_finite("time_step and max_update_rate", (request.time_step, request.max_update_rate))
        if request.time_step > 0:
            simulation.set_step(request.time_step)
        simulation.gravity = vector_of(request.gravity)
        self._host.paced.real_time_factor = request.max_update_rate * simulation.step_ns * 1e-9

    # Forces

    def _create_force_services(self) -> None:
        from gazebo_msgs.srv import (
            ApplyBodyWrench,
            ApplyJointEffort,
            ApplyLinkWrench,
            BodyRequest,
            JointRequest,
            LinkRequest,
        )

        self._simulate(ApplyLinkWrench, ("apply_link_wrench",), lambda s, q, r: answers.push(s, q.link_name, q))
        self._simulate(ApplyBodyWrench, ("apply_body_wrench",), lambda s, q, r: answers.push(s, q.body_name, q))
        self._simulate(ApplyJointEffort, ("apply_joint_effort",), answers.push_joint)
        self._simulate(LinkRequest, ("clear_link_wrenches",), lambda s, q, r: answers.stop(s, q.link_name))
        self._simulate(BodyRequest, ("clear_body_wrenches",), lambda s, q, r: answers.stop(s, q.body_name))
        self._simulate(
            JointRequest, ("clear_joint_efforts",), lambda s, q, r: s.stop_pushing(*find_joint(s, q.joint_name))
        )

    # How they are offered

    def _simulate(
        self, kind: Any, names: tuple[str, ...], work: Work, places: tuple[str, ...] = ("", "/gazebo")
    ) -> None:
        """Offer a service that works on the simulation between its steps, in several places."""

        def answer(request: Any, response: Any) -> Any:
            def run(_: Any) -> None:
                self._host.paced.call(lambda simulation: work(simulation, request, response))

            return _reporting("status_message", run)(request, response)

        for name in names:
            self._offer(kind, tuple(f"{place}/{name}" for place in places), answer)

    def _offer(self, kind: Any, names: tuple[str, ...], answer: Callable[[Any, Any], Any]) -> None:
        for name in names:
            self._node.create_service(kind, name, answer, callback_group=self._group)


def _reporting(field: str, work: Callable[[Any], str | None]) -> Callable[[Any, Any], Any]:
    """Return a service callback that reports success, or the error, of a function."""

    def answer(request: Any, response: Any) -> Any:
        message, success = "", True
        try:
            message = work(request) or ""
        except (SimulationError, DescriptionError, ValueError, LookupError) as error:
            message, success = str(error), False
        if hasattr(response, "success"):
            response.success = success
        if hasattr(response, field):
            setattr(response, field, message)
        return response

    return answer


def _without_answer(action: Callable[[], object]) -> Callable[[Any, Any], Any]:
    def answer(request: Any, response: Any) -> Any:
        action()
        return response

    return answer
