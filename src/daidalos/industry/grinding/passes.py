"""Passes: lines on a workpiece with force and feed at each point, planned for an even layer or for excess material."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from daidalos.common.errors import UserError
from daidalos.industry.grinding import contact_kernels
from daidalos.industry.grinding.cell import Tool, disc_at, leaning_disc, press
from daidalos.industry.grinding.height_field import Workpiece
from daidalos.industry.grinding.settings import CellParameters
from daidalos.industry.welding.seam import path_lengths

STEP = 2e-3
"""Distance of the points of a line [m]."""
RUN_IN, RUN_IN_TIME = 0.012, 0.35
"""Least length [m] and time [s] of a line before and behind the region of an even layer: there the force rises."""
EDGE = 2e-3
"""Least distance of a line from the edge of the workpiece [m]."""
MIN_FEED, MAX_FEED = 0.004, 0.12
"""[m/s]"""


@dataclass(frozen=True)
class Line:
    """One stroke of the disc, between touching down and lifting off.

    Attributes
    ----------
    points : array of shape (n, 2)
        x and y of the contact [m].
    feeds, forces : array of shape (n,)
        Speed along the line [m/s] and force [N] at the points.
    lean : tuple of float
        Unit vector from the centre of the disc to the contact, x and y: the disc leans over to there.
    """

    points: NDArray[np.float64]
    feeds: NDArray[np.float64]
    forces: NDArray[np.float64]
    lean: tuple[float, float] = (1.0, 0.0)

    @property
    def lengths(self) -> NDArray[np.float64]:
        """Return the length up to each point (n,) [m]."""
        return path_lengths(self.points)

    @property
    def duration(self) -> float:
        """Return the time of the stroke [s]."""
        return float((np.diff(self.lengths) / (0.5 * (self.feeds[:-1] + self.feeds[1:]))).sum())


@dataclass(frozen=True)
class Footprint:
    """What the disc grinds off at rest.

    Attributes
    ----------
    rates : array
        Removed depth per time [m/s] on cells along y (rows) and x, around the contact.
    offset : float
        Distance of the contact, the middle of the removal, from the centre of the disc along x [m].
    volume_rate : float
        Removed volume per time [m^3/s].
    """

    rates: NDArray[np.float64]
    offset: float
    volume_rate: float

    def width(self, resolution: float, axis: int = 0) -> float:
        """Return the width of the removal at half of its height, along y (0) or x (1) [m]."""
        across = self.rates.sum(axis=1 - axis)
        return float((across > 0.5 * across.max()).sum()) * resolution


def footprint(parameters: CellParameters, resolution: float, force: float, preston: float) -> Footprint:
    """Return what the disc grinds off a flat surface at a force [N] with a coefficient of Preston [1/Pa]."""
    radius = parameters.disc.radius
    count = 2 * math.ceil(1.05 * radius / resolution) + 1
    heights = np.zeros((count, count))
    origin = -0.5 * (count - 1) * resolution * np.ones(2)
    piece = Workpiece(heights, heights, heights == 0.0, origin, resolution, np.eye(4))
    disc = disc_at(parameters, 0.0, 0.0, -parameters.disc.lean, 0.0)
    tables, removed = np.zeros((3, contact_kernels.BINS + 1)), np.zeros(3)
    top = press(parameters, piece, heights, disc, tables)
    face = float(np.interp(force, tables[2], tables[1]))
    speed = parameters.spindle.speed - parameters.spindle.droop * parameters.disc.friction * force * radius
    time = 1e-3
    rate = preston * parameters.contact.face_stiffness * speed * time
    contact_kernels.remove(heights, origin, resolution, disc, top - face, rate, removed)
    rates = -heights / time
    return Footprint(rates, float((rates.sum(axis=0) * piece.x).sum() / rates.sum()), float(removed[0]) / time)


def even_passes(
    piece: Workpiece, parameters: CellParameters, depth: float, force: float, spacing: float, preston: float
) -> list[Line]:
    """Plan parallel lines along x that remove a layer of one depth from the region.

    Parameters
    ----------
    piece : Workpiece
    parameters : CellParameters
    depth : float
        To be removed [m].
    force : float
        [N]
    spacing : float
        Distance of the lines [m].
    preston : float
        Coefficient of Preston [1/Pa].

    Returns
    -------
    list of Line
        In strokes to and fro; more than one layer where the feed would be too slow.
    """
    print_ = footprint(parameters, piece.resolution, force, preston)
    rows, columns = (np.flatnonzero(piece.region.any(axis=axis)) for axis in (1, 0))
    low, high = piece.y[rows[0]], piece.y[rows[-1]]
    edge = 0.5 * print_.width(piece.resolution)
    count = max(round((high - low + 2.0 * edge) / spacing), 1) + 1
    places = np.linspace(low - edge, high + edge, count)
    spacing = float(places[1] - places[0])
    feed = print_.volume_rate / (depth * spacing)
    layers = max(math.ceil(MIN_FEED / feed), 1)
    feed *= layers
    if feed > MAX_FEED:
        raise UserError(
            f"a layer of {1e6 * depth:.1f} um needs a feed of {1e3 * feed:.0f} mm/s, but at most {1e3 * MAX_FEED:.0f} "
            f"are possible; choose a smaller force or a greater spacing"
        )
    before = max(RUN_IN, RUN_IN_TIME * feed)
    left = max(piece.x[columns[0]] - before, piece.x[0] + EDGE)
    right = min(piece.x[columns[-1]] + before, piece.x[-1] - EDGE)
    along = np.linspace(left, right, max(round((right - left) / STEP), 1) + 1)
    lines = []
    for number in range(layers * count):
        layer, place = divmod(number, count)
        order = along if number % 2 == 0 else along[::-1]
        y = places[place if layer % 2 == 0 else count - 1 - place]
        points = np.stack([order, np.full_like(along, y)], axis=1)
        lines.append(Line(points, np.full_like(along, feed), np.full_like(along, force)))
    return lines


def excess_passes(
    scan: Workpiece,
    parameters: CellParameters,
    tolerance: float,
    force: float,
    preston: float,
    share: float = 0.7,
    max_depth: float = 0.4e-3,
) -> list[Line]:
    """Plan lines along y that remove a share of the excess material that a scan shows.

    The excess is gathered into strips along y as wide as a bead or the contact, whichever is less; the disc leans along
    them, so that it cuts level across. Where a strip has
    excess, the feed is such that the disc removes its share there; elsewhere the disc is lifted.

    Parameters
    ----------
    scan : Workpiece
    parameters : CellParameters
    tolerance : float
        Excess that may stay [m].
    force : float
        [N]
    preston : float
        Coefficient of Preston [1/Pa].
    share : float
        Of the excess that is removed in this pass.
    max_depth : float
        Greatest depth of a pass [m].
    """
    from scipy.ndimage import label, uniform_filter

    print_ = footprint(parameters, scan.resolution, force, preston)
    smooth = uniform_filter(np.where(scan.region, scan.excess, 0.0), size=max(round(1e-3 / scan.resolution), 1))
    marks, count = label(smooth > 0.5 * tolerance)
    lines: list[Line] = []
    strip = print_.width(scan.resolution)
    for number in range(1, count + 1):
        rows, columns = np.nonzero(marks == number)
        if len(rows) * scan.resolution**2 < 4e-6 or smooth[rows, columns].max() < 0.9 * tolerance:
            continue
        first, last = int(columns.min()), int(columns.max()) + 1
        parts = max(math.ceil((last - first) * scan.resolution / strip), 1)
        bounds = np.linspace(first, last, parts + 1).round().astype(int)
        for low, high in itertools.pairwise(bounds):
            taken = np.where((marks == number)[:, low:high], np.clip(smooth[:, low:high], 0.0, None), 0.0)
            lines += _strip(scan, taken, low, force, print_.volume_rate, share, max_depth)
    return lines


def _strip(
    scan: Workpiece,
    excess: NDArray[np.float64],
    first: int,
    force: float,
    volume_rate: float,
    share: float,
    max_depth: float,
) -> list[Line]:
    """Return the line over the excess of some columns (rows, columns); empty where there is none."""
    rows = np.flatnonzero(excess.any(axis=1))
    if len(rows) < 2:
        return []
    at = np.arange(rows[0], rows[-1] + 1, max(round(STEP / scan.resolution), 1))
    if len(at) < 2:
        return []
    kernel = np.ones(2 * len(np.arange(0, STEP, scan.resolution)) + 1)
    depth = np.minimum(share * excess, max_depth)
    area = np.convolve(depth.sum(axis=1) * scan.resolution, kernel / kernel.size, mode="same")[at]
    weights = excess.sum(axis=1)
    mean = np.convolve((excess * np.arange(excess.shape[1])).sum(axis=1), kernel, mode="same")
    columns = first + mean[at] / np.maximum(np.convolve(weights, kernel, mode="same")[at], 1e-15)
    columns = np.where(weights[at] > 0.0, columns, first + 0.5 * excess.shape[1])
    points = np.stack([scan.origin[0] + columns * scan.resolution, scan.y[at]], axis=1)
    feeds = np.clip(volume_rate / np.maximum(area, 1e-12), MIN_FEED, MAX_FEED)
    return [Line(points, feeds, np.full(len(at), force), (0.0, 1.0))]


def tools_along(
    line: Line, piece: Workpiece, known: NDArray[np.float64], parameters: CellParameters, offset: float
) -> list[Tool]:
    """Return where the arm leads the disc at the points of a line, over the surface that is known."""
    tables = np.zeros((3, contact_kernels.BINS + 1))
    tools = []
    for (x, y), travelled in zip(line.points.tolist(), line.lengths.tolist(), strict=True):
        slopes = piece.slopes(x, y)
        tool = Tool(x, y, *slopes, *line.lean, 0.0, 0.0, travelled)
        height = press(parameters, piece, known, leaning_disc(parameters, tool, offset), tables)
        if height == contact_kernels.BESIDE:
            raise UserError(f"the path leaves the workpiece at x {1e3 * x:.1f}, y {1e3 * y:.1f} mm")
        tools.append(replace(tool, height=height))
    return tools
