"""External forces: timed pushes, and forces held by plugins."""

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
    """Force on a link for a time.

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
    """Effort [N m, N] on a joint for a time."""

    model: str
    joint: str
    effort: float
    start_ns: float = 0.0
    end_ns: float = math.inf


@dataclass
class Forces:
    """All external forces, and their indices in the arrays.

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
        """Update the models after a compilation; plugins set their forces again at their next update."""
        self._instances = instances
        self._held.clear()
        self.pushes = tuple(push for push in self.pushes if push.model in instances)
        self._dirty = True

    def add(self, push: Push | JointPush) -> None:
        """Add a push."""
        self.pushes = (*self.pushes, push)

    def hold(self, key: str, body: int, force: Array, torque: Array) -> None:
        """Set the force of a holder on a body's centre of mass, in world axes, until its next call."""
        self._held[key] = body, force, torque
        self._dirty = True

    def release(self, key: str) -> None:
        """Remove the force of a holder."""
        self._dirty |= self._held.pop(key, None) is not None

    def clear(self, keep: Iterable[Push | JointPush] = ()) -> None:
        """Remove all forces except some pushes."""
        self.pushes = tuple(keep)
        self._held.clear()
        self._dirty = True

    def next_change(self, now_ns: int) -> float:
        """Return the time at which the next push starts or ends."""
        times = (time for push in self.pushes for time in (push.start_ns, push.end_ns))
        return min((time for time in times if time > now_ns), default=math.inf)

    def apply(self, physics: Physics, now_ns: int) -> None:
        """Write the forces of the next step."""
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
