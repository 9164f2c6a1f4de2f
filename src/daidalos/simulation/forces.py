"""Forces from outside: pushes that last for a time, and those that plugins hold."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from daidalos.common.pose3 import Vector, rotate

if TYPE_CHECKING:
    from daidalos.simulation.instance import Instance
    from daidalos.simulation.physics import Physics

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Push:
    """A force on a link that lasts for a time.

    Parameters
    ----------
    model, link : str
    force, torque : tuple of 3 floats
        In world axes [N, N m], or in the link's when `follows` it.
    point : tuple of 3 floats
        Where it acts, in the link's frame [m].
    start_ns, end_ns : float
        Simulated times; an infinite end is for ever.
    follows : bool
    """

    model: str
    link: str
    force: Vector = (0.0, 0.0, 0.0)
    torque: Vector = (0.0, 0.0, 0.0)
    point: Vector = (0.0, 0.0, 0.0)
    start_ns: float = 0.0
    end_ns: float = math.inf
    follows: bool = False


@dataclass(frozen=True)
class JointPush:
    """An effort [N m, N] on a joint that lasts for a time."""

    model: str
    joint: str
    effort: float
    start_ns: float = 0.0
    end_ns: float = math.inf


@dataclass
class Forces:
    """All forces from outside, and their places in the arrays.

    Attributes
    ----------
    pushes : tuple of Push or JointPush
        Those that last for a time; replaced as a whole, so that a saved state can keep them.
    """

    pushes: tuple[Push | JointPush, ...] = ()
    _held: dict[str, tuple[int, Array, Array]] = field(default_factory=dict)
    _instances: Mapping[str, Instance] = field(default_factory=dict)
    _dirty: bool = False

    def bind(self, instances: Mapping[str, Instance]) -> None:
        """Take the models of a newly compiled world; plugins hold their forces again when they are next due."""
        self._instances = instances
        self._held.clear()
        self.pushes = tuple(push for push in self.pushes if push.model in instances)
        self._dirty = True

    def add(self, push: Push | JointPush) -> None:
        """Start to push."""
        self.pushes = (*self.pushes, push)

    def hold(self, key: str, body: int, force: Array, torque: Array) -> None:
        """Push a body at its centre of mass, in world axes, until the same holder says otherwise."""
        self._held[key] = body, force, torque
        self._dirty = True

    def release(self, key: str) -> None:
        """Hold no longer."""
        self._dirty |= self._held.pop(key, None) is not None

    def clear(self, keep: Iterable[Push | JointPush] = ()) -> None:
        """Let go of everything except some pushes."""
        self.pushes = tuple(keep)
        self._held.clear()
        self._dirty = True

    def next_change(self, now_ns: int) -> float:
        """Return when a push next begins or ends."""
        times = (time for push in self.pushes for time in (push.start_ns, push.end_ns))
        return min((time for time in times if time > now_ns), default=math.inf)

    def apply(self, physics: Physics, now_ns: int) -> None:
        """Write the forces of the step to come."""
        if not (self.pushes or self._dirty):
            return
        if self.pushes:
            physics.refresh_positions()
        data = physics.data
        data.xfrc_applied[:] = 0.0
        data.qfrc_applied[:] = 0.0
        for body, force, torque in self._held.values():
            data.xfrc_applied[body, :3] += force
            data.xfrc_applied[body, 3:] += torque
        self.pushes = tuple(push for push in self.pushes if push.end_ns > now_ns)
        for push in self.pushes:
            if push.start_ns <= now_ns:
                self._apply(physics, push)
        self._dirty = bool(self._held or self.pushes)

    def _apply(self, physics: Physics, push: Push | JointPush) -> None:
        instance, data = self._instances[push.model], physics.data
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
