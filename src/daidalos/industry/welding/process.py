"""Process models of friction stir welding: the wrench of the tool by its feed and the speed of its spindle.

Each component follows a power law, W = W0 (f / f0)^a (n / n0)^b, which is fitted to measured welds by least squares of
the logarithms.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daidalos.common.documents import DocumentError
from daidalos.common.errors import UserError
from daidalos.industry.columns import read_columns
from daidalos.industry.welding.seam_csv import PROCESS_COLUMNS, WRENCH_COLUMNS

BUILT_IN = "fsw"
MARGIN = 1.5
"""Factor by which feed and spindle speed may lie outside of the measured ones."""
MAX_CONDITION = 1e4
"""Greatest condition of a fit; beyond it feed and spindle speed were not varied independently."""


@dataclass(frozen=True)
class ProcessModel:
    """Wrench of a tool by power laws.

    Attributes
    ----------
    name : str
        `BUILT_IN`, or the file of the measurements.
    feed, spindle_speed : float
        At which the wrench is known [m/s], [turns/s].
    wrench : array of shape (6,)
        There: that the tool exerts, x ahead, z into the workpiece [N, Nm].
    feed_exponents, spindle_exponents : array of shape (6,)
        How each component follows the feed and the spindle speed.
    feeds, spindle_speeds : tuple of float
        Least and greatest for which it holds [m/s], [turns/s].
    residuals : array of shape (6,)
        Root mean square of the relative deviations of the measurements; NaN where there are none.
    """

    name: str
    feed: float
    spindle_speed: float
    wrench: NDArray[np.float64]
    feed_exponents: NDArray[np.float64]
    spindle_exponents: NDArray[np.float64]
    feeds: tuple[float, float]
    spindle_speeds: tuple[float, float]
    residuals: NDArray[np.float64]

    def wrenches(self, feeds: NDArray[np.float64], spindle_speeds: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the wrenches (n, 6) at feeds (n,) [m/s] and spindle speeds (n,) [turns/s].

        Raises
        ------
        UserError
            Where one of them is outside of what the model holds for.
        """
        for values, (low, high), title, factor, unit in (
            (feeds, self.feeds, "feed", 60e3, "mm/min"),
            (spindle_speeds, self.spindle_speeds, "spindle speed", 60.0, "1/min"),
        ):
            outside = (values < low * (1.0 - 1e-9)) | (values > high * (1.0 + 1e-9))
            if outside.any():
                point = int(np.argmax(outside))
                raise UserError(
                    f"point {point + 1}: the {title} is {factor * values[point]:g} {unit}, but the process model "
                    f"'{self.name}' holds for {factor * low:g} to {factor * high:g} {unit}"
                )
        ratios = (feeds / self.feed)[:, None] ** self.feed_exponents
        found: NDArray[np.float64] = (
            self.wrench * ratios * (spindle_speeds / self.spindle_speed)[:, None] ** self.spindle_exponents
        )
        return found

    def as_json(self) -> dict[str, Any]:
        """Return the model, with its exponents by component."""
        return {
            "name": self.name,
            "feed_mm_per_min": round(60e3 * self.feed, 6),
            "spindle_rpm": round(60.0 * self.spindle_speed, 6),
            "components": {
                name: {
                    "value": float(self.wrench[index]),
                    "feed_exponent": round(float(self.feed_exponents[index]), 4),
                    "spindle_exponent": round(float(self.spindle_exponents[index]), 4),
                    "residual_percent": None
                    if np.isnan(self.residuals[index])
                    else round(100.0 * float(self.residuals[index]), 3),
                }
                for index, name in enumerate(WRENCH_COLUMNS)
            },
        }


FSW = ProcessModel(
    BUILT_IN,
    feed=0.3 / 60.0,
    spindle_speed=800.0 / 60.0,
    wrench=np.array([420.0, -175.0, 8000.0, 0.0, 0.0, 7.0]),
    # Estimates of the usual trend: hotter, softer material by a greater spindle speed, more force by a greater feed.
    feed_exponents=np.array([0.5, 0.5, 0.2, 0.0, 0.0, 0.2]),
    spindle_exponents=np.array([-0.5, -0.5, -0.3, 0.0, 0.0, -0.7]),
    feeds=(0.05 / 60.0, 1.2 / 60.0),
    spindle_speeds=(200.0 / 60.0, 2400.0 / 60.0),
    residuals=np.full(6, np.nan),
)
"""The workshop's wrench at 300 mm/min and 800 turns a minute, with estimated exponents."""


def process_model(name: str) -> ProcessModel:
    """Return the process model of a name: `BUILT_IN`, or a CSV file of measured welds.

    Raises
    ------
    UserError
        Where there is none.
    """
    if name == BUILT_IN:
        return FSW
    path = Path(name)
    if not path.is_file():
        raise UserError(f"{path}: there is no such file, and no process model of this name but '{BUILT_IN}'")
    return read_process(path)


def read_process(path: Path) -> ProcessModel:
    """Return the power laws that fit measured welds.

    The file has the columns ``feed_mm_min, spindle_rpm, fx, fy, fz, mx, my, mz``.

    Raises
    ------
    DocumentError
        Where it is none; the message names line and column.
    """
    source = str(path)
    names = (*PROCESS_COLUMNS, *WRENCH_COLUMNS)
    columns, lines, _ = read_columns(path, names)
    for name in names:
        if name not in columns:
            raise DocumentError(f"has no column '{name}'; {', '.join(names)} are expected", source, 1)
    for name in PROCESS_COLUMNS:
        wrong = columns[name] <= 0.0
        if wrong.any():
            row = int(np.argmax(wrong))
            raise DocumentError(f"{name} is {columns[name][row]:g}, but must be greater than 0", source, lines[row])
    feeds, speeds = columns["feed_mm_min"] / 60e3, columns["spindle_rpm"] / 60.0
    feed, speed = (float(np.exp(np.log(one).mean())) if len(lines) else 1.0 for one in (feeds, speeds))
    design = np.stack([np.ones(len(lines)), np.log(feeds / feed), np.log(speeds / speed)], axis=1)
    if len(lines) < 3 or np.linalg.cond(design) > MAX_CONDITION:
        raise DocumentError(
            f"has {len(lines)} welds; at least three are needed, with feed and spindle speed varied independently",
            source,
        )
    wrench, exponents, residuals = np.zeros(6), np.zeros((2, 6)), np.zeros(6)
    for index, name in enumerate(WRENCH_COLUMNS):
        values = columns[name]
        if not values.any():
            continue
        sign = np.sign(values[0])
        other = np.sign(values) != sign
        if other.any() or not sign:
            row = int(np.argmax(other)) if sign else 0
            raise DocumentError(
                f"{name} is {values[row]:g}, but must have the same sign in all welds, or be 0 in all", source,
                lines[row],
            )  # fmt: skip
        solved = np.linalg.lstsq(design, np.log(np.abs(values)), rcond=None)[0]
        wrench[index], exponents[:, index] = sign * np.exp(solved[0]), solved[1:]
        residuals[index] = np.sqrt(((np.exp(design @ solved) / np.abs(values) - 1.0) ** 2).mean())
    ranges = [(float(one.min()) / MARGIN, float(one.max()) * MARGIN) for one in (feeds, speeds)]
    return ProcessModel(source, feed, speed, wrench, exponents[0], exponents[1], ranges[0], ranges[1], residuals)
