"""Reports of grinding, each one HTML page."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from daidalos.industry.grinding.height_field import deviation
from daidalos.industry.grinding.pictures import deviation_picture
from daidalos.industry.grinding.records import ForceFigures, Record
from daidalos.industry.grinding.tasks import Job, job_figures
from daidalos.industry.welding.charts import line_chart, page, table

GOALS = {"steady_error_n": "<= 1 N", "moving_rms_n": "<= 3 N", "overshoot_percent": "<= 10 %"}


def force_report(records: Mapping[str, Record], figures: Mapping[str, ForceFigures]) -> str:
    """Return the page of force tests by controller."""
    names = list(next(iter(figures.values())).as_json())
    rows = [[name, GOALS.get(name, ""), *(one.as_json()[name] for one in figures.values())] for name in names]
    parts = [table(["figure", "goal", *figures], rows)]
    for name, record in records.items():
        parts += [f"<h2>{name}</h2>", *_charts(record)]
    return page("Force control of grinding", parts)


def job_report(job: Job) -> str:
    """Return the page of a job: maps of the deviation, figures of the passes, forces and positions."""
    figures: dict[str, Any] = job_figures(job)
    span = max(2.0 * job.tolerance, 1e-6)
    wide = max(abs(deviation(job.begin, job.tolerance).high), span)
    parts = [
        f"<p>{job.problem or 'The workpiece is within its tolerance.'}</p>",
        deviation_picture(job.begin.excess, job.begin.region, wide, "before"),
        deviation_picture(job.end.excess, job.end.region, span, "after"),
    ]
    head = ["pass", "lines", "time [s]", "predicted [mm3]", "removed [mm3]", "mean [um]", "std [um]", "within [%]"]
    rows = [
        [one["pass"], one["lines"], one["time_s"], one["predicted_mm3"], one["removed_mm3"],
         *(one["deviation"][name] for name in ("mean_um", "std_um", "within_percent"))]
        for one in figures["passes"]
    ]  # fmt: skip
    parts += ["<h2>Passes</h2>", table(head, rows)]
    for number, one in enumerate(job.passes, 1):
        parts += [f"<h2>Pass {number}</h2>", *([f"<p>{one.problem}</p>"] if one.problem else []), *_charts(one.record)]
    return page(f"Grinding: {job.title}", parts)


def _charts(record: Record) -> list[str]:
    """Return charts of force, cylinder, spindle and removal over time."""
    record = record.thinned(4000)
    if len(record.time) < 2:
        return []
    lines = {"wanted": record.wanted, "force": record.smooth_force}
    charts = [line_chart("Force on the workpiece", record.time, lines, "time [s]", "force [N]")]
    places = {"cylinder": 1e3 * record.piston, "arm's offset": 1e3 * record.offset}
    charts.append(line_chart("Position of the cylinder", record.time, places, "time [s]", "position [mm]"))
    charts.append(
        line_chart("Pressure", record.time, {"pressure": 1e-5 * record.pressure}, "time [s]", "pressure [bar]")
    )
    turns = {"spindle": 60.0 / (2.0 * np.pi) * record.speed}
    charts.append(line_chart("Spindle", record.time, turns, "time [s]", "speed [1/min]"))
    charts.append(line_chart("Torque of the spindle", record.time, {"torque": record.torque}, "time [s]", "[N m]"))
    return charts
