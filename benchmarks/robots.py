"""Cost of several robots with mapping and navigation in one lock-step run, over their number, also as a picture.

What a simulated second costs is the difference of two runs of different lengths, so that starting does not count.
``DAIDALOS_BENCHMARK_ROBOTS`` chooses the numbers, such as ``1,2,10``.
"""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

from benchmarks.runs import launch_until

COUNTS = tuple(int(count) for count in os.environ.get("DAIDALOS_BENCHMARK_ROBOTS", "2,10,50").split(","))
"""Numbers of robots; fifty of them take some twenty minutes of one core."""

PICTURE = Path(__file__).parent / "results" / "robots.svg"
SHORT_S, LONG_S = 8.0, 18.0


def run() -> dict[str, float | str]:
    """Measure all numbers of robots, and draw the curve."""
    figures: dict[str, float | str] = {}
    costs: dict[int, tuple[float, float]] = {}
    with tempfile.TemporaryDirectory() as name:
        for count in COUNTS:
            words = ("daidalos_demo", "fleet.launch.py", f"robots:={count}")
            short, long = (launch_until(Path(name), until, *words) for until in (SHORT_S, LONG_S))
            cost = (long.seconds - short.seconds) / (LONG_S - SHORT_S)
            costs[count] = cost, long.peak_mb
            figures |= {
                f"robots.{count:02}_cost_of_a_second_s": cost,
                f"robots.{count:02}_cost_of_a_second_and_robot_s": cost / count,
                f"robots.{count:02}_start_s": short.seconds - SHORT_S * cost,
                f"robots.{count:02}_peak_mb": long.peak_mb,
                f"robots.{count:02}_goals_reached": long.output.count("Goal finished with status: SUCCEEDED"),
            }
    PICTURE.parent.mkdir(exist_ok=True)
    PICTURE.write_text(curve(costs), encoding="utf-8")
    return figures | {"robots.picture": str(PICTURE)}


def curve(costs: dict[int, tuple[float, float]]) -> str:
    """Return an SVG of processor time [s] a simulated second and memory [MB] over the number of robots."""
    panels = (("processor time of a simulated second [s]", 0), ("memory [MB]", 1))
    drawn = "".join(
        f"<g transform='translate({70 + 340 * number} 40)'>"
        f"{_panel(title, {count: cost[which] for count, cost in costs.items()})}</g>"
        for number, (title, which) in enumerate(panels)
    )
    style = "font: 12px sans-serif; fill: #222"
    return (
        f"<svg xmlns='http://www.w3.org/2000/svg' width='700' height='300' style='{style}'>"
        f"<rect width='100%' height='100%' fill='#fff'/>{drawn}</svg>\n"
    )


def _panel(title: str, values: dict[int, float]) -> str:
    """Return axes from zero with a line through the values."""
    width, height = 250.0, 200.0
    right, top = max(values), max(values.values())
    points = [(width * count / right, height * (1.0 - value / top), value) for count, value in values.items()]
    marks = "".join(
        f"<circle cx='{x:.1f}' cy='{y:.1f}' r='3' fill='#0a5'/>"
        f"<text x='{x - 6:.1f}' y='{y - 6:.1f}' text-anchor='end'>{value:{'.0f' if value >= 100.0 else '.3g'}}</text>"
        for x, y, value in points
    )
    ticks = "".join(
        f"<text x='{width * count / right:.1f}' y='{height + 16:g}' text-anchor='middle'>{count}</text>"
        for count in values
    )
    line = " ".join(f"{x:.1f},{y:.1f}" for x, y, _ in points)
    return (
        f"<text x='0' y='-20'>{title}</text><path d='M0 0V{height:g}H{width:g}' fill='none' stroke='#888'/>"
        f"<polyline points='{line}' fill='none' stroke='#0a5'/>{marks}{ticks}"
        f"<text x='{width / 2:g}' y='{height + 36:g}' text-anchor='middle'>robots</text>"
    )
