"""External forces: timed pushes, and forces held by plugins."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable
from dataclasses import dataclass, field

from daidalos.common.arrays import Array
from daidalos.common.pose3 import Vector


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
    """All external forces; `daidalos.simulation.applied_forces` writes them into MuJoCo's arrays.

    Attributes
    ----------
    pushes : tuple of Push or JointPush
        Those that last for a time; replaced as a whole, so that a saved state can keep them.
    held : dict
        Body, force and torque on its centre of mass in world axes, by holder.
    is_dirty : bool
        Whether the arrays have to be written before the next step.
    """

    pushes: tuple[Push | JointPush, ...] = ()
    held: dict[str, tuple[int, Array, Array]] = field(default_factory=dict)
    is_dirty: bool = False

    def bind(self, models: Collection[str]) -> None:
        """Drop the forces on removed models; plugins set their forces again at their next update."""
        self.held.clear()
        self.pushes = tuple(push for push in self.pushes if push.model in models)
        self.is_dirty = True

    def add(self, push: Push | JointPush) -> None:
        """Add a push."""
        self.pushes = (*self.pushes, push)

    def hold(self, key: str, body: int, force: Array, torque: Array) -> None:
        """Set the force of a holder on a body's centre of mass, in world axes, until its next call."""
        self.held[key] = body, force, torque
        self.is_dirty = True

    def release(self, key: str) -> None:
        """Remove the force of a holder."""
        self.is_dirty |= self.held.pop(key, None) is not None

    def clear(self, keep: Iterable[Push | JointPush] = ()) -> None:
        """Remove all forces except some pushes."""
        self.pushes = tuple(keep)
        self.held.clear()
        self.is_dirty = True

    def next_change(self, now_ns: int) -> float:
        """Return the time at which the next push starts or ends."""
        times = (time for push in self.pushes for time in (push.start_ns, push.end_ns))
        return min((time for time in times if time > now_ns), default=math.inf)
