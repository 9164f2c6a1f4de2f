"""Figures of a laser projector: rings and texts as polylines, and the samples that its mirrors follow."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from daidalos.common.pose3 import Vector
from daidalos.industry.lighting.idn import Frame
from daidalos.industry.rapid.lettering.strokes import strokes_of_text

Array = NDArray[np.float64]
STEP = 0.025
"""Greatest way of the beam from one sample to the next, in shares of the deflection."""

_CORNERS = 48
_END_DWELL, _CORNER_DWELL = 3, 1
"""Samples for which the mirrors rest at the ends of a line and at its sharp corners, since they follow with a delay."""

_SHARP = math.cos(math.radians(30.0))
_SPACING = 0.02
"""Distance of points [m] between which a straight line of the cell is straight for the mirrors."""


def ring(center: Vector, radius: float) -> Array:
    """Return a closed horizontal circle ``(n, 3)`` around a point of the cell [m]."""
    turns = np.linspace(0.0, 2.0 * math.pi, _CORNERS + 1)
    offsets = np.column_stack([np.cos(turns), np.sin(turns), np.zeros(len(turns))])
    return np.asarray(center + radius * offsets)


def horizontal_text(text: str, start: Vector, height: float, direction: float) -> list[Array]:
    """Return a text as horizontal lines ``(n, 3)`` of the cell.

    Parameters
    ----------
    text : str
    start : (x, y, z)
        Middle of its left edge [m].
    height : float
        Of capitals [m].
    direction : float
        Angle of the line of writing about z [rad]; 0 writes along x.

    Raises
    ------
    UserError
        When the alphabet lacks a letter.
    """
    along = np.array([math.cos(direction), math.sin(direction), 0.0])
    across = np.array([-along[1], along[0], 0.0])
    lines = [np.asarray(one.points) for one in strokes_of_text(text, height, None)]
    placed = [start + one[:, :1] * along + (one[:, 1:] - 0.5 * height) * across for one in lines]
    return [subdivide(one, _SPACING) for one in placed]


def centered_text(text: str, width: float, height: float) -> list[Array]:
    """Return a text as lines ``(n, 2)`` around the origin that fits into a width and a height.

    Raises
    ------
    UserError
        When the alphabet lacks a letter.
    """
    lines = [np.asarray(one.points) for one in strokes_of_text(text, 1.0, None)]
    every = np.concatenate(lines)
    low, high = every.min(axis=0), every.max(axis=0)
    scale = min(width / max(high[0] - low[0], 1e-6), height)
    return [(one - 0.5 * (low + high)) * scale for one in lines]


def trace(lines: Iterable[Array], color: Sequence[int], rate: float) -> Frame:
    """Return the frame that draws lines ``(n, 2)`` of deflections in a colour, dark from one to the next.

    Parameters
    ----------
    lines : iterable of (n, 2) arrays
        From -1 to 1.
    color : sequence of int
        Red, green and blue from 0 to 255.
    rate : float
        Samples in a second [Hz].
    """
    places: list[Array] = []
    lit: list[bool] = []
    kept = [one for one in lines if len(one)]
    for before, line in zip([kept[-1], *kept] if kept else [], kept, strict=False):
        for way, is_lit in ((np.array([before[-1], line[0]]), False), (line, True)):
            found = _with_dwells(way) if is_lit else subdivide(way, STEP)
            places.append(found)
            lit += [is_lit] * len(found)
    if not places:
        return Frame(np.zeros((0, 2)), np.zeros((0, 3), np.uint8), 0.0)
    colors = np.where(np.array(lit)[:, None], np.array(color, np.uint8), np.uint8(0))
    return Frame(np.concatenate(places), colors.astype(np.uint8), len(lit) / rate)


def subdivide(line: Array, step: float) -> Array:
    """Return a polyline ``(n, d)`` with points inserted so that none is farther than a step from the next."""
    counts = np.maximum(np.ceil(np.linalg.norm(np.diff(line, axis=0), axis=1) / step), 1).astype(int)
    parts = [
        start + (end - start) * np.arange(count)[:, None] / count
        for start, end, count in zip(line[:-1], line[1:], counts, strict=True)
    ]
    return np.concatenate([*parts, line[-1:]])


def _with_dwells(line: Array) -> Array:
    """Return the samples of a line, which rest at its ends and sharp corners."""
    ways = np.diff(line, axis=0)
    lengths = np.maximum(np.linalg.norm(ways, axis=1), 1e-12)
    turns = np.sum(ways[:-1] * ways[1:], axis=1) / (lengths[:-1] * lengths[1:])
    rests = np.array([_END_DWELL, *(_CORNER_DWELL * (turns < _SHARP)).astype(int), _END_DWELL])
    samples = [
        np.concatenate([np.repeat(start[None], rest, axis=0), subdivide(np.array([start, end]), STEP)[:-1]])
        for start, end, rest in zip(line[:-1], line[1:], rests[:-1], strict=True)
    ]
    return np.concatenate([*samples, np.repeat(line[-1:], rests[-1] + 1, axis=0)])
