"""Contacts: a snapshot of all contacts, and a monitor of one model."""

from __future__ import annotations

import copy
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from daidalos.samples.sensors import Contact
from daidalos.simulation.instance import Instance
from daidalos.simulation.physics import Physics

_MINE, _OTHER = 1, 3
"""Numbers of a watched model's geoms and of those that count; no other sum of two is that of both."""


@dataclass(frozen=True)
class Touch:
    """Contact partner of a monitored model.

    Parameters
    ----------
    link : str
        Of the watched model.
    other_model, other_link : str
    first_ns, last_ns : int
        Simulated times at which it was first and last seen.
    """

    link: str
    other_model: str
    other_link: str
    first_ns: int
    last_ns: int


def read_contacts(physics: Physics, wanted: NDArray[np.bool_] | None = None) -> list[Contact]:
    """Return the current contacts, grouped by pairs of collisions.

    Parameters
    ----------
    physics : Physics
    wanted : array (geoms,) of bool or None
        Leave out contacts between two geoms that are not wanted.
    """
    data = _wake_all(physics)
    grouped: dict[tuple[int, int], list[int]] = {}
    pairs = data.contact.geom.reshape(-1, 2)
    rows = range(data.ncon) if wanted is None else np.flatnonzero(wanted[pairs].any(axis=1)).tolist()
    for index in rows:
        pair = data.contact.geom[index]
        grouped.setdefault((int(pair[0]), int(pair[1])), []).append(index)
    return [_contact(physics, data, first, second, rows) for (first, second), rows in grouped.items()]


class ContactMonitor:
    """Recorder of the contacts of a model.

    Parameters
    ----------
    instance : Instance
        The model that is watched.
    ignore : frozenset of str
        Models that do not count.
    """

    def __init__(self, instance: Instance, ignore: frozenset[str]) -> None:
        self.instance = instance
        self._ignore = ignore
        self._touches: dict[tuple[str, str, str], Touch] = {}
        self._passed = b""  # the pairs of the last contacts of which none counts

    @property
    def touches(self) -> tuple[Touch, ...]:
        """Contact partners so far, in the order of first contact."""
        return tuple(self._touches.values())

    def bind(self, physics: Physics) -> None:
        """Update the geoms after a compilation."""
        self._geoms = physics.geoms
        self._passed = b""
        self._sides = np.zeros(physics.model.ngeom, dtype=np.int8)
        for geom, (name, _) in self._geoms.items():
            self._sides[geom] = _MINE if name == self.instance.name else 0 if name in self._ignore else _OTHER

    def record(self, data: Any, now_ns: int) -> None:
        """Record the contacts of the step that was just made."""
        if not data.ncon:
            return
        contact = data.contact
        pairs = contact.geom
        place = pairs.tobytes()
        if place == self._passed:
            return  # as a robot that drives on the ground does for most of its steps
        sides = self._sides[pairs]
        here = sides[:, 0] + sides[:, 1] == _MINE + _OTHER
        if not here.any():
            self._passed = place
            return
        for index in np.flatnonzero(here & (contact.dist < 0)):
            mine, other = (int(geom) for geom in pairs[index])
            if self._sides[mine] != _MINE:
                mine, other = other, mine
            other_model, info = self._geoms[other]
            key = (self._geoms[mine][1].link, other_model, info.link)
            begun = self._touches[key].first_ns if key in self._touches else now_ns
            self._touches[key] = Touch(*key, begun, now_ns)


def _wake_all(physics: Physics) -> Any:
    """Return data with the contacts of sleeping models included, without waking them."""
    model, data = physics.model, physics.data
    if data.ntree_awake == model.ntree:
        physics.refresh()
        return data
    awake = copy.copy(data)
    sleep = int(mujoco.mjtEnableBit.mjENBL_SLEEP)
    model.opt.enableflags &= ~sleep
    try:
        mujoco.mj_forward(model, awake)
    finally:
        model.opt.enableflags |= sleep
    return awake


def _contact(physics: Physics, data: Any, first: int, second: int, rows: list[int]) -> Contact:
    contact = data.contact
    frames = contact.frame[rows].reshape(-1, 3, 3)
    forces = np.zeros((len(rows), 6))
    for place, row in enumerate(rows):
        mujoco.mj_contactForce(physics.model, data, row, forces[place])
    (model1, info1), (model2, info2) = physics.geoms[first], physics.geoms[second]
    return Contact(
        model1=model1,
        link1=info1.link,
        collision1=info1.collision,
        model2=model2,
        link2=info2.link,
        collision2=info2.collision,
        positions=contact.pos[rows].copy(),
        normals=frames[:, 0].copy(),
        forces=np.einsum("kij,ki->kj", frames, forces[:, :3]),
        depths=-contact.dist[rows],
    )
