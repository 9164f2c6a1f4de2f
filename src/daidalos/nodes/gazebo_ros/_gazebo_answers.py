"""Implementation of the services of ROS 2's Gazebo packages."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np

from daidalos.description.joint import JointType
from daidalos.nodes.gazebo_ros._entities import Entity, find_entity, find_joint, motion_of, set_motion
from daidalos.nodes.gazebo_ros._states import (
    color_message,
    color_of,
    pose_message,
    pose_of,
    require_finite,
    twist_message,
    vector_of,
)
from daidalos.samples.fields import nanoseconds, time_message
from daidalos.samples.special_messages import position_trajectory_of
from daidalos.simulation import Simulation

_JOINT_TYPES = {
    JointType.REVOLUTE: 0,
    JointType.CONTINUOUS: 1,
    JointType.PRISMATIC: 2,
    JointType.FIXED: 3,
    JointType.BALL: 4,
    JointType.UNIVERSAL: 5,
}


def get_entity_state(simulation: Simulation, request: Any, response: Any) -> None:
    motion = motion_of(simulation, find_entity(simulation, request.name), request.reference_frame)
    response.header.stamp = time_message(simulation.time_ns)
    response.header.frame_id = request.reference_frame or "world"
    response.state.name = request.name
    response.state.reference_frame = request.reference_frame
    response.state.pose = pose_message(motion.pose)
    response.state.twist = twist_message(motion.linear, motion.angular)


def get_model_state(simulation: Simulation, request: Any, response: Any) -> None:
    motion = motion_of(simulation, find_entity(simulation, request.model_name), request.relative_entity_name)
    response.header.stamp = time_message(simulation.time_ns)
    response.header.frame_id = request.relative_entity_name or "world"
    response.pose, response.twist = pose_message(motion.pose), twist_message(motion.linear, motion.angular)


def get_link_state(simulation: Simulation, request: Any, response: Any) -> None:
    motion = motion_of(simulation, find_entity(simulation, request.link_name), request.reference_frame)
    state = response.link_state
    state.link_name, state.reference_frame = request.link_name, request.reference_frame
    state.pose, state.twist = pose_message(motion.pose), twist_message(motion.linear, motion.angular)


def set_entity_state(simulation: Simulation, request: Any, response: Any) -> None:
    _set_state(simulation, request.state.name, request.state)


def set_model_state(simulation: Simulation, request: Any, response: Any) -> None:
    _set_state(simulation, request.model_state.model_name, request.model_state)


def set_link_state(simulation: Simulation, request: Any, response: Any) -> None:
    _set_state(simulation, request.link_state.link_name, request.link_state)


def _set_state(simulation: Simulation, name: str, state: Any) -> None:
    twist = state.twist
    velocity = np.array(vector_of(twist.linear)), np.array(vector_of(twist.angular))
    set_motion(simulation, find_entity(simulation, name), state.reference_frame, pose_of(state.pose), velocity)


def set_configuration(simulation: Simulation, request: Any, response: Any) -> None:
    if len(request.joint_names) != len(request.joint_positions):
        raise ValueError(f"{len(request.joint_names)} joints, but {len(request.joint_positions)} positions")
    require_finite("joint_positions", request.joint_positions)
    for joint in request.joint_names:
        simulation.joint(request.model_name, joint)
    for joint, position in zip(request.joint_names, request.joint_positions, strict=True):
        simulation.set_joint(request.model_name, joint, position)


def follow(simulation: Simulation, request: Any, response: Any) -> None:
    if request.set_model_pose:
        simulation.set_pose(request.model_name, pose_of(request.model_pose))
    simulation.follow(request.model_name, position_trajectory_of(request.joint_trajectory))


def get_model_properties(simulation: Simulation, request: Any, response: Any) -> None:
    instance = simulation.instance(request.model_name)
    response.canonical_body_name = next(iter(instance.model.links), "")
    response.body_names = list(instance.model.links)
    response.geom_names = [c.name for link in instance.model.links.values() for c in link.collisions]
    response.joint_names = list(instance.model.joints)
    nested = {name.rpartition("::")[0] for name in instance.model.links}
    response.child_model_names = sorted(nested - {""})
    response.is_static = instance.model.static


def get_joint_properties(simulation: Simulation, request: Any, response: Any) -> None:
    model, name = find_joint(simulation, request.joint_name)
    joint = simulation.instance(model).model.joints[name]
    response.type = _JOINT_TYPES.get(joint.type, 0)
    if simulation.instance(model).build.joints.get(name):
        view = simulation.joint(model, name)
        response.damping = [float(view.physics.model.dof_damping[view.dof])]
        response.position, response.rate = [view.position], [view.velocity]


def set_joint_properties(simulation: Simulation, request: Any, response: Any) -> None:
    model, name = find_joint(simulation, request.joint_name)
    wanted = request.ode_joint_config
    require_finite("ode_joint_config", (*wanted.damping, *wanted.lo_stop, *wanted.hi_stop))
    limits = (wanted.lo_stop[0], wanted.hi_stop[0]) if wanted.lo_stop and wanted.hi_stop else None
    simulation.set_joint_properties(model, name, wanted.damping[0] if wanted.damping else None, limits)


def get_link_properties(simulation: Simulation, request: Any, response: Any) -> None:
    from daidalos.description.link import Inertial

    entity = _link(simulation, request.link_name)
    link = simulation.instance(entity.model).model.links[entity.link or ""]
    inertial = link.inertial or Inertial(0.0)
    response.com, response.gravity_mode, response.mass = pose_message(inertial.pose), link.gravity, inertial.mass
    for key, value in zip(("ixx", "ixy", "ixz", "iyy", "iyz", "izz"), inertial.inertia, strict=True):
        setattr(response, key, value)


def set_link_properties(simulation: Simulation, request: Any, response: Any) -> None:
    from daidalos.description.link import Inertial

    entity = _link(simulation, request.link_name)
    moments = request.ixx, request.ixy, request.ixz, request.iyy, request.iyz, request.izz
    require_finite("mass and moments", (request.mass, *moments))
    inertial = Inertial(request.mass, pose_of(request.com), moments)
    simulation.set_link_properties(entity.model, entity.link or "", inertial, request.gravity_mode)


def _link(simulation: Simulation, name: str) -> Entity:
    entity = find_entity(simulation, name)
    return Entity(entity.model, entity.link or next(iter(simulation.instance(entity.model).model.links)))


def get_light_properties(simulation: Simulation, request: Any, response: Any) -> None:
    light = simulation.stage.light(request.light_name)
    response.diffuse = color_message(light.diffuse)
    response.attenuation_constant = light.attenuation_constant
    response.attenuation_linear = light.attenuation_linear
    response.attenuation_quadratic = light.attenuation_quadratic


def set_light_properties(simulation: Simulation, request: Any, response: Any) -> None:
    light = simulation.stage.light(request.light_name)
    changed = replace(
        light,
        diffuse=color_of(request.diffuse),
        attenuation_constant=request.attenuation_constant,
        attenuation_linear=request.attenuation_linear,
        attenuation_quadratic=request.attenuation_quadratic,
    )
    simulation.stage.set_light(request.light_name, changed)


def get_world_properties(simulation: Simulation, request: Any, response: Any) -> None:
    response.sim_time = simulation.time_ns * 1e-9
    response.model_names = list(simulation.models)
    response.rendering_enabled = True


def push(simulation: Simulation, name: str, request: Any) -> None:
    """Push a link; the wrench is in the axes of the reference, the point in the link."""
    from daidalos.common.pose3 import rotate

    entity = _link(simulation, name)
    force, torque = vector_of(request.wrench.force), vector_of(request.wrench.torque)
    if request.reference_frame not in ("", "world", "map"):
        frame = find_entity(simulation, request.reference_frame)
        turn = simulation.pose(frame.model, frame.link).orientation
        force, torque = rotate(turn, force), rotate(turn, torque)
    point = vector_of(request.reference_point)
    simulation.push(entity.model, entity.link, force, torque, point, *_span(simulation, request))


def push_joint(simulation: Simulation, request: Any, response: Any) -> None:
    require_finite("effort", [request.effort])
    simulation.push_joint(*find_joint(simulation, request.joint_name), request.effort, *_span(simulation, request))


def _span(simulation: Simulation, request: Any) -> tuple[int, int | None]:
    """Return delay and duration; a negative duration is without end, a start in the past is now."""
    delay = nanoseconds(request.start_time) - simulation.time_ns
    duration = nanoseconds(request.duration)
    return max(0, delay), None if duration < 0 or math.isinf(duration) else duration


def stop(simulation: Simulation, name: str) -> None:
    entity = _link(simulation, name)
    simulation.stop_pushing(entity.model, entity.link or "")
