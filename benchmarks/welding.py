"""How fast and how exactly paths of compliant arms are corrected, and how straight the simulated welds are."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np

import daidalos
from daidalos.industry.elasticity.deflection import Options
from daidalos.industry.elasticity.elasticity_file import read_elasticity
from daidalos.industry.robots import ARMS
from daidalos.industry.welding.comparison import within_tolerance
from daidalos.industry.welding.correction import Cell, correct
from daidalos.industry.welding.experiments import SPEED, WRENCH, run_experiment
from daidalos.industry.welding.nine_zones import nine_zone_curve, straight_line
from daidalos.industry.welding.seam import resampled, tool_poses
from daidalos.industry.welding.simulated_cell import drawn

POINTS = 1000
REPEATS = 5
FILE = Path(daidalos.__file__).parent / "share/kr500_2mt_description/config/elasticity.yaml"


def run() -> dict[str, float]:
    """Measure everything."""
    elasticity = read_elasticity(FILE, "kr500_2mt").with_tool(120.0)
    tool = np.eye(4)
    tool[2, 3] = 0.8
    cell = Cell(ARMS["kr500_2mt"], elasticity, tool, Options(gravity=True, friction=True))
    poses = tool_poses(resampled(nine_zone_curve(), POINTS))
    wrenches = np.tile(WRENCH, (POINTS, 1))
    best = float("inf")
    for _ in range(REPEATS):
        begin = time.perf_counter()
        done = correct(cell, poses, wrenches, SPEED)
        best = min(best, time.perf_counter() - begin)
    taught = Cell(cell.arm, elasticity, tool, Options(friction=True))
    truth = drawn(elasticity, 0)
    line = run_experiment(taught, truth, straight_line()).welds
    curve = run_experiment(taught, truth, nine_zone_curve()).welds
    return {
        "welding.correct_1000_points_s": best,
        "welding.convergence_m": done.convergence[-1][0],
        "welding.iterations": len(done.convergence),
        "welding.line_uncorrected_across_rms_mm": 1e3 * float(line["uncorrected"].rms[1]),
        "welding.line_uncorrected_along_tool_rms_mm": 1e3 * float(line["uncorrected"].rms[2]),
        "welding.line_corrected_across_rms_mm": 1e3 * float(line["corrected"].rms[1]),
        "welding.curve_within_half_a_millimetre_percent": 100.0 * within_tolerance(curve["corrected"]),
        "welding.curve_without_backlash_within_percent": 100.0 * within_tolerance(curve["without_backlash"]),
    }
