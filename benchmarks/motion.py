"""How near planned motion is to a fine numerical reference, and how much faster than real time it is computed."""

from __future__ import annotations

import itertools
import math
import sys
import time

import numpy as np
from scipy.spatial import cKDTree

from benchmarks.motion_reference import STEP, Array, polyline_with_parabolas, solve
from daidalos.industry.motion.branches import joints_at
from daidalos.industry.motion.corners import Zone
from daidalos.industry.motion.curves import Line
from daidalos.industry.motion.kinematics import forward
from daidalos.industry.motion.pieces import Limits
from daidalos.industry.motion.planner import Movement, Planner
from daidalos.industry.robots import ARMS

ARM = ARMS["irb120"]
DOWN = np.array([0.0, 1.0, 0.0, 0.0])
CORNERS = [
    np.array(one)
    for one in ([0.35, -0.1, 0.3], [0.35, 0.1, 0.3], [0.42, 0.13, 0.3], [0.45, 0.02, 0.35], [0.4, -0.1, 0.3])
]
CASES = [(0.05, 0.001), (0.1, 0.005), (0.2, 0.01), (0.5, 0.02), (1.0, 0.05)]
REPEATS = 5
PATH_STEP = 0.02e-3


def run() -> dict[str, float]:
    """Measure everything."""
    times, gaps, ratios = [], [], []
    rotation = np.diag([-1.0, 1.0, -1.0])
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = rotation, CORNERS[0]
    start = joints_at(ARM, pose, None, np.radians([0.0, 0.0, 0.0, 0.0, 60.0, 0.0]))
    for speed, zone in CASES:
        planner, seconds = plan(start, speed, zone)
        reference = solve(ARM, polyline_with_parabolas(CORNERS, zone, STEP), rotation, start, speed)
        duration = planner.remaining()
        times.append(abs(duration / reference.time - 1.0))
        tcp = forward(ARM, planner.joints_at(np.linspace(0.0, duration, 4001)))[:, :3, 3]
        fine = polyline_with_parabolas(CORNERS, zone, PATH_STEP)
        gaps.append(float(cKDTree(fine).query(tcp)[0].max()))
        ratios.append(duration / seconds)
        print(
            f"  v{1e3 * speed:g} z{1e3 * zone:g}: {duration:.4f} s, reference {reference.time:.4f} s", file=sys.stderr
        )
    return {
        "motion.time_worst_error_percent": 100.0 * max(times),
        "motion.path_worst_error_mm": 1e3 * max(gaps),
        "motion.times_real_time": sum(ratios) / len(ratios),
    }


def plan(start: Array, speed: float, zone: float) -> tuple[Planner, float]:
    """Return a planner with the movements, and the least time that planning takes [s]."""
    best = math.inf
    for _ in range(REPEATS):
        begin = time.perf_counter()
        planner = Planner(ARM, start)
        for n, (a, b) in enumerate(itertools.pairwise(CORNERS)):
            is_last = n == len(CORNERS) - 2
            corner = None if is_last else Zone(zone, 1.5 * zone, math.radians(150.0 * zone))
            assert planner.append(Movement(Line(a, b, DOWN, DOWN), Limits(speed=speed), corner, np.eye(4)))
        planner.remaining()
        best = min(best, time.perf_counter() - begin)
    return planner, best
