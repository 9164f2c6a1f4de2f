"""How many poses a second the closed-form kinematics of arms solves, and how exactly."""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np

from daidalos.industry.motion.kinematics import forward, inverse
from daidalos.industry.motion.redundant_kinematics import forward_of, inverse_of
from daidalos.industry.robots import ARMS
from daidalos.industry.robots.yumi import YUMI_ARM

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
    return figures | redundant() | {"arms.round_trip_worst_error_m": max(errors)}


def redundant() -> dict[str, float]:
    """Measure the numeric inverse of YuMi's arm, from angles 3 degrees away and from anywhere."""
    rng = np.random.default_rng(1)
    joints = rng.uniform(*YUMI_ARM.limits.T, (500, 7))
    poses, arm_angles = forward_of(YUMI_ARM, joints)
    near = joints + rng.normal(0.0, 0.05, joints.shape)
    found = inverse_of(YUMI_ARM, poses, arm_angles)
    return {
        "arms.irb14000_inverse_nearby_poses_per_s": 500
        / seconds(lambda: inverse_of(YUMI_ARM, poses, arm_angles, near), 3),
        "arms.irb14000_inverse_poses_per_s": 500 / seconds(lambda: inverse_of(YUMI_ARM, poses, arm_angles), 3),
        "arms.irb14000_inverse_found_percent": 100.0 * float(np.isfinite(found).all(axis=1).mean()),
    }


def seconds(call: Callable[[], object], repeats: int = REPEATS) -> float:
    """Return the least time that a call takes."""
    best = float("inf")
    for _ in range(repeats):
        begin = time.perf_counter()
        call()
        best = min(best, time.perf_counter() - begin)
    return best
