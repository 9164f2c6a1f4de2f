"""Attachment of one link to another by a weld that is made and released while the world runs."""

from __future__ import annotations

import mujoco

from daidalos.common.pose3 import Pose
from daidalos.simulation.conversion.model_build import ModelBuild
from daidalos.simulation.instance import Instance
from daidalos.simulation.physics import Physics


class Weld:
    """Constraint that keeps a link in its place in another one.

    It is part of the compiled model from the start, inactive, and gets its second link when it is made.

    Parameters
    ----------
    build : ModelBuild
        Of the model that holds.
    link : str
        Which holds.
    key : str
        Distinguishes the welds of a link.
    """

    def __init__(self, build: ModelBuild, link: str, key: str) -> None:
        self._name = build.add_weld(link, key)

    def bind(self, instance: Instance) -> None:
        """Find the constraint in the compiled model, and release it."""
        self._physics: Physics = instance.physics
        self._id = mujoco.mj_name2id(self._physics.model, mujoco.mjtObj.mjOBJ_EQUALITY, self._name)
        self.release()

    def hold(self, body: int, place: Pose) -> None:
        """Hold a body (its place in MuJoCo's arrays) at a pose in the holding link."""
        model, data = self._physics.model, self._physics.data
        if data.eq_active[self._id] and model.eq_obj2id[self._id] == body:
            return
        x, y, z, w = place.orientation
        model.eq_obj2id[self._id] = body
        # Anchor in the second body, pose of the second body in the first, and weight of rotations.
        model.eq_data[self._id, :11] = (0.0, 0.0, 0.0, *place.position, w, x, y, z, 1.0)
        data.eq_active[self._id] = 1
        self._physics.wake()

    def release(self) -> None:
        """Release what is held, if anything."""
        if self._physics.data.eq_active[self._id]:
            self._physics.data.eq_active[self._id] = 0
            self._physics.wake()
