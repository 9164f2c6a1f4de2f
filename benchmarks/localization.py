"""How true, how sure and how fast AMCL is: tracking, global localization and kidnapping in the tests' arena."""

from __future__ import annotations

import math
import os
import statistics
import sys
import time
from pathlib import Path

import numpy as np

from daidalos.common.kernels import warm_up
from daidalos.common.pose2 import wrap
from daidalos.localization.amcl import Amcl
from daidalos.localization.config import LASER_MODELS, AmclConfig

sys.path.insert(0, str(Path(__file__).parents[1]))
from tests.localization.wandering import Wanderer, map_of
from tests.navigation.closed_loop import free_pose
from tests.navigation.flat_world import FlatRobot, arena

WORLD = arena()
MAP = map_of(WORLD, 8.0, 6.0)
START = np.array([1.5, 1.5, 0.3])
NEAR = np.diag([0.1, 0.1, 0.05])
TRIALS = int(os.environ.get("DAIDALOS_BENCHMARK_TRIALS", "100"))
FOUND = 0.3
"""Distance [m] from the truth up to which a robot counts as found."""


def run() -> dict[str, float | str]:
    """Measure everything; times are medians of CPU time."""
    warm_up("daidalos.localization")
    results: dict[str, float | str] = {}
    for model in LASER_MODELS:
        results |= measure_tracking(model)
    results["localization.global_found"] = statistics.mean(is_found(seed) for seed in range(TRIALS))
    results["localization.kidnapped_found"] = statistics.mean(is_found_again(seed) for seed in range(TRIALS))
    return results


def measure_tracking(model: str) -> dict[str, float | str]:
    """Errors at every scan while a robot with drifting odometry wanders, with 2000 particles and 60 beams."""
    filter_ = Amcl(AmclConfig(laser_model_type=model, min_particles=2000), MAP, seed=1)
    filter_.initialize(START, NEAR)
    wanderer = Wanderer(FlatRobot(WORLD, START.copy(), beams=180, max_range=12.0, seed=1), 1)
    times, errors = [], []
    for _ in range(400):
        odometry, scan, truth = wanderer.step()
        begun = time.process_time()
        estimate = filter_.update(odometry, scan)
        if estimate.updated:
            times.append(time.process_time() - begun)
        errors.append(error_of(estimate.pose, truth))
    mean = np.mean(errors[50:], axis=0)
    return {
        f"localization.{model}_update_ms": 1e3 * statistics.median(times),
        f"localization.{model}_error_m": float(mean[0]),
        f"localization.{model}_error_deg": math.degrees(float(mean[1])),
    }


def error_of(pose: np.ndarray, truth: np.ndarray) -> tuple[float, float]:
    """Return the errors of position [m] and heading [rad]."""
    return math.hypot(*(pose - truth)[:2]), abs(float(wrap(pose[2] - truth[2])))


def is_found(seed: int) -> bool:
    """Return whether a robot anywhere in the arena is found, and stays so, within 80 s of wandering."""
    filter_ = Amcl(AmclConfig(), MAP, seed)
    filter_.global_localization()
    return _wander(filter_, _wanderer(seed), 400) < FOUND


def is_found_again(seed: int) -> bool:
    """Return whether a robot that was carried elsewhere is found within 120 s of wandering."""
    wanderer = _wanderer(seed)
    filter_ = Amcl(AmclConfig(), MAP, seed)
    filter_.initialize(wanderer.robot.pose, NEAR)
    _wander(filter_, wanderer, 150)
    wanderer.carry(free_pose(WORLD, np.random.default_rng(1000 + seed)))
    return _wander(filter_, wanderer, 600) < FOUND


def _wanderer(seed: int) -> Wanderer:
    pose = np.array(free_pose(WORLD, np.random.default_rng(seed)), dtype=float)
    return Wanderer(FlatRobot(WORLD, pose, beams=180, max_range=12.0, seed=seed), seed)


def _wander(filter_: Amcl, wanderer: Wanderer, steps: int) -> float:
    """Return the error of the position [m] after so many steps of 0.2 s."""
    for _ in range(steps):
        odometry, scan, truth = wanderer.step()
        error = error_of(filter_.update(odometry, scan).pose, truth)[0]
    return error
