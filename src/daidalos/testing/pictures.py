"""Pictures of a scenario: its world from above with the ways of what was observed, or a plot of the values."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from daidalos.testing.graph import PoseValue
from daidalos.testing.kept_world import running_server
from daidalos.testing.signals import Signal

if TYPE_CHECKING:
    from PIL.ImageDraw import ImageDraw

    from daidalos.simulation import Simulation
    from daidalos.testing.scenario import Scenario

_SIZE = 900
_PLOT_HEIGHT = 220
_MARGIN_M = 1.0
_MARGIN = 50
_COLORS = ((255, 96, 32), (32, 128, 255), (40, 170, 80), (180, 60, 200), (200, 160, 0))
_BACKGROUND = (250, 250, 250)
_INK = (40, 40, 40)
_MAX_PLOTS = 4


def draw_failure(scenario: Scenario, path: Path, title: str) -> None:
    """Draw where everything is, and how what was observed has changed, into a PNG file."""
    from PIL import Image, ImageDraw

    server = running_server()
    simulation = None if server is None else server.host.paced.simulation
    plotted = [signal for signal in scenario.signals if _numbers(signal)][:_MAX_PLOTS]
    view_height = _SIZE if simulation is not None else 0
    height = 40 + view_height + _PLOT_HEIGHT * len(plotted)
    image = Image.new("RGB", (_SIZE, height), _BACKGROUND)
    draw = ImageDraw.Draw(image)
    draw.text((10, 12), f"{title}, seed {scenario.seed}, at {scenario.now:.3f} s", fill=_INK)
    if simulation is not None:
        image.paste(_world(simulation, scenario), (0, 40))
    for number, signal in enumerate(plotted):
        _plot(draw, signal, 40 + view_height + _PLOT_HEIGHT * number, _COLORS[number % len(_COLORS)])
    image.save(path)


def _world(simulation: Simulation, scenario: Scenario) -> Any:
    """Return the world from above, with the ways and outlines of what moves."""
    from PIL import Image, ImageDraw

    ways = [(signal, [(v.x, v.y) for _, v in signal.values]) for signal in scenario.signals if _is_way(signal)]
    boxes = {name: simulation.bounds(name) for name in simulation.models}
    solid = {name: box for name, box in boxes.items() if (box[1] - box[0]).max() > 0.0}
    corners = [(float(c[0]), float(c[1])) for box in solid.values() for c in box] + [p for _, way in ways for p in way]
    if not corners:
        corners = [(-1.0, -1.0), (1.0, 1.0)]
    left, right = min(x for x, _ in corners) - _MARGIN_M, max(x for x, _ in corners) + _MARGIN_M
    low, high = min(y for _, y in corners) - _MARGIN_M, max(y for _, y in corners) + _MARGIN_M
    scale = _SIZE / max(right - left, high - low)
    centre_x, centre_y = 0.5 * (left + right), 0.5 * (low + high)

    def at(x: float, y: float) -> tuple[float, float]:
        return _SIZE / 2 + (x - centre_x) * scale, _SIZE / 2 - (y - centre_y) * scale

    image = Image.new("RGB", (_SIZE, _SIZE), (235, 238, 240))
    draw = ImageDraw.Draw(image)
    for owner, shape in outlines(simulation):
        fill = (150, 155, 165) if owner not in {s.name.split("'")[1] for s, _ in ways} else (255, 190, 120)
        points = [at(x, y) for x, y in shape]
        if len(points) > 2:
            draw.polygon(points, fill=fill, outline=(90, 95, 105))
    for number, (signal, way) in enumerate(ways):
        color = _COLORS[number % len(_COLORS)]
        points = [at(x, y) for x, y in way]
        if len(points) > 1:
            draw.line(points, fill=color, width=3)
        x, y = points[-1]
        draw.ellipse((x - 5, y - 5, x + 5, y + 5), fill=color)
        draw.text((x + 8, y - 6), signal.name.split("'")[1], fill=_INK)
    metre = scale
    draw.line((20, _SIZE - 20, 20 + metre, _SIZE - 20), fill=_INK, width=2)
    draw.text((20, _SIZE - 36), "1 m", fill=_INK)
    return image


def outlines(simulation: Simulation) -> list[tuple[str, list[tuple[float, float]]]]:
    """Return the outlines of all collisions from above, those of higher ones last."""
    import numpy as np
    from shapely import MultiPoint, Polygon

    physics = simulation.physics
    physics.refresh_positions()
    model, data = physics.model, physics.data
    signs = np.array([(a, b, c) for a in (-1, 1) for b in (-1, 1) for c in (-1, 1)], dtype=float)
    found = []
    for geom, (owner, _) in physics.geoms.items():
        if model.geom_rbound[geom] <= 0 or model.geom_rbound[geom] > 50.0:
            continue
        turn = data.geom_xmat[geom].reshape(3, 3)
        centre = data.geom_xpos[geom] + turn @ model.geom_aabb[geom, :3]
        corners = centre + (signs * model.geom_aabb[geom, 3:]) @ turn.T
        hull = MultiPoint(corners[:, :2]).convex_hull
        if isinstance(hull, Polygon):
            found.append((float(corners[:, 2].max()), owner, list(hull.exterior.coords)))
    return [(owner, outline) for _, owner, outline in sorted(found, key=lambda one: one[0])]


def _is_way(signal: Signal) -> bool:
    return bool(signal.values) and isinstance(signal.values[-1][1], PoseValue) and signal.name.count("'") == 2


def _numbers(signal: Signal) -> list[tuple[float, float]]:
    """Return the values of a signal that can be plotted."""
    return [
        (when, float(value))
        for when, value in signal.values
        if isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
    ]


def _plot(draw: ImageDraw, signal: Signal, top: int, color: tuple[int, int, int]) -> None:
    points = _numbers(signal)
    times, values = [when for when, _ in points], [value for _, value in points]
    bottom = top + _PLOT_HEIGHT - 30
    draw.text((_MARGIN, top + 4), signal.name, fill=_INK)
    draw.rectangle((_MARGIN, top + 22, _SIZE - 20, bottom), outline=(190, 190, 190))
    _label(draw, times, values, top, bottom)
    x_scale = (_SIZE - 20 - _MARGIN) / ((times[-1] - times[0]) or 1.0)
    y_scale = (bottom - top - 22) / ((max(values) - min(values)) or 1.0)
    line = [(_MARGIN + (t - times[0]) * x_scale, bottom - (v - min(values)) * y_scale) for t, v in points]
    if len(line) > 1:
        draw.line(line, fill=color, width=2)
    x, y = line[-1]
    draw.ellipse((x - 3, y - 3, x + 3, y + 3), fill=color)


def _label(draw: ImageDraw, times: Sequence[float], values: Sequence[float], top: int, bottom: int) -> None:
    draw.text((4, top + 20), f"{max(values):.4g}", fill=_INK)
    draw.text((4, bottom - 10), f"{min(values):.4g}", fill=_INK)
    draw.text((_MARGIN, bottom + 4), f"{times[0]:.2f} s", fill=_INK)
    draw.text((_SIZE - 80, bottom + 4), f"{times[-1]:.2f} s", fill=_INK)
