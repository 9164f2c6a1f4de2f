"""HTML report of designed servo loops: figures, step responses, Bode and Nyquist plots."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from daidalos.industry.servoing.loop_design import FREQUENCIES, LoopDesign
from daidalos.industry.welding.charts import curve_chart, line_chart, page, table
from daidalos.industry.welding.comparison import Row

_NYQUIST_RADIUS = 3.0
"""Distance from the origin up to which the Nyquist plot is drawn."""


def design_report(designs: Sequence[LoopDesign], rows: Sequence[Row]) -> str:
    """Return the page of designed loops and of the table beside the workshop's figures; without rows, no table."""
    parts = []
    if rows:
        cells = [[row.title, row.printed, row.ours, row.remark] for row in rows]
        parts.append(table(["figure", "workshop", "here", "remark"], cells))
    named = {one.compensator.name: one for one in designs}
    steps = {name: one.step for name, one in named.items()}
    decades = np.log10(FREQUENCIES)
    gains = {name: 20.0 * np.log10(np.abs(one.response)) for name, one in named.items()}
    phases = {name: np.degrees(np.unwrap(np.angle(one.response))) for name, one in named.items()}
    near = {name: one.response[np.abs(one.response) < _NYQUIST_RADIUS] for name, one in named.items()}
    nyquist = {name: (one.real, one.imag) for name, one in near.items()}
    return page(
        "Design of the servo loop",
        [
            *parts,
            line_chart("Step response", designs[0].times, steps, "time [s]", "position"),
            line_chart("Bode: gain", decades, gains, "log10 of the frequency [rad/s]", "gain [dB]"),
            line_chart("Bode: phase", decades, phases, "log10 of the frequency [rad/s]", "phase [deg]"),
            curve_chart(
                "Nyquist", nyquist | {"-1": (np.array([-1.02, -0.98]), np.array([0.0, 0.0]))}, "real", "imaginary"
            ),
        ],
    )
