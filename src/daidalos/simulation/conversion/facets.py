"""Open surfaces of few plane faces as the convex polygons that they consist of, such as the walls of rooms."""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from typing import Any

import numpy as np

from daidalos.description.meshes import TriangleMesh

_MAX_TRIANGLES = 300
_MAX_FACETS = 150
_COPLANAR = 1e-3
"""Sine of the angle, and distance as a share of the surface's extent, up to which two triangles share a plane."""
_AREA_TOLERANCE = 1e-3
"""Share by which the convex hull of two polygons may exceed their areas."""
_THINNEST = 0.3
"""Distance [m] between opposite faces below which they are the two sides of something solid."""
_SOLID_SHARE = 0.25
"""Share of the surface's area that such sides have from which on the surface counts as that of something solid."""

Points = np.ndarray[Any, np.dtype[np.float64]]


@dataclass
class _Facet:
    vertices: set[int]
    area: float
    normal: Points


def convex_facets(mesh: TriangleMesh) -> list[Points] | None:
    """Return the convex polygons that an open surface consists of.

    Parameters
    ----------
    mesh : TriangleMesh
        Lengths in metres.

    Returns
    -------
    list of (n, 3) arrays or None
        The polygons' vertices; None for a closed surface, one of too many
        faces, and one whose faces are mostly the sides of plates or bars,
        which are solid.
    """
    if len(mesh.faces) > _MAX_TRIANGLES:
        return None
    edges = _shared_edges(mesh)
    if len(edges) == 3 * len(mesh.faces) / 2:
        return None
    facets = _merge(mesh, edges)
    if len(facets) > _MAX_FACETS:
        return None
    polygons = [(mesh.vertices[sorted(facet.vertices)], facet.normal) for facet in facets]
    sides = sum(2 * _opposite_area(one, other) for one, other in itertools.combinations(polygons, 2))
    if sides > _SOLID_SHARE * sum(facet.area for facet in facets):
        return None
    return [vertices for vertices, _ in polygons]


def _shared_edges(mesh: TriangleMesh) -> list[tuple[int, int]]:
    """Return the pairs of triangles that share an edge."""
    triangles: dict[tuple[int, int], list[int]] = {}
    for number, face in enumerate(mesh.faces.tolist()):
        for start, end in itertools.pairwise((*face, face[0])):
            triangles.setdefault((min(start, end), max(start, end)), []).append(number)
    return [(pair[0], pair[1]) for pair in triangles.values() if len(pair) == 2]


def _merge(mesh: TriangleMesh, edges: list[tuple[int, int]]) -> list[_Facet]:
    """Return convex polygons, each of neighbouring triangles in one plane; triangles without area are left out."""
    corners = mesh.vertices[mesh.faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    doubled = np.linalg.norm(normals, axis=1)
    normals /= np.maximum(doubled, 1e-300)[:, None]
    extent = float(np.ptp(mesh.vertices, axis=0).max())
    facets = [
        _Facet(set(face), area / 2, normal)
        for face, area, normal in zip(mesh.faces.tolist(), doubled, normals, strict=True)
    ]
    owner = list(range(len(facets)))
    merged = True
    while merged:
        merged = False
        for one, other in ((facets[owner[a]], facets[owner[b]]) for a, b in edges if owner[a] != owner[b]):
            if not _is_convex_union(mesh.vertices, one, other, _COPLANAR * extent):
                continue
            if one.area < other.area:
                one.normal = other.normal
            one.vertices |= other.vertices
            one.area += other.area
            kept, gone = facets.index(one), facets.index(other)
            owner = [kept if number == gone else number for number in owner]
            merged = True
    return [facets[number] for number in sorted(set(owner)) if facets[number].area > (_COPLANAR * extent) ** 2]


def _is_convex_union(vertices: Points, one: _Facet, other: _Facet, tolerance: float) -> bool:
    from scipy.spatial import ConvexHull, QhullError

    large, small = (one, other) if one.area >= other.area else (other, one)
    points = vertices[sorted(large.vertices | small.vertices)]
    if np.ptp(points @ large.normal) > tolerance or np.linalg.norm(np.cross(one.normal, other.normal)) > _COPLANAR:
        return False
    across = np.linalg.svd(large.normal[None])[2][1:]
    try:
        hull = float(ConvexHull(points @ across.T).volume)  # the area, in a plane
    except QhullError:
        return False
    return hull <= (1 + _AREA_TOLERANCE) * (one.area + other.area)


def _opposite_area(one: tuple[Points, Points], other: tuple[Points, Points]) -> float:
    """Return about how much [m^2] of two polygons lies opposite each other, nearer than `_THINNEST`."""
    (vertices, normal), (opposite, direction) = one, other
    if abs(float(normal @ direction)) < 0.9:
        return 0.0
    distance = abs(float((opposite.mean(axis=0) - vertices.mean(axis=0)) @ normal))
    extent = max(float(np.ptp(vertices, axis=0).max()), float(np.ptp(opposite, axis=0).max()))
    if not _COPLANAR * extent < distance < min(_THINNEST, extent):
        return 0.0
    across = np.linalg.svd(normal[None])[2][1:]
    first, second = vertices @ across.T, opposite @ across.T
    overlap = np.minimum(first.max(axis=0), second.max(axis=0)) - np.maximum(first.min(axis=0), second.min(axis=0))
    return float(np.prod(np.maximum(overlap, 0.0)))
