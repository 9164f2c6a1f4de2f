"""Report of a run: the path in three dimensions, speeds, axes, cycle time and corner paths, as one HTML file."""

from __future__ import annotations

import html
import json
from collections.abc import Sequence
from dataclasses import dataclass
from importlib.resources import files
from itertools import groupby
from typing import Any

import numpy as np

from daidalos.industry.motion.orientations import Array
from daidalos.industry.motion.planner import CornerReport
from daidalos.industry.rapid.runtime.arm_robot import ArmRobot
from daidalos.industry.robots import Arm

_MOST_POINTS = 6000


@dataclass(frozen=True)
class Trace:
    """What an arm did in a run.

    Attributes
    ----------
    arm : Arm
        The arm.
    times : array of shape (n,)
        Times [s], equally spaced.
    joints, speeds, accelerations : arrays of shape (n, 6)
        Angles [rad] and their derivatives.
    positions : array of shape (n, 3)
        Tool's centre point in the base [m].
    labels : list of str
        ``file:line`` of the instruction that is carried out, empty at rest.
    corners : list of CornerReport
        Corner paths.
    """

    arm: Arm
    times: Array
    joints: Array
    speeds: Array
    accelerations: Array
    positions: Array
    labels: list[str]
    corners: list[CornerReport]

    @classmethod
    def of(cls, robot: ArmRobot) -> Trace:
        """Return the trace of a robot that has kept samples; it has one at least.

        Raises
        ------
        ValueError
            Where it has none.
        """
        if not robot.samples:
            raise ValueError("the program moves nothing, and takes no time: there is nothing to report")
        times, joints, speeds, accelerations, positions = (
            np.concatenate([getattr(one, name) for one in robot.samples])
            for name in ("times", "joints", "speeds", "accelerations", "positions")
        )
        labels = [label for one in robot.samples for label in one.labels]
        return cls(robot.arm, times, joints, speeds, accelerations, positions, labels, robot.planner.corners)

    @property
    def tool_speeds(self) -> Array:
        """Return the speeds of the tool's centre point (n,) [m/s]."""
        if len(self.times) < 3:
            return np.zeros(len(self.times))
        velocity: Array = np.gradient(self.positions, self.times, axis=0)
        return np.asarray(np.linalg.norm(velocity, axis=1))

    def spans(self) -> list[tuple[str, float, float]]:
        """Return label, beginning and end [s] of each movement in their order."""
        found = []
        for label, group in groupby(range(len(self.times)), key=lambda index: self.labels[index]):
            rows = list(group)
            if label:
                found.append((label, float(self.times[rows[0]]), float(self.times[rows[-1]])))
        return found


def render(trace: Trace, title: str) -> str:
    """Return the report as HTML that needs no other file."""
    template = files(__package__ or "").joinpath("report.html").read_text(encoding="utf-8")
    data = json.dumps(_data(trace), separators=(",", ":"), allow_nan=False).replace("</", "<\\/")
    return (
        template.replace("{{title}}", html.escape(title))
        .replace("{{summary}}", _table(("", ""), _summary(trace)))
        .replace("{{movements}}", _table(("line", "from [s]", "to [s]", "takes [s]"), _movement_rows(trace)))
        .replace("{{corners}}", _corner_table(trace))
        .replace("{{data}}", data)
    )


def _data(trace: Trace) -> dict[str, Any]:
    step = max(1, -(-len(trace.times) // _MOST_POINTS))
    speeds = 100.0 * np.abs(trace.speeds) / trace.arm.speeds
    return {
        "t": _rounded(trace.times[::step], 4),
        "p": _rounded(1e3 * trace.positions[::step], 3),
        "v": _rounded(1e3 * trace.tool_speeds[::step], 2),
        "q": _rounded(np.degrees(trace.joints[::step]).T, 3),
        "s": _rounded(speeds[::step].T, 2),
        "l": trace.labels[::step],
    }


def _rounded(values: Array, digits: int) -> Any:
    return (np.round(values, digits) + 0.0).tolist()


def _summary(trace: Trace) -> list[tuple[str, ...]]:
    way = float(np.linalg.norm(np.diff(trace.positions, axis=0), axis=1).sum())
    low, high = trace.arm.limits.T
    gaps = np.degrees(np.minimum(trace.joints - low, high - trace.joints).min(axis=0))
    axis = int(gaps.argmin())
    shares = (np.abs(trace.speeds) / trace.arm.speeds).max(axis=0)
    fastest = int(shares.argmax())
    forces = (np.abs(trace.accelerations) / trace.arm.accelerations).max()
    return [
        ("arm", trace.arm.title),
        ("cycle time", f"{trace.times[-1]:.3f} s"),
        ("in motion", f"{sum(end - start for _, start, end in trace.spans()):.3f} s"),
        ("way of the tool", f"{1e3 * way:.1f} mm"),
        ("greatest speed of the tool", f"{1e3 * trace.tool_speeds.max():.1f} mm/s"),
        ("fastest axis", f"axis {fastest + 1}, {100.0 * shares[fastest]:.0f} % of its limit"),
        ("greatest acceleration of an axis", f"{100.0 * forces:.0f} % of its limit"),
        ("nearest to its range's end", f"axis {axis + 1}, {gaps[axis]:.1f} deg"),
    ]


def _movement_rows(trace: Trace) -> list[tuple[str, ...]]:
    return [(label, f"{start:.3f}", f"{end:.3f}", f"{end - start:.3f}") for label, start, end in trace.spans()]


def _corner_table(trace: Trace) -> str:
    rows = [
        (
            one.label,
            f"{1e3 * one.wanted:.1f}",
            f"{1e3 * one.distance:.1f}{'' if one.distance > one.wanted - 1e-6 else ' (reduced)'}",
            f"{1e3 * one.deviation:.3f}",
        )
        for one in trace.corners
    ]
    if not rows:
        return "<p>All points are stop points.</p>"
    return _table(("line", "zone [mm]", "corner path begins [mm]", "least distance from the point [mm]"), rows)


def _table(head: tuple[str, ...], rows: Sequence[tuple[str, ...]]) -> str:
    def row(cells: tuple[str, ...], tag: str) -> str:
        return f"<tr>{''.join(f'<{tag}>{html.escape(cell)}</{tag}>' for cell in cells)}</tr>"

    first = row(head, "th") if any(head) else ""
    return f"<table>{first}{''.join(row(cells, 'td') for cells in rows)}</table>"
