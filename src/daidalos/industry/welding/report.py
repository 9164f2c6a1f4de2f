"""Reports of planned welds and of experiments, each one HTML page."""

from __future__ import annotations

from typing import Any

import numpy as np

from daidalos.industry.welding.charts import line_chart, page, table
from daidalos.industry.welding.comparison import Row
from daidalos.industry.welding.experiments import Experiment
from daidalos.industry.welding.planning import DIRECTIONS, Plan

_TITLES = {"ahead": "ahead (advance)", "across": "across (lateral)", "along_tool": "along the tool (axial)"}


def report(plan: Plan, title: str) -> str:
    """Return the page: deviations per direction and zone, torques, shifts of the path, convergence."""
    figures = plan.as_json()
    along = 1e3 * plan.correction.distances
    before, after = 1e3 * plan.before, 1e3 * plan.after
    turned = {"before": np.degrees(plan.turned("before")), "after": np.degrees(plan.turned("after"))}
    parts = [_summary(figures), "<h2>Deviation of the loaded tool</h2>"]
    for index, direction in enumerate(DIRECTIONS):
        lines = {"not corrected": before[:, index], "corrected": after[:, index]}
        parts.append(line_chart(_TITLES[direction], along, lines, "path [mm]", "deviation [mm]"))
    for index, name in enumerate(("about the direction", "about the lateral axis", "about the tool")):
        lines = {"not corrected": turned["before"][:, index], "corrected": turned["after"][:, index]}
        parts.append(line_chart(f"Rotation {name}", along, lines, "path [mm]", "angle [deg]"))
    if figures["zones"]:
        names = list(figures["zones"][0])
        parts += ["<h2>Zones</h2>", table(names, [[zone[name] for name in names] for zone in figures["zones"]])]
    torques = {f"axis {axis + 1}": column for axis, column in enumerate(plan.correction.after.torques.T)}
    parts += ["<h2>Transmissions</h2>", line_chart("Torques", along, torques, "path [mm]", "torque [Nm]")]
    play = {f"axis {axis + 1}": column + 0.02 * axis for axis, column in enumerate(plan.correction.after.sides.T)}
    parts.append(line_chart("Flanks", along, play, "path [mm]", "side"))
    steps = np.arange(1.0, len(plan.correction.convergence) + 1.0)
    distance, angle = (np.array(one) for one in zip(*plan.correction.convergence, strict=True))
    lines = {"distance [mm]": 1e3 * distance, "angle [deg]": np.degrees(angle)}
    parts += [
        "<h2>Convergence</h2>",
        line_chart("Loaded tool from desired path", steps, lines, "iteration", "log", True),
    ]
    for name, unit in (("rotations", "deg"), ("places", "mm")):
        tried = [one for one in figures[name] if one["deflection_mm"] is not None][:8]
        rows = [[", ".join(f"{value:g}" for value in one[f"value_{unit}"]), one["deflection_mm"]] for one in tried]
        if rows:
            title_of = {"rotations": "Rotations about the tool", "places": "Shifts of the workpiece"}[name]
            parts += [f"<h2>{title_of}</h2>", table([f"value [{unit}]", "deflection rms [mm]"], rows)]
    return page(title, parts)


def experiment_report(experiment: Experiment, rows: list[Row], title: str) -> str:
    """Return the page of an experiment: the table, and what the tracker measured."""
    cells = [[row.title, row.printed, row.ours, row.remark] for row in rows]
    parts = [table(["figure", "workshop", "here", "remark"], cells)]
    names = {"uncorrected": "not corrected", "without_backlash": "without backlash", "corrected": "corrected"}
    for index, direction in enumerate(DIRECTIONS):
        lines = {names[name]: 1e3 * weld.deviations[:, index] for name, weld in experiment.welds.items()}
        along = 1e3 * experiment.welds["corrected"].distances
        parts.append(line_chart(f"Measured {_TITLES[direction]}", along, lines, "path [mm]", "deviation [mm]"))
    torques = experiment.plans["corrected"].correction
    lines = {f"axis {axis + 1}": column for axis, column in enumerate(torques.after.torques.T)}
    parts.append(line_chart("Torques of the model", 1e3 * torques.distances, lines, "path [mm]", "torque [Nm]"))
    return page(title, parts)


def _summary(figures: dict[str, Any]) -> str:
    rows = [
        [_TITLES[direction], *(figures[state][f"{direction}_rms_mm"] for state in ("before", "after"))]
        for direction in DIRECTIONS
    ]
    spline = figures["spline"]
    facts = (
        f"{figures['robot']}, {figures['points']} points over {figures['length_mm']:.1f} mm at "
        f"{figures['speed_mm_per_min']:g} mm/min; splines of degree 4 in {spline['pieces']} pieces with "
        f"{spline['position_knots']} knots in position and {spline['orientation_knots']} in orientation, residual "
        f"{spline['residual_mm']:.5f} mm and {spline['residual_deg']:.5f} deg; flank changes of axes 1 to 6: "
        f"{', '.join(map(str, figures['flank_changes']))}."
    )
    return f"<p>{facts}</p>" + table(["rms [mm]", "not corrected", "corrected"], rows)
