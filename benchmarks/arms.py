"""How many poses a second the closed-form kinematics of arms solves, and how exactly."""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np

from daidalos.industry.motion.kinematics import forward, inverse
from daidalos.industry.robots import ARMS

POSES = 20_000
REPEATS = 30


def run() -> dict[str, float]:
    """Measure everything."""
    rng = np.random.default_rng(1)
    figures: dict[str, float] = {}
    errors = []
    for name, arm in ARMS.items():
        joints = rng.uniform(*arm.limits.T, (POSES, 6))
        poses = forward(arm, joints)
        solutions = inverse(arm, poses)
        found = forward(arm, solutions.joints[solutions.reachable])
        wanted = np.broadcast_to(poses[:, None], (POSES, 8, 4, 4))[solutions.reachable]
        errors.append(float(np.abs(found - wanted).max()))
        figures[f"arms.{name}_inverse_poses_per_s"] = POSES / seconds(lambda arm=arm, poses=poses: inverse(arm, poses))
        figures[f"arms.{name}_forward_poses_per_s"] = POSES / seconds(lambda arm=arm, q=joints: forward(arm, q))
    return figures | {"arms.round_trip_worst_error_m": max(errors)}


def seconds(call: Callable[[], object]) -> float:
    """Return the least time that a call takes."""
    best = float("inf")
    for _ in range(REPEATS):
        begin = time.perf_counter()
        call()
        best = min(best, time.perf_counter() - begin)
    return best
