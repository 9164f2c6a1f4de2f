"""Application of external forces to MuJoCo's arrays."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from daidalos.common.pose3 import rotate
from daidalos.simulation.forces import Forces, JointPush, Push
from daidalos.simulation.instance import Instance
from daidalos.simulation.physics import Physics


def apply_forces(forces: Forces, physics: Physics, instances: Mapping[str, Instance], now_ns: int) -> None:
    """Write the forces of the next step into MuJoCo's arrays."""
    if not (forces.pushes or forces.is_dirty):
        return
    if forces.pushes:
        physics.refresh_positions()
    data = physics.data
    data.xfrc_applied[:] = 0.0
    data.qfrc_applied[:] = 0.0
    for body, force, torque in forces.held.values():
        data.xfrc_applied[body, :3] += force
        data.xfrc_applied[body, 3:] += torque
    forces.pushes = tuple(push for push in forces.pushes if push.end_ns > now_ns)
    for push in forces.pushes:
        if push.start_ns <= now_ns:
            _apply(instances[push.model], data, push)
    forces.is_dirty = bool(forces.held or forces.pushes)


def _apply(instance: Instance, data: Any, push: Push | JointPush) -> None:
    if isinstance(push, JointPush):
        data.qfrc_applied[instance.joint(push.joint).dof] += push.effort
        return
    link = instance.link(push.link)
    pose = link.pose
    force, torque = push.force, push.torque
    if push.follows:
        force, torque = rotate(pose.orientation, force), rotate(pose.orientation, torque)
    arm = np.array(pose.transform(push.point)) - data.xipos[link.body]
    data.xfrc_applied[link.body, :3] += force
    data.xfrc_applied[link.body, 3:] += np.array(torque) + np.cross(arm, np.array(force))
