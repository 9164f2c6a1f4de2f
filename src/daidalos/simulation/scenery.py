"""Static bodies in collision detection: only those near bodies that move take part."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array

MARGIN = 0.5
"""Distance [m] between two shapes below which the static one takes part."""

MAX_BATCH = 0.01
"""Simulated time [s] for which the bodies that take part stay the same at most."""

MAX_SPEED = 0.5 * MARGIN / MAX_BATCH
"""Speed [m/s] up to which a body that is as far as the margin is noticed before it touches."""

MIN_BODIES = 4
"""Number of static bodies from which on the search costs less than it saves."""


class Scenery:
    """Filter of a compiled world's static bodies.

    MuJoCo's broad phase sorts all bodies at each step, among which those of a room that are far from any robot. Leaving
    them out does not change contacts, as they have none. Bodies with an infinite shape always take part, and all do
    while something is faster than `MAX_SPEED`.

    Parameters
    ----------
    model : MjModel
        Whose ``body_contype`` and ``body_conaffinity`` it changes.
    data : MjData
        With fresh positions.
    """

    def __init__(self, model: Any, data: Any) -> None:
        self._model = model
        is_static = (model.body_weldid == 0) & (model.body_mocapid[model.body_rootid] < 0)
        collides = (model.geom_contype | model.geom_conaffinity) != 0
        of_static = is_static[model.geom_bodyid]
        infinite = np.unique(model.geom_bodyid[collides & (model.geom_rbound <= 0)])
        is_candidate = is_static & ~np.isin(np.arange(model.nbody), infinite)
        geoms = np.flatnonzero(collides & is_candidate[model.geom_bodyid])
        self._bodies, self._rows = np.unique(model.geom_bodyid[geoms], return_inverse=True)
        self._masks = model.body_contype[self._bodies].copy(), model.body_conaffinity[self._bodies].copy()
        self._moving = np.flatnonzero(collides & ~of_static)
        self._reach = model.geom_rbound[self._moving] + MARGIN + 2.0 * float(model.geom_margin.max(initial=0.0))
        self._centres, self._halves = _boxes(model, data, geoms)
        self._places: Array | None = None
        self._is_recent = False

    @property
    def is_large(self) -> bool:
        """Whether there are so many static bodies that the filter saves time."""
        return len(self._bodies) >= MIN_BODIES and len(self._moving) > 0

    def forget(self) -> None:
        """Handle that bodies were moved from outside, or their velocities set."""
        self._places = None

    @property
    def is_forgotten(self) -> bool:
        """Whether positions have to be fresh for the next `update`."""
        return self._places is None

    def update(self, data: Any) -> None:
        """Choose the bodies that take part in the steps of the next `MAX_BATCH` at most."""
        places = data.geom_xpos[self._moving]
        if self._places is None:
            is_fast = bool(np.abs(data.qvel).max(initial=0.0) > MAX_SPEED)
        else:
            if np.abs(places - self._places).max() < 0.25 * MARGIN:  # along one axis
                self._is_recent = False
                return
            is_fast = self._is_recent
        self._choose(np.ones(len(self._bodies), dtype=bool) if is_fast else self._near(places))
        self._places, self._is_recent = places, True

    def _choose(self, taking_part: NDArray[np.bool_]) -> None:
        """Set the masks of the static bodies."""
        contype, conaffinity = self._masks
        self._model.body_contype[self._bodies] = np.where(taking_part, contype, 0)
        self._model.body_conaffinity[self._bodies] = np.where(taking_part, conaffinity, 0)

    def _near(self, places: Array) -> NDArray[np.bool_]:
        """Return which of the bodies have a shape within the margin of a moving one's bounding sphere."""
        outside = np.maximum(np.abs(places[:, None] - self._centres) - self._halves, 0.0)
        near = (np.square(outside).sum(axis=2) <= np.square(self._reach)[:, None]).any(axis=0)
        return np.bincount(self._rows[near], minlength=len(self._bodies)) > 0


def _boxes(model: Any, data: Any, geoms: NDArray[np.intp]) -> tuple[Array, Array]:
    """Return the centres (n, 3) and half sizes (n, 3) [m] of geoms' bounding boxes along the world's axes."""
    rotations = data.geom_xmat[geoms].reshape(-1, 3, 3)
    boxes = model.geom_aabb[geoms].reshape(-1, 6)
    centres = data.geom_xpos[geoms] + np.einsum("nij,nj->ni", rotations, boxes[:, :3])
    return centres, np.einsum("nij,nj->ni", np.abs(rotations), boxes[:, 3:])
