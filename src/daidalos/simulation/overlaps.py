"""Gentle separation of models that are placed inside others.

A contact pushes what is deep inside something else out at its depth over the time constant of contacts: a robot that is
spawned 10 cm inside another one would leave at 25 m/s and more.
"""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

import mujoco
import numpy as np

from daidalos.simulation.physics import Physics

SPEED = 0.5
"""Ratio of penetration to time constant [m/s] of softened contacts; things separate at less than that."""

DEEP = 5e-3
"""Penetration [m] from which contacts are softened; no load brings a contact this far."""

PERIOD_NS = 10_000_000
"""How often the contacts are looked at while some are softened."""

_PRIORITY = 1_000_000
"""Priority of softened geoms: their own time constant counts, whatever they touch."""


class Overlaps:
    """Geoms whose contacts are softened because they are deep inside others.

    It is empty for nearly all of a simulation.
    """

    def __init__(self) -> None:
        self._model: Any = None
        self._kept: dict[int, tuple[int, float]] = {}

    def __bool__(self) -> bool:
        return bool(self._kept)

    def soften(self, physics: Physics, geoms: Collection[int]) -> None:
        """Soften the contacts of those of a placed model's geoms that are deep inside other things."""
        geoms = {*geoms, *self._renewed(physics)}
        for geom, depth in _depths(physics).items():
            if geom in geoms and depth > DEEP:
                model = physics.model
                self._kept.setdefault(geom, (int(model.geom_priority[geom]), float(model.geom_solref[geom, 0])))
                model.geom_priority[geom] = _PRIORITY
                model.geom_solref[geom, 0] = depth / SPEED

    def update(self, physics: Physics) -> None:
        """Stiffen the softened geoms as they come free, and restore those that are."""
        if physics.model is not self._model:
            self.soften(physics, ())
        depths = _depths(physics)
        for geom, (priority, time_constant) in list(self._kept.items()):
            depth = depths.get(geom, 0.0)
            if depth > DEEP:
                physics.model.geom_solref[geom, 0] = max(depth / SPEED, time_constant)
            else:
                del self._kept[geom]
                physics.model.geom_priority[geom] = priority
                physics.model.geom_solref[geom, 0] = time_constant

    def _renewed(self, physics: Physics) -> list[int]:
        """Return the softened geoms of a model that was compiled anew since, in which they have their own values."""
        if physics.model is self._model:
            return []
        names = [self._model.geom(geom).name for geom in self._kept]
        self._model, self._kept = physics.model, {}
        return [
            geom for name in names if (geom := mujoco.mj_name2id(physics.model, mujoco.mjtObj.mjOBJ_GEOM, name)) >= 0
        ]


def _depths(physics: Physics) -> dict[int, float]:
    """Return the deepest penetration [m] of each geom that touches something."""
    physics.refresh()
    contacts = physics.data.contact
    depths: dict[int, float] = {}
    for geom, depth in zip(np.ravel(contacts.geom), np.repeat(-contacts.dist, 2), strict=True):
        depths[int(geom)] = max(float(depth), depths.get(int(geom), 0.0))
    return depths
