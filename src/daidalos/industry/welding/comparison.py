"""Tables of the workshop's printed figures beside those of the simulated cell."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.industry.welding.experiments import Experiment, Weld, model_deflections

TOLERANCE = 0.5e-3
"""Deviation across the seam that the process allows [m]."""


@dataclass(frozen=True)
class Row:
    """A figure of the workshop and ours.

    Attributes
    ----------
    title, printed, ours : str
        What it is, as the workshop prints it, and as it comes out here.
    remark : str
        Why the two differ, where the reason is known.
    """

    title: str
    printed: str
    ours: str
    remark: str = ""

    def as_json(self) -> dict[str, str]:
        """Return the row with the names of the table's columns."""
        return {"figure": self.title, "workshop": self.printed, "here": self.ours, "remark": self.remark}


def line_rows(experiment: Experiment) -> list[Row]:
    """Return the rows of the straight line."""
    model = np.sqrt((model_deflections(experiment.plans["corrected"]) ** 2).mean(axis=0))
    angles = np.degrees(model[3:])
    without, corrected = experiment.welds["uncorrected"].rms, experiment.welds["corrected"].rms
    gain = 1.0 - corrected[1] / without[1]
    place = "the place and orientation of the test piece are not printed"
    return [
        Row("model: deflection Y (across), rms", "2.53 mm", f"{1e3 * model[1]:.2f} mm"),
        Row("model: deflection Z (along the tool), rms", "5.88 mm", f"{1e3 * model[2]:.2f} mm"),
        Row("model: yaw A, rms", "0.013 and 0.0013 deg", f"{angles[0]:.3f} deg", "printed twice; " + place),
        Row("model: pitch B, rms", "0.17 deg", f"{angles[1]:.2f} deg", place),
        Row("model: roll C, rms", "0.23 deg", f"{angles[2]:.2f} deg", place),
        Row("measured: across, not corrected, rms", "2.32 mm", f"{1e3 * without[1]:.2f} mm"),
        Row("measured: along the tool, not corrected, rms", "not printed", f"{1e3 * without[2]:.2f} mm"),
        Row("measured: across, corrected, rms", "0.27 mm", f"{1e3 * corrected[1]:.2f} mm"),
        Row("measured: along the tool, corrected, rms", "not printed", f"{1e3 * corrected[2]:.2f} mm"),
        Row("gain across", "88 %", f"{100.0 * gain:.0f} %"),
    ]


def curve_rows(experiment: Experiment) -> list[Row]:
    """Return the rows of the curve of nine zones."""
    rows = []
    planned = experiment.plans["corrected"]
    model = -1e3 * model_deflections(planned)[:, :3]
    zones = np.array(planned.seam.zones)
    printed = {"1": (-2.3, -1.6), "3": (-1.5, 2.2), "5": (-1.9, -0.6), "7": (1.3, -1.3), "9": (-0.4, -0.4)}
    for zone, (across, ahead) in printed.items():
        mean = model[zones == zone].mean(axis=0)
        rows.append(
            Row(
                f"model: zone {zone}, across and ahead",
                f"{across} and {ahead} mm",
                f"{mean[1]:.1f} and {mean[0]:.1f} mm",
                "the curve is not printed, only its zones: directions fitted, lengths free",
            )
        )
    uncorrected, without, corrected = (
        experiment.welds[name] for name in ("uncorrected", "without_backlash", "corrected")
    )
    rows += [
        Row("measured: across, not corrected", "-1.2 to 3.75 mm", _range(uncorrected)),
        Row("measured: across, corrected without backlash", "-1.5 to 1.5 mm", _range(without)),
        Row("measured: across, corrected, 99 % of the weld", "-0.5 to 0 mm", _range(corrected, 0.5)),
        Row(
            "measured: across, corrected, whole weld",
            "-0.5 to 0 mm",
            _range(corrected),
            "while axis 1 crosses its play the force's noise says when; the workshop shows zones only",
        ),
        Row("share of the weld within +-0.5 mm", "all zones OK", f"{100.0 * within_tolerance(corrected):.1f} %"),
        Row(
            "zones whose mean is within +-0.5 mm",
            "9 of 9",
            f"{sum(abs(mean) <= TOLERANCE for mean in zone_means(corrected).values())} of 9",
        ),
    ]
    return rows


def within_tolerance(weld: Weld) -> float:
    """Return the share of the samples whose deviation across is within the process's tolerance."""
    return float((np.abs(weld.deviations[:, 1]) <= TOLERANCE).mean())


def zone_means(weld: Weld) -> dict[str, float]:
    """Return the mean deviation across of each zone [m]."""
    zones = np.array(weld.zones)
    return {str(zone): float(weld.deviations[zones == zone, 1].mean()) for zone in dict.fromkeys(weld.zones)}


def _range(weld: Weld, percent: float = 0.0) -> str:
    across: NDArray[np.float64] = 1e3 * weld.deviations[:, 1]
    low, high = np.percentile(across, [percent, 100.0 - percent])
    return f"{low:.2f} to {high:.2f} mm"
