"""SDF's ``<population>``: many copies of a model, distributed over a region."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Callable, Iterator

import numpy as np

from daidalos.common.pose3 import Pose, Vector
from daidalos.description.markup import Element

MAX_MODELS = 10_000

PositionGenerator = Callable[[int, Vector, np.random.Generator], Iterator[Vector]]


def population_poses(element: Element, pose: Pose) -> list[Pose]:
    """Return the poses of the models of a population.

    Parameters
    ----------
    element : Element
        ``<population>``. Random places depend on its name alone, so that a world is the same each time.
    pose : Pose
        Of the region's centre.
    """
    count = element.integer_of("model_count", default=1)
    if count > MAX_MODELS:
        raise element.error(f"expected at most {MAX_MODELS} models, got {count}")
    distribution = element.first("distribution") or Element("distribution")
    kind = distribution.text_of("type", default="random")
    if kind == "grid":
        places = _grid(distribution)
    elif kind in _SPREADS:
        seed = int.from_bytes(hashlib.sha256(element.name().encode()).digest()[:8], "little")
        places = list(_region(element, count, kind, np.random.default_rng(seed)))
    else:
        raise distribution.error(f"unknown distribution {kind!r}; known are grid, {', '.join(_SPREADS)}")
    return [pose @ Pose(place) for place in places]


def _region(element: Element, count: int, kind: str, random: np.random.Generator) -> Iterator[Vector]:
    cylinder = element.first("cylinder")
    if cylinder is None:
        box = element.first("box") or Element("box")
        x, y, z = box.vector_of("size", size=3, default=(1.0, 1.0, 1.0))
        yield from _SPREADS[kind](count, (x, y, z), random)
        return
    radius = cylinder.number_of("radius", default=1.0)
    length = cylinder.number_of("length", default=1.0)
    if kind in ("random", "uniform"):
        for number in range(count):
            # Vogel's spiral fills a disc evenly; at random, the square root does.
            share = (number + 0.5) / count if kind == "uniform" else random.random()
            angle = number * math.pi * (3 - math.sqrt(5)) if kind == "uniform" else random.uniform(0, 2 * math.pi)
            height = 0.0 if kind == "uniform" else random.uniform(-length / 2, length / 2)
            yield radius * math.sqrt(share) * math.cos(angle), radius * math.sqrt(share) * math.sin(angle), height
    else:
        yield from _SPREADS[kind](count, (2 * radius, 2 * radius, length), random)


def _grid(distribution: Element) -> list[Vector]:
    rows = distribution.integer_of("rows", default=1)
    columns = distribution.integer_of("cols", default=1)
    if rows * columns > MAX_MODELS:
        raise distribution.error(f"expected at most {MAX_MODELS} models, got {rows * columns}")
    dx, dy, _ = distribution.vector_of("step", size=3, default=(0.5, 0.5, 0.0))
    return [
        (dx * (column - (columns - 1) / 2), dy * (row - (rows - 1) / 2), 0.0)
        for row in range(rows)
        for column in range(columns)
    ]


def _random(count: int, size: Vector, random: np.random.Generator) -> Iterator[Vector]:
    for _ in range(count):
        x, y, z = (float(random.uniform(-side / 2, side / 2)) for side in size)
        yield x, y, z


def _uniform(count: int, size: Vector, _: np.random.Generator) -> Iterator[Vector]:
    """Return positions on a lattice with nearly square cells."""
    columns = max(1, math.ceil(math.sqrt(count * size[0] / max(size[1], 1e-9))))
    rows = math.ceil(count / columns)
    for number in range(count):
        row, column = divmod(number, columns)
        yield size[0] * ((column + 0.5) / columns - 0.5), size[1] * ((row + 0.5) / rows - 0.5), 0.0


def _linear(axis: int) -> PositionGenerator:
    def places(count: int, size: Vector, _: np.random.Generator) -> Iterator[Vector]:
        for number in range(count):
            share = number / (count - 1) - 0.5 if count > 1 else 0.0
            x, y, z = (size[axis] * share if i == axis else 0.0 for i in range(3))
            yield x, y, z

    return places


_SPREADS: dict[str, PositionGenerator] = {
    "random": _random,
    "uniform": _uniform,
    "linear-x": _linear(0),
    "linear-y": _linear(1),
    "linear-z": _linear(2),
}
