"""Approximate convex decomposition of surfaces by planar cuts.

Walls of rooms and other open surfaces of few plane faces become these faces (`facets`). Any other piece is cut where
the two halves' convex hulls have the least volume together, until every hull lies within a tolerance of the solid or
the number of parts is reached. The concavity of a piece is the largest distance from its hull to the solid, as in
CoACD (Wei et al. 2022), whose tree search takes minutes where this takes a second; the result is the same on every
machine.
"""

from __future__ import annotations

import functools
import heapq
import itertools
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from daidalos.description.meshes import TriangleMesh
from daidalos.simulation.conversion.facets import convex_facets

VERSION = 5
"""Changes with the results, so that kept ones are not taken for those of another method."""
MAX_PARTS = 32
_TOLERANCE = (0.01, 0.03, 0.06)
"""Permitted concavity: least [m], share of the piece's extent, and most [m]."""
_FINEST = 200
"""Largest ratio of a piece's extent to its tolerance."""
_SPACING = 0.5
"""Distance of surface samples as a share of the tolerance."""
_MAX_SAMPLES = 30_000
_GRID_RATIO = 2**0.5
"""Ratio between the steps of two grids of samples on triangles."""
_MAX_STEPS = 400
_MAX_CELLS = 100_000
_HULL_SAMPLES = 30
"""Number of samples along a hull whose distances to the surface are measured."""
_COARSE = 120
"""Number of points from which cuts are chosen."""
_MAX_PLANES = 16
_PARALLEL = 0.98
"""Cosine of the angle (11 degrees) below which two directions count as one."""
_CUTS = (0.25, 0.5, 0.75)
"""Places of the cuts that are tried along each axis, as shares of a piece's extent."""

Points = np.ndarray[Any, np.dtype[np.float64]]


@dataclass(frozen=True)
class _Part:
    points: Points
    """Points of the surface, and of the solid that it encloses."""
    concavity: float
    """Largest distance [m] from the hull to the solid."""


class Cancelled(Exception):
    """Decomposition that was ended before its result."""


def decompose(mesh: TriangleMesh, is_cancelled: Callable[[], bool] = lambda: False) -> list[Points]:
    """Return sets of points whose convex hulls together approximate a surface.

    Parameters
    ----------
    mesh : TriangleMesh
        A surface, open or closed; lengths in metres.
    is_cancelled : callable
        Asked before each cut and each step before the first.

    Returns
    -------
    list of (n, 3) arrays
        Those of `convex_facets` where there are some, else at most
        `MAX_PARTS`, in an order that depends on the mesh alone.

    Raises
    ------
    Cancelled
    """
    facets = convex_facets(mesh)
    if facets is not None:
        return facets
    extent = _extent(mesh.vertices)
    least, share, most = _TOLERANCE
    tolerance = max(min(max(least, share * extent), most), extent / _FINEST)
    overlap = _SPACING * tolerance
    surface = sample_surface(mesh, overlap)
    check_cancelled(is_cancelled)
    points = np.concatenate((surface, _points_inside(surface, tolerance)))
    check_cancelled(is_cancelled)
    planes = _face_planes(mesh, tolerance)
    order = itertools.count()
    heap = [_entry(points, tolerance, order)]
    done: list[Points] = []
    while heap and len(heap) + len(done) < MAX_PARTS:
        check_cancelled(is_cancelled)
        part = heapq.heappop(heap)[2]
        plane = _find_cut(part.points, planes, overlap) if part.concavity > tolerance else None
        if plane is None:
            done.append(part.points)
            continue
        for side in (plane, -plane):
            half = part.points[part.points @ side[:3] - side[3] <= overlap]
            heapq.heappush(heap, _entry(half, tolerance, order))
    return done + [part.points for _, _, part in heap]


def check_cancelled(is_cancelled: Callable[[], bool]) -> None:
    """Raise `Cancelled` where it is so."""
    if is_cancelled():
        raise Cancelled


def sample_surface(mesh: TriangleMesh, spacing: float) -> Points:
    """Return a mesh's vertices and points on its triangles at most about `spacing` [m] apart, at most one in a cell."""
    corners = mesh.vertices[mesh.faces]
    doubled = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    spacing = max(spacing, float(np.sqrt(doubled.sum() / 2 / _MAX_SAMPLES)))
    edges = np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=2)
    longest = edges.argmax(axis=1)
    # Triangles with their longest edge last; slivers get few rows along it.
    corners = corners[np.arange(len(corners))[:, None], (longest[:, None] + [2, 0, 1]) % 3]
    length = edges[np.arange(len(edges)), longest]
    along = _grid_steps(length / spacing)
    across = _grid_steps(doubled / np.maximum(length, 1e-300) / spacing)
    samples = [mesh.vertices[np.unique(mesh.faces)]]
    for one, other in np.unique(np.stack((along, across), axis=1)[along > 1], axis=0):
        chosen = corners[(along == one) & (across == other)]
        samples.append((_barycentric_grid(int(one), int(other)) @ chosen).reshape(-1, 3))
    points = np.concatenate(samples)
    cells = np.floor((points - _bounds(points)[0]) / spacing).astype(np.int64)
    # One number for each cell: rows take ten times as long to sort.
    _, columns, layers = cells.max(axis=0) + 1
    _, first = np.unique((cells[:, 0] * columns + cells[:, 1]) * layers + cells[:, 2], return_index=True)
    vertices = np.arange(len(samples[0])) if len(samples[0]) <= _MAX_SAMPLES else np.empty(0, dtype=int)
    return points[np.union1d(first, vertices)]


def _bounds(points: Points) -> tuple[Points, Points]:
    """Return the corners of the axis-aligned box around points, faster than by a reduction over rows of three."""
    columns = np.ascontiguousarray(points.T)
    return columns.min(axis=1), columns.max(axis=1)


def _extent(points: Points) -> float:
    low, high = _bounds(points)
    return float((high - low).max())


def _face_planes(mesh: TriangleMesh, tolerance: float) -> Points:
    """Return the planes (a, b, c, d with a x + b y + c z = d) in which most of the surface's area lies."""
    corners = mesh.vertices[mesh.faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = np.linalg.norm(normals, axis=1)
    found: list[Points] = []
    for index in np.argsort(-area, kind="stable")[:500]:
        if len(found) == _MAX_PLANES or area[index] <= 0.0:
            break
        normal = normals[index] / area[index]
        offset = float(normal @ corners[index].mean(axis=0))
        if not any(_same_plane(normal, offset, plane, tolerance) for plane in found):
            found.append(np.append(normal, offset))
    return np.array(found).reshape(-1, 4)


def _same_plane(normal: Points, offset: float, plane: Points, tolerance: float) -> bool:
    cosine = float(normal @ plane[:3])
    return abs(cosine) > _PARALLEL and abs(offset - np.sign(cosine) * plane[3]) < tolerance


def _grid_steps(wanted: Points) -> np.ndarray[Any, np.dtype[np.int64]]:
    """Return numbers of steps, few distinct ones, none less than wanted."""
    exponents = np.ceil(np.log(np.clip(wanted, 1.0, _MAX_STEPS)) / np.log(_GRID_RATIO) - 1e-9)
    steps: np.ndarray[Any, np.dtype[np.int64]] = np.ceil(_GRID_RATIO**exponents - 1e-9).astype(np.int64)
    return steps


@functools.lru_cache(maxsize=256)
def _barycentric_grid(along: int, across: int) -> Points:
    """Return weights of a triangle's corners: rows from the first corner to the opposite edge, points along each."""
    rows, steps = np.meshgrid(np.linspace(0, 1, across + 1), np.linspace(0, 1, along + 1), indexing="ij")
    height, share = rows[1:].ravel(), steps[1:].ravel()  # without the corner itself
    return np.stack((1.0 - height, height * (1.0 - share), height * share), axis=1)


def _points_inside(surface: Points, spacing: float) -> Points:
    """Return the centres of the cells that a sampled surface encloses; none where it is open."""
    from scipy.ndimage import binary_fill_holes

    low, high = _bounds(surface)
    size = high - low
    spacing = max(spacing, float(np.cbrt(np.prod(size + spacing) / _MAX_CELLS)))
    shape = np.floor(size / spacing).astype(int) + 3
    cells = np.zeros(shape, dtype=bool)
    cells[tuple((np.floor((surface - low) / spacing).astype(int) + 1).T)] = True
    inside: Points = low + (np.argwhere(binary_fill_holes(cells) & ~cells) - 0.5) * spacing
    return inside


def _entry(points: Points, tolerance: float, order: Any) -> tuple[float, int, _Part]:
    concavity = _concavity(points, tolerance)
    return -concavity, next(order), _Part(points, concavity)


def _concavity(points: Points, tolerance: float) -> float:
    """Return the largest distance from the hull of points to the nearest of them; 0 for a flat set."""
    from scipy.spatial import ConvexHull, QhullError, cKDTree

    extent = _extent(points)
    if extent <= tolerance:
        return 0.0
    try:
        hull = ConvexHull(points, qhull_options="QJ")
    except QhullError:
        return 0.0
    corners = points[hull.simplices]
    edges = np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=2).max(axis=1)
    # What lies on a small triangle is nearer to one of its corners than the tolerance.
    large = hull.simplices[edges > 3**0.5 * tolerance]
    if not len(large):
        return 0.0
    used, index = np.unique(large, return_inverse=True)
    hull_mesh = TriangleMesh(points[used], index.reshape(-1, 3).astype(np.int32))
    # A tree that is searched once: balancing it takes longer than the searches gain.
    tree = cKDTree(points, balanced_tree=False, compact_nodes=False)
    distance, _ = tree.query(sample_surface(hull_mesh, max(tolerance, extent / _HULL_SAMPLES)))
    return float(distance.max())


def _find_cut(points: Points, planes: Points, overlap: float) -> Points | None:
    """Return the plane whose two halves have the hulls of least volume together; None where none leaves two parts.

    Parameters
    ----------
    points : (n, 3) array
    planes : (m, 4) array
        Planes of the surface's faces, which are tried beside cuts across the axes.
    overlap : float
        Points within this distance [m] of the cut belong to both halves, so that no gap opens between the hulls.
    """
    coarse = points[:: max(len(points) // _COARSE, 1)]
    low, high = _bounds(coarse)
    across = [
        np.append(axis, low[number] + share * (high[number] - low[number]))
        for number, axis in enumerate(np.eye(3))
        for share in _CUTS
    ]
    candidates = np.concatenate((planes, across))
    heights = coarse @ candidates[:, :3].T - candidates[:, 3]
    divides = (heights.min(axis=0) < -2 * overlap) & (heights.max(axis=0) > 2 * overlap)
    best: tuple[float, Points] | None = None
    for plane, height in zip(candidates[divides], heights.T[divides], strict=True):
        volume = _volume(coarse[height <= overlap]) + _volume(coarse[height >= -overlap])
        if best is None or volume < best[0]:
            best = (volume, plane)
    return None if best is None else best[1]


def _volume(points: Points) -> float:
    """Return the volume of the hull of points; 0 for fewer than four or a flat set."""
    from scipy.spatial import ConvexHull, QhullError

    if len(points) < 4:
        return 0.0
    try:
        return float(ConvexHull(points).volume)
    except QhullError:
        return 0.0
