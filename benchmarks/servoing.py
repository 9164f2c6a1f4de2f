"""How exactly seams are followed through RSI, and what a profile's evaluation and a cycle of the loop cost."""

from __future__ import annotations

import time

import numpy as np

from daidalos.industry.rsi.configuration import read_configuration
from daidalos.industry.servoing.butt_joint import SEAMS, ButtJoint
from daidalos.industry.servoing.evaluation import evaluate
from daidalos.industry.servoing.experiments import run_in_cell
from daidalos.industry.servoing.profile_sensor import ProfileSensor
from daidalos.interfaces.library import BUILT_IN

PROFILES = 500


def run() -> dict[str, float]:
    """Measure everything."""
    sensor = ProfileSensor(ButtJoint(SEAMS["curve"]))
    profiles = [sensor.measure(0.06e-3 * number, 0.0) for number in range(PROFILES)]
    durations = []
    for heights in profiles:
        begin = time.perf_counter()
        evaluate(heights)
        durations.append(time.perf_counter() - begin)
    out = {"servoing.profile_evaluation_ms": 1e3 * float(np.median(durations))}
    configuration = read_configuration(BUILT_IN / "kr500_2mt_description/config/rsi/seam_servo.xml")
    for seam, controllers in (
        ("line", ("proportional", "lead", "feedforward")),
        ("curve", ("proportional", "lead", "feedforward", "lqg", "mpc")),
        ("long", ("feedforward",)),
    ):
        for controller in controllers:
            figures = run_in_cell(SEAMS[seam], controller, configuration).figures()
            name = f"servoing.{seam}_{controller}"
            out[f"{name}_std_mm"] = figures["std_mm"]
            out[f"{name}_residual_mm"] = figures["residual_mm"]
            out[f"{name}_computing_ms"] = figures["computing_ms"]
            if seam == "long":
                out[f"{name}_worst_100_mm_std_mm"] = figures["worst_piece_std_mm"]
    return out
