"""How near force controllers keep the force, how evenly a disc grinds, and how fast the height field is."""

from __future__ import annotations

import time

import numpy as np

from daidalos.industry.grinding.force_control import ForceController
from daidalos.industry.grinding.height_field import deviation
from daidalos.industry.grinding.records import force_figures
from daidalos.industry.grinding.settings import CellParameters
from daidalos.industry.grinding.tasks import clamp_job, force_test, make_controller, plate_job
from daidalos.industry.grinding.workpieces import clamp, plate

CONTROLLERS = ("pi", "integral", "impedance", "admittance")
SEEDS = (0, 1)
DEPTH = 50e-6
ROBOT = "irb8700"


def run() -> dict[str, float]:
    """Measure everything; the field has 0.25 mm over 300 x 300 mm, and its time is that of the processor."""
    parameters = CellParameters()
    force_test(parameters, make_controller("pi", {}, parameters), resolution=2e-3)  # compiles the kernels
    found: dict[str, float] = {}
    for name in CONTROLLERS:
        all_figures = [
            force_figures(force_test(parameters, make_controller(name, {}, parameters), seed)[0]) for seed in SEEDS
        ]
        found[f"grinding.{name}_steady_error_n"] = max(one.steady_error for one in all_figures)
        found[f"grinding.{name}_moving_rms_n"] = max(one.moving_rms for one in all_figures)
        found[f"grinding.{name}_overshoot_percent"] = 100.0 * max(one.overshoot for one in all_figures)
    position = make_controller("position", {}, parameters)
    record, _ = force_test(parameters, position, SEEDS[0], is_supervised=False)
    found["grinding.position_moving_rms_n"] = force_figures(record).moving_rms

    def make() -> ForceController:
        return make_controller("pi", {}, parameters)

    begin = time.process_time()
    even = plate_job(plate(depth=DEPTH), parameters, make, 30.0, DEPTH, 0.012).run(ROBOT)
    taken = time.process_time() - begin
    found["grinding.plate_times_real_time"] = float(even.passes[0].record.time[-1]) / taken
    removed = np.quantile(even.depth_removed[even.begin.region], [0.005, 0.995])
    found["grinding.plate_removal_error_percent"] = 100.0 * float(np.abs(removed / DEPTH - 1.0).max())
    begin = time.process_time()
    ready = clamp_job(clamp(), parameters, make, 30.0, 100e-6).run(ROBOT)
    taken = time.process_time() - begin
    found["grinding.clamp_times_real_time"] = sum(float(one.record.time[-1]) for one in ready.passes) / taken
    found["grinding.clamp_passes"] = len(ready.passes)
    found["grinding.clamp_within_100_um_percent"] = 100.0 * deviation(ready.end, ready.tolerance).within
    large = [one for one in ready.passes if one.predicted > 1e-7]
    found["grinding.clamp_removal_error_percent"] = max(100.0 * abs(one.removed / one.predicted - 1.0) for one in large)
    return found
