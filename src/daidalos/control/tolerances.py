"""Tolerances of joints along trajectories."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from daidalos.common.arrays import Array
from daidalos.samples.controllers import JointTolerance


@dataclass(frozen=True, eq=False)
class Tolerances:
    """Maximum errors of n joints, each (n,); infinite for no limit."""

    position: Array
    velocity: Array
    acceleration: Array

    @classmethod
    def of(cls, position: Sequence[float], velocity: float = 0.0) -> Tolerances:
        """Return the tolerances of parameters, where 0 is no limit."""
        count = len(position)
        return cls(
            np.array([one if one > 0.0 else math.inf for one in position]),
            np.full(count, velocity if velocity > 0.0 else math.inf),
            np.full(count, math.inf),
        )

    def changed(self, joints: Sequence[str], by_joint: Mapping[str, JointTolerance]) -> Tolerances:
        """Return the tolerances changed by a goal: 0 keeps a tolerance, a negative value removes it."""
        columns = {}
        for kind in ("position", "velocity", "acceleration"):
            column = getattr(self, kind).copy()
            for place, joint in enumerate(joints):
                value = getattr(by_joint.get(joint, JointTolerance()), kind)
                if value != 0.0:
                    column[place] = value if value > 0.0 else math.inf
            columns[kind] = column
        return Tolerances(**columns)

    def violation(self, joints: Sequence[str], position: Array, velocity: Array, acceleration: Array) -> str:
        """Return the joint whose error is too large, or an empty string; errors of NaN are ignored."""
        for kind, error, largest, unit in (
            ("position", position, self.position, ""),
            ("velocity", velocity, self.velocity, "/s"),
            ("acceleration", acceleration, self.acceleration, "/s^2"),
        ):
            too_large = np.abs(error) > largest
            if too_large.any():
                place = int(np.argmax(too_large))
                return (
                    f"{kind} of joint '{joints[place]}' is off by {abs(error[place]):.4g}{unit}, "
                    f"allowed is {largest[place]:.4g}"
                )
        return ""
