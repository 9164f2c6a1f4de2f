"""MuJoCo's model and data: steps, and lazy updates of derived quantities."""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping
from typing import Any

import mujoco

from daidalos.simulation.conversion.model_build import GeomInfo
from daidalos.simulation.errors import SimulationError
from daidalos.simulation.forces import Forces
from daidalos.simulation.scenery import MAX_BATCH, Scenery
from daidalos.simulation.stage import Stage

_log = logging.getLogger(__name__)

_DIVERGED = (
    int(mujoco.mjtWarning.mjWARN_BADQPOS),
    int(mujoco.mjtWarning.mjWARN_BADQVEL),
    int(mujoco.mjtWarning.mjWARN_BADQACC),
)


def _note(message: str) -> None:
    """Log a warning of MuJoCo; diverged states raise an error later."""
    _log.log(logging.DEBUG if "unstable" in message else logging.WARNING, message)


# Otherwise MuJoCo writes a file into the user's working directory.
mujoco.set_mju_user_warning(_note)


class Physics:
    """Compiled world.

    Parameters
    ----------
    model, data : MjModel, MjData
    geoms : mapping
        Place of each geom to the name of its model and what it stands for.
    has_subscribers : callable
        Returns whether anyone listens to a topic.
    stage : Stage
        What cameras see.
    forces : Forces
        What pushes from outside.
    can_draw : callable
        Returns whether there is time for a camera's picture; takes the camera's topic and the time [ns].
    """

    def __init__(
        self,
        model: Any,
        data: Any,
        geoms: Mapping[int, tuple[str, GeomInfo]],
        has_subscribers: Callable[[str], bool],
        stage: Stage,
        forces: Forces,
        can_draw: Callable[[str, int], bool],
    ) -> None:
        self.model = model
        self.data = data
        self.geoms = geoms
        self.has_subscribers = has_subscribers
        self.stage = stage
        self.forces = forces
        self.can_draw = can_draw
        self._warnings = data.warning.number  # a view
        self._bodies: dict[str, int] = {}
        self._make_stale()
        self.refresh_positions()
        scenery = Scenery(model, data)
        self._scenery = scenery if scenery.is_large else None

    def step(self, count: int) -> None:
        """Run steps in one call.

        Raises
        ------
        SimulationError
            When they gave numbers that are none; names the body that was first.
        """
        if self._scenery is None:
            mujoco.mj_step(self.model, self.data, count)
        else:
            self._step_near(self._scenery, count)
        self._make_stale()
        counts = self._warnings.tolist()
        for kind in _DIVERGED:
            if counts[kind]:
                dof = min(max(int(self.data.warning[kind].lastinfo), 0), self.model.nv - 1)
                body = self.model.body(self.model.dof_bodyid[dof]).name
                raise SimulationError(
                    f"the physics diverged at {self.data.time:.3f} s, first in {body}; "
                    "look at its inertia, limits and gains"
                )

    def _step_near(self, scenery: Scenery, count: int) -> None:
        """Run steps without the static bodies that nothing is near."""
        most = max(1, int(MAX_BATCH / self.model.opt.timestep))
        while count > 0:
            self._update(scenery)
            part = min(count, most)
            mujoco.mj_step(self.model, self.data, part)
            count -= part

    def _update(self, scenery: Scenery) -> None:
        if scenery.is_forgotten:
            self.refresh_positions()
        scenery.update(self.data)

    def wake(self) -> None:
        """Wake all sleeping bodies by setting a velocity."""
        asleep = self.data.tree_asleep >= 0
        self.data.qvel[asleep[self.model.dof_treeid]] = 1e-9

    def changed(self) -> None:
        """Mark everything derived from the state as out of date, after a change from outside."""
        self._make_stale()
        if self._scenery is not None:
            self._scenery.forget()

    def _make_stale(self) -> None:
        self._positions_fresh = self._velocities_fresh = self._all_fresh = self._loads_fresh = False

    def refresh_positions(self) -> None:
        """Update the poses of bodies and geoms."""
        if not self._positions_fresh:
            mujoco.mj_kinematics(self.model, self.data)
            mujoco.mj_comPos(self.model, self.data)
            self._positions_fresh = True

    def refresh_contacts(self) -> None:
        """Update the poses of bodies and geoms, and the contacts without their forces."""
        self.refresh_positions()
        if self._scenery is not None:
            self._scenery.update(self.data)
        mujoco.mj_collision(self.model, self.data)

    def refresh_velocities(self) -> None:
        """Update the poses and velocities of bodies."""
        if not self._velocities_fresh:
            self.refresh_positions()
            mujoco.mj_comVel(self.model, self.data)
            self._velocities_fresh = True

    def refresh(self) -> None:
        """Update everything: velocities, accelerations, contacts and their forces."""
        if not self._all_fresh:
            if self._scenery is not None:
                self._update(self._scenery)
            mujoco.mj_forward(self.model, self.data)
            self._positions_fresh = self._velocities_fresh = self._all_fresh = True

    def refresh_loads(self) -> None:
        """Update everything, with the accelerations of bodies and the forces between them, once for all sensors."""
        if not self._loads_fresh:
            self.refresh()
            mujoco.mj_rnePostConstraint(self.model, self.data)
            self._loads_fresh = True

    def body(self, name: str) -> int:
        """Return the number of a body."""
        number = self._bodies.get(name)
        if number is None:
            number = self._bodies[name] = int(self.model.body(name).id)
        return number
