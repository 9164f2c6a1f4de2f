"""HTML report of runs of a seam servo, and the table beside the workshop's figures."""

from __future__ import annotations

from collections.abc import Sequence

from daidalos.industry.servoing.servo_run import ServoRun
from daidalos.industry.welding.charts import curve_chart, page, table
from daidalos.industry.welding.comparison import Row

_PRINTED = {
    ("line", "proportional"): {"response": "2.72 s", "overshoot": "0.3 mm", "residual": "0.05 mm"},
    ("line", "lead"): {"response": "2.45 s", "overshoot": "0.3 mm", "residual": "0.05 mm"},
    ("curve", "proportional"): {
        "response": "3.7 s", "overshoot": "0.1 mm", "residual": "0.05 mm", "std": "0.18 mm",
        "interval": "-0.6 to 0.6 mm",
    },
    ("curve", "lead"): {
        "response": "3.5 s", "residual": "0.05 mm", "std": "0.08 mm", "interval": "-0.2 to 0.2 mm",
    },
}  # fmt: skip
"""What the workshop prints, by seam and controller."""
_UNKNOWN_RESPONSE = "how the workshop measures response and overshoot in its experiments is not printed"
_CHOSEN = "the curve is not printed: its waves and the compensators' look-ahead are chosen so that both come out near"


def servo_rows(run: ServoRun) -> list[Row]:
    """Return the rows of what the workshop prints of a seam and a controller; none where it prints nothing."""
    printed = _PRINTED.get((run.seam, run.controller), {})
    figures = run.figures()
    low, high = figures.get("interval_mm", (0.0, 0.0))
    ours = {
        "response": ("response time", f"{figures['response_time_s']} s", _UNKNOWN_RESPONSE),
        "overshoot": ("overshoot", f"{figures['overshoot_mm']} mm", _UNKNOWN_RESPONSE),
        "residual": ("residual", f"{figures.get('residual_mm')} mm", ""),
        "std": ("standard deviation", f"{figures.get('std_mm')} mm", _CHOSEN),
        "interval": ("interval", f"{low:.2f} to {high:.2f} mm", ""),
    }
    return [
        Row(f"{run.controller}: {ours[name][0]}", value, ours[name][1], ours[name][2])
        for name, value in printed.items()
    ]


def servo_report(runs: Sequence[ServoRun]) -> str:
    """Return the page of runs: figures, deviations along the seam, places, corrections and what was seen."""
    names = _names(runs)
    figures = {name: run.figures() for name, run in zip(names, runs, strict=True)}
    keys = list(dict.fromkeys(key for one in figures.values() for key in one))
    parts = [table(["", *names], [[key, *(one.get(key, "") for one in figures.values())] for key in keys])]
    rows = [row for run in runs for row in servo_rows(run)]
    if rows:
        cells = [[row.title, row.printed, row.ours, row.remark] for row in rows]
        parts += ["<h2>Beside the workshop</h2>", table(["figure", "workshop", "here", "remark"], cells)]
    for title, series, unit, factor in (
        ("Deviation of the tool from the seam", "deviation", "mm", 1e3),
        ("Place of the tool", "lateral", "mm", 1e3),
        ("Correction of a cycle", "correction", "mm", 1e3),
        ("Gap", "gap", "mm", 1e3),
        ("Quality of the profiles", "quality", "", 1.0),
        ("Computing time", "duration", "ms", 1e3),
    ):
        curves = {}
        for name, run in zip(names, runs, strict=True):
            values = factor * run.series[series]
            known = values == values
            if known.any():
                curves[name] = (1e3 * run.series["s"][known], values[known])
        if curves:
            parts.append(curve_chart(title, curves, "seam [mm]", f"[{unit}]" if unit else ""))
    return page("Seam servoing", parts)


def _names(runs: Sequence[ServoRun]) -> list[str]:
    """Return a name for each run, numbered where two are the same."""
    out: list[str] = []
    for run in runs:
        name = f"{run.seam}, {run.controller}"
        out.append(name if name not in out else f"{name} {sum(one.startswith(name) for one in out) + 1}")
    return out
