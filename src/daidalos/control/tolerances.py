"""Tolerances of joints along trajectories."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.samples.controllers import JointTolerance

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Tolerances:
    """Largest errors of n joints, each (n,); infinite where anything goes."""

    position: Array
    velocity: Array
    acceleration: Array

    @classmethod
    def of(cls, position: Sequence[float], velocity: float = 0.0) -> Tolerances:
        """Return tolerances as parameters give them, where 0 is none."""
        count = len(position)
        return cls(
            np.array([one if one > 0.0 else math.inf for one in position]),
            np.full(count, velocity if velocity > 0.0 else math.inf),
            np.full(count, math.inf),
        )

    def changed(self, joints: Sequence[str], by_joint: Mapping[str, JointTolerance]) -> Tolerances:
        """Return them with those that a goal gives: 0 leaves a tolerance as it is, a negative one lifts it."""
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
        """Return which joint's error is too large, nothing when none is; errors that are NaN are not known."""
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
