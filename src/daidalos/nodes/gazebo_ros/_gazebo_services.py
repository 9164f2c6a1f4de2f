"""The services of Gazebo classic's ROS packages, ROS 2's and ROS 1's."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from daidalos.description.errors import DescriptionError
from daidalos.description.joint import JointType
from daidalos.nodes.conversions import nanoseconds, time_message
from daidalos.nodes.gazebo_ros._entities import Entity, find_entity, find_joint, motion_of, set_motion
from daidalos.nodes.gazebo_ros._host import Host, state_namespaces
from daidalos.nodes.gazebo_ros._messages import trajectory_of
from daidalos.nodes.gazebo_ros._states import (
    color_message,
    color_of,
    pose_message,
    pose_of,
    require_finite,
    twist_message,
    vector_of,
)
from daidalos.simulation import Simulation
from daidalos.simulation.errors import SimulationError

Work = Callable[[Simulation, Any, Any], None]

_JOINT_TYPES = {
    JointType.REVOLUTE: 0,
    JointType.CONTINUOUS: 1,
    JointType.PRISMATIC: 2,
    JointType.FIXED: 3,
    JointType.BALL: 4,
    JointType.UNIVERSAL: 5,
}


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
        self._offer(Trigger, ("/gazebo/save_state",), _told("message", lambda _: self._host.save_state()))
        self._offer(Trigger, ("/gazebo/restore_state",), _told("message", lambda _: self._host.restore_state()))

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

        return _told("status_message", work)(request, response)

    def _delete(self, name_of: Callable[[Any], str]) -> Callable[[Any, Any], Any]:
        def work(request: Any) -> str:
            self._host.delete(name_of(request))
            return f"Successfully deleted entity [{name_of(request)}]"

        return _told("status_message", work)

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
        self._simulate(GetEntityState, ("get_entity_state",), _get_entity_state, places)
        self._simulate(
            SetEntityState, ("set_entity_state",), lambda s, q, r: _set_state(s, q.state.name, q.state), places
        )
        self._simulate(GetModelState, ("get_model_state",), _get_model_state)
        self._simulate(
            SetModelState, ("set_model_state",), lambda s, q, r: _set_state(s, q.model_state.model_name, q.model_state)
        )
        self._simulate(GetLinkState, ("get_link_state",), _get_link_state)
        self._simulate(
            SetLinkState, ("set_link_state",), lambda s, q, r: _set_state(s, q.link_state.link_name, q.link_state)
        )
        self._simulate(SetModelConfiguration, ("set_model_configuration",), _set_configuration)
        self._simulate(SetJointTrajectory, ("set_joint_trajectory",), _follow)

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

        self._simulate(GetModelProperties, ("get_model_properties",), _get_model_properties)
        self._simulate(GetJointProperties, ("get_joint_properties",), _get_joint_properties)
        self._simulate(SetJointProperties, ("set_joint_properties",), _set_joint_properties)
        self._simulate(GetLinkProperties, ("get_link_properties",), _get_link_properties)
        self._simulate(SetLinkProperties, ("set_link_properties",), _set_link_properties)
        self._simulate(GetLightProperties, ("get_light_properties",), _get_light_properties)
        self._simulate(SetLightProperties, ("set_light_properties",), _set_light_properties)
        self._simulate(GetWorldProperties, ("get_world_properties",), _get_world_properties)
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

        self._simulate(ApplyLinkWrench, ("apply_link_wrench",), lambda s, q, r: _push(s, q.link_name, q))
        self._simulate(ApplyBodyWrench, ("apply_body_wrench",), lambda s, q, r: _push(s, q.body_name, q))
        self._simulate(ApplyJointEffort, ("apply_joint_effort",), _push_joint)
        self._simulate(LinkRequest, ("clear_link_wrenches",), lambda s, q, r: _stop(s, q.link_name))
        self._simulate(BodyRequest, ("clear_body_wrenches",), lambda s, q, r: _stop(s, q.body_name))
        self._simulate(
            JointRequest, ("clear_joint_efforts",), lambda s, q, r: s.stop_pushing(*find_joint(s, q.joint_name))
        )

    # How they are offered

    def _simulate(
        self, kind: Any, names: tuple[str, ...], work: Work, places: tuple[str, ...] = ("", "/gazebo")
    ) -> None:
        """Offer a service that works on the simulation between its steps, in several places."""

        def answer(request: Any, response: Any) -> Any:
            def told(_: Any) -> None:
                self._host.paced.call(lambda simulation: work(simulation, request, response))

            return _told("status_message", told)(request, response)

        for name in names:
            self._offer(kind, tuple(f"{place}/{name}" for place in places), answer)

    def _offer(self, kind: Any, names: tuple[str, ...], answer: Callable[[Any, Any], Any]) -> None:
        for name in names:
            self._node.create_service(kind, name, answer, callback_group=self._group)


def _told(field: str, work: Callable[[Any], str | None]) -> Callable[[Any, Any], Any]:
    """Return a callback that says whether some work succeeded, and what went wrong."""

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


def _get_entity_state(simulation: Simulation, request: Any, response: Any) -> None:
    motion = motion_of(simulation, find_entity(simulation, request.name), request.reference_frame)
    response.header.stamp = time_message(simulation.time_ns)
    response.header.frame_id = request.reference_frame or "world"
    response.state.name = request.name
    response.state.reference_frame = request.reference_frame
    response.state.pose = pose_message(motion.pose)
    response.state.twist = twist_message(motion.linear, motion.angular)


def _get_model_state(simulation: Simulation, request: Any, response: Any) -> None:
    motion = motion_of(simulation, find_entity(simulation, request.model_name), request.relative_entity_name)
    response.header.stamp = time_message(simulation.time_ns)
    response.header.frame_id = request.relative_entity_name or "world"
    response.pose, response.twist = pose_message(motion.pose), twist_message(motion.linear, motion.angular)


def _get_link_state(simulation: Simulation, request: Any, response: Any) -> None:
    motion = motion_of(simulation, find_entity(simulation, request.link_name), request.reference_frame)
    state = response.link_state
    state.link_name, state.reference_frame = request.link_name, request.reference_frame
    state.pose, state.twist = pose_message(motion.pose), twist_message(motion.linear, motion.angular)


def _set_state(simulation: Simulation, name: str, state: Any) -> None:
    twist = state.twist
    velocity = np.array(vector_of(twist.linear)), np.array(vector_of(twist.angular))
    set_motion(simulation, find_entity(simulation, name), state.reference_frame, pose_of(state.pose), velocity)


def _set_configuration(simulation: Simulation, request: Any, response: Any) -> None:
    if len(request.joint_names) != len(request.joint_positions):
        raise ValueError(f"{len(request.joint_names)} joints, but {len(request.joint_positions)} positions")
    require_finite("joint_positions", request.joint_positions)
    for joint in request.joint_names:
        simulation.joint(request.model_name, joint)
    for joint, position in zip(request.joint_names, request.joint_positions, strict=True):
        simulation.set_joint(request.model_name, joint, position)


def _follow(simulation: Simulation, request: Any, response: Any) -> None:
    if request.set_model_pose:
        simulation.set_pose(request.model_name, pose_of(request.model_pose))
    simulation.follow(request.model_name, trajectory_of(request.joint_trajectory))


def _get_model_properties(simulation: Simulation, request: Any, response: Any) -> None:
    instance = simulation.instance(request.model_name)
    response.canonical_body_name = next(iter(instance.model.links), "")
    response.body_names = list(instance.model.links)
    response.geom_names = [c.name for link in instance.model.links.values() for c in link.collisions]
    response.joint_names = list(instance.model.joints)
    nested = {name.rpartition("::")[0] for name in instance.model.links}
    response.child_model_names = sorted(nested - {""})
    response.is_static = instance.model.static


def _get_joint_properties(simulation: Simulation, request: Any, response: Any) -> None:
    model, name = find_joint(simulation, request.joint_name)
    joint = simulation.instance(model).model.joints[name]
    response.type = _JOINT_TYPES.get(joint.type, 0)
    if simulation.instance(model).build.joints.get(name):
        view = simulation.joint(model, name)
        response.damping = [float(view.physics.model.dof_damping[view.dof])]
        response.position, response.rate = [view.position], [view.velocity]


def _set_joint_properties(simulation: Simulation, request: Any, response: Any) -> None:
    model, name = find_joint(simulation, request.joint_name)
    wanted = request.ode_joint_config
    require_finite("ode_joint_config", (*wanted.damping, *wanted.lo_stop, *wanted.hi_stop))
    limits = (wanted.lo_stop[0], wanted.hi_stop[0]) if wanted.lo_stop and wanted.hi_stop else None
    simulation.set_joint_properties(model, name, wanted.damping[0] if wanted.damping else None, limits)


def _get_link_properties(simulation: Simulation, request: Any, response: Any) -> None:
    from daidalos.description.link import Inertial

    entity = _link(simulation, request.link_name)
    link = simulation.instance(entity.model).model.links[entity.link or ""]
    inertial = link.inertial or Inertial(0.0)
    response.com, response.gravity_mode, response.mass = pose_message(inertial.pose), link.gravity, inertial.mass
    for key, value in zip(("ixx", "ixy", "ixz", "iyy", "iyz", "izz"), inertial.inertia, strict=True):
        setattr(response, key, value)


def _set_link_properties(simulation: Simulation, request: Any, response: Any) -> None:
    from daidalos.description.link import Inertial

    entity = _link(simulation, request.link_name)
    moments = request.ixx, request.ixy, request.ixz, request.iyy, request.iyz, request.izz
    require_finite("mass and moments", (request.mass, *moments))
    inertial = Inertial(request.mass, pose_of(request.com), moments)
    simulation.set_link_properties(entity.model, entity.link or "", inertial, request.gravity_mode)


def _link(simulation: Simulation, name: str) -> Entity:
    entity = find_entity(simulation, name)
    return Entity(entity.model, entity.link or next(iter(simulation.instance(entity.model).model.links)))


def _get_light_properties(simulation: Simulation, request: Any, response: Any) -> None:
    light = simulation.stage.light(request.light_name)
    response.diffuse = color_message(light.diffuse)
    response.attenuation_constant = light.attenuation_constant
    response.attenuation_linear = light.attenuation_linear
    response.attenuation_quadratic = light.attenuation_quadratic


def _set_light_properties(simulation: Simulation, request: Any, response: Any) -> None:
    light = simulation.stage.light(request.light_name)
    changed = replace(
        light,
        diffuse=color_of(request.diffuse),
        attenuation_constant=request.attenuation_constant,
        attenuation_linear=request.attenuation_linear,
        attenuation_quadratic=request.attenuation_quadratic,
    )
    simulation.stage.set_light(request.light_name, changed)


def _get_world_properties(simulation: Simulation, request: Any, response: Any) -> None:
    response.sim_time = simulation.time_ns * 1e-9
    response.model_names = list(simulation.models)
    response.rendering_enabled = True


def _push(simulation: Simulation, name: str, request: Any) -> None:
    """Push a link; the wrench is in the axes of the reference, the point in the link."""
    from daidalos.description.pose import rotate

    entity = _link(simulation, name)
    force, torque = vector_of(request.wrench.force), vector_of(request.wrench.torque)
    if request.reference_frame not in ("", "world", "map"):
        frame = find_entity(simulation, request.reference_frame)
        turn = simulation.pose(frame.model, frame.link).orientation
        force, torque = rotate(turn, force), rotate(turn, torque)
    point = vector_of(request.reference_point)
    simulation.push(entity.model, entity.link, force, torque, point, *_span(simulation, request))


def _push_joint(simulation: Simulation, request: Any, response: Any) -> None:
    require_finite("effort", [request.effort])
    simulation.push_joint(*find_joint(simulation, request.joint_name), request.effort, *_span(simulation, request))


def _span(simulation: Simulation, request: Any) -> tuple[int, int | None]:
    """Return delay and duration; a negative duration is without end, a start in the past is now."""
    delay = nanoseconds(request.start_time) - simulation.time_ns
    duration = nanoseconds(request.duration)
    return max(0, delay), None if duration < 0 or math.isinf(duration) else duration


def _stop(simulation: Simulation, name: str) -> None:
    entity = _link(simulation, name)
    simulation.stop_pushing(entity.model, entity.link or "")
