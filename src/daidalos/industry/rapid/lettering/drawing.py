"""What the pen has drawn, and how far it is from the letters."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import groupby

import numpy as np
from numpy.typing import NDArray
from shapely import MultiLineString, STRtree, points
from shapely.geometry import LineString

from daidalos.industry.rapid.lettering.strokes import Point, Stroke

Array = NDArray[np.float64]

CONTACT = 0.05
"""Height of the tip above the sheet up to which it draws [mm]."""

PEN_WIDTH = 0.5
"""Width of the pen's line [mm]."""

_SPACING = 0.05


@dataclass(frozen=True)
class Comparison:
    """A drawing beside the letters.

    Attributes
    ----------
    overlap : float
        Area that both lines cover, by the area that either covers, for a pen of `PEN_WIDTH`.
    deviation : float
        Greatest distance of a point of either from the other [mm].
    """

    overlap: float
    deviation: float


def drawn_strokes(positions: Array, frame: Array, contact: float = CONTACT) -> list[Stroke]:
    """Return the strokes of a pen whose tip has been at positions (n, 3) [mm] in the base.

    Parameters
    ----------
    positions
        Positions in their order.
    frame
        Pose of the sheet in the base (4, 4) [mm].
    contact
        Height of the tip above the sheet up to which it draws [mm].
    """
    on_sheet = (positions - frame[:3, 3]) @ frame[:3, :3]
    found = []
    for is_down, group in groupby(on_sheet.tolist(), key=lambda one: bool(one[2] <= contact)):
        line: list[Point] = [(x, y) for x, y, _ in group]
        if is_down and len(line) > 1:
            found.append(Stroke(line))
    return found


def compare(drawn: list[Stroke], wanted: list[Stroke]) -> Comparison:
    """Return how much a drawing and the letters overlap, and the worst deviation of one from the other.

    Raises
    ------
    ValueError
        Where nothing is drawn.
    """
    if not drawn or not wanted:
        raise ValueError("the pen has drawn nothing on the sheet")
    lines = [MultiLineString([one.points for one in strokes]).simplify(1e-4) for strokes in (drawn, wanted)]
    inks = [one.buffer(PEN_WIDTH / 2.0) for one in lines]
    overlap = inks[0].intersection(inks[1]).area / inks[0].union(inks[1]).area
    deviation = max(_farthest(drawn, wanted), _farthest(wanted, drawn))
    return Comparison(float(overlap), deviation)


def _farthest(strokes: list[Stroke], others: list[Stroke]) -> float:
    """Return the greatest distance of points on strokes from other strokes [mm]."""
    pieces = [LineString(pair) for one in others for pair in zip(one.points, one.points[1:], strict=False)]
    dense = np.concatenate([_dense(np.array(one.points)) for one in strokes])
    _, distances = STRtree(pieces).query_nearest(points(dense), return_distance=True, all_matches=False)
    return float(distances.max())


def _dense(line: Array) -> Array:
    """Return a line with points at most `_SPACING` apart."""
    lengths = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
    along = np.linspace(0.0, lengths[-1], max(2, int(lengths[-1] / _SPACING) + 1))
    along = np.union1d(along, lengths)
    return np.stack([np.interp(along, lengths, line[:, k]) for k in range(2)], axis=1)


def picture(strokes: list[Stroke]) -> str:
    """Return the drawing as SVG, in millimetres."""
    corners = np.concatenate([np.array(one.points) for one in strokes]) if strokes else np.zeros((1, 2))
    (x0, y0), (x1, y1) = corners.min(axis=0) - 5.0, corners.max(axis=0) + 5.0
    lines = [f'<polyline points="{" ".join(f"{x - x0:.3f},{y1 - y:.3f}" for x, y in one.points)}"/>' for one in strokes]
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{x1 - x0:.1f}mm" height="{y1 - y0:.1f}mm" '
        f'viewBox="0 0 {x1 - x0:.3f} {y1 - y0:.3f}">\n<rect width="100%" height="100%" fill="white"/>\n'
        f'<g fill="none" stroke="#123a8a" stroke-width="{PEN_WIDTH}" stroke-linecap="round" '
        f'stroke-linejoin="round">\n{chr(10).join(lines)}\n</g>\n</svg>\n'
    )
