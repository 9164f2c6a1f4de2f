"""Entities of a simulation by the names in services: ``robot``, ``robot::base_link``, ``world``."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.pose3 import Pose, rotate
from daidalos.simulation import Simulation
from daidalos.simulation.errors import UnknownNameError


@dataclass(frozen=True)
class Entity:
    """Model, or one of its links."""

    model: str
    link: str | None = None


@dataclass(frozen=True, eq=False)
class Motion:
    """Pose, linear [m/s] and angular [rad/s] velocity, in one frame's axes."""

    pose: Pose
    linear: Array
    angular: Array


def find_entity(simulation: Simulation, name: str) -> Entity:
    """Return the model or link of a name; a bare link's name will do when only one model has such a link.

    Raises
    ------
    UnknownNameError
    """
    model, separator, link = name.partition("::")
    if model in simulation.models:
        if not separator:
            return Entity(model)
        simulation.instance(model).link(link)
        return Entity(model, link)
    owners = [each for each in simulation.models if name in simulation.instance(each).model.links]
    if len(owners) == 1:
        return Entity(owners[0], name)
    raise UnknownNameError("model or link", name, simulation.models)


def find_joint(simulation: Simulation, name: str) -> tuple[str, str]:
    """Return the model and the joint of a name, with or without its model in front.

    Raises
    ------
    UnknownNameError
    """
    model, separator, joint = name.partition("::")
    if separator and model in simulation.models:
        simulation.joint(model, joint)
        return model, joint
    owners = [each for each in simulation.models if name in simulation.instance(each).model.joints]
    if len(owners) == 1:
        return owners[0], name
    known = [f"{each}::{joint}" for each in simulation.models for joint in simulation.instance(each).model.joints]
    raise UnknownNameError("joint", name, known)


def motion_of(simulation: Simulation, entity: Entity, reference: str = "") -> Motion:
    """Return how an entity stands and moves, seen from another one; empty or ``world`` is the world."""
    pose = simulation.pose(entity.model, entity.link)
    linear, angular = simulation.velocity(entity.model, entity.link)
    if reference in ("", "world", "map"):
        return Motion(pose, linear, angular)
    frame = find_entity(simulation, reference)
    base = simulation.pose(frame.model, frame.link)
    own_linear, own_angular = simulation.velocity(frame.model, frame.link)
    arm = np.array(pose.position) - np.array(base.position)
    back = base.inverse.orientation
    seen = linear - own_linear - np.cross(own_angular, arm)
    turning = angular - own_angular
    return Motion(base.inverse @ pose, np.array(rotate(back, seen.tolist())), np.array(rotate(back, turning.tolist())))


def set_motion(
    simulation: Simulation,
    entity: Entity,
    reference: str,
    pose: Pose | None,
    velocity: tuple[Array, Array] | None,
) -> None:
    """Move an entity, given in another one's frame; a link takes its whole model along."""
    base = Pose()
    if reference not in ("", "world", "map"):
        frame = find_entity(simulation, reference)
        base = simulation.pose(frame.model, frame.link)
    if pose is not None:
        goal = base @ pose
        if entity.link is not None:
            goal = goal @ simulation.pose(entity.model, entity.link).inverse @ simulation.pose(entity.model)
        simulation.set_pose(entity.model, goal)
    if velocity is not None and not simulation.instance(entity.model).model.static:
        linear, angular = (np.array(rotate(base.orientation, part.tolist())) for part in velocity)
        simulation.set_velocity(entity.model, linear, angular)
