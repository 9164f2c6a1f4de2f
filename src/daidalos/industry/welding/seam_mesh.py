"""Seams along sharp edges of meshes."""

from __future__ import annotations

import itertools
import math
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daidalos.common.errors import UserError
from daidalos.industry.welding.seam import Seam

SUFFIXES = (".stl", ".obj", ".ply")
SHARP_ANGLE = math.radians(20.0)
"""Angle between two faces from which on their edge is sharp [rad]."""


def read_seam_mesh(path: Path, picks: list[tuple[float, float, float]], scale: float) -> Seam:
    """Return the seam along the sharp edges of a mesh between points picked on them.

    The normals are those of that face at each edge which looks more upwards (z of the base).

    Parameters
    ----------
    path : Path
        A mesh.
    picks : list of points
        At least two, in the unit of the mesh; the seam leads along sharp edges from the vertex nearest to the first to
        that nearest to the second, and so on.
    scale : float
        Metres per unit of the mesh.

    Raises
    ------
    UserError
        Where it is no mesh, has no sharp edges, or they do not connect the points.
    """
    mesh = _load(path)
    edges, normals = _sharp_edges(mesh)
    if not len(edges):
        raise UserError(f"{path}: has no edge with more than {math.degrees(SHARP_ANGLE):g} deg between its faces")
    vertices = np.asarray(mesh.vertices)
    check_picks(picks, vertices[edges], str(path))
    return seam_along(vertices, edges, normals, picks, scale, str(path))


def check_picks(picks: list[tuple[float, float, float]], ends: NDArray[np.float64], source: str) -> None:
    """Raise a UserError where there are fewer than two picks; it proposes the longest of the edges' ends (m, 2, 3)."""
    if len(picks) < 2:
        longest = ends[int(np.argmax(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)))]
        first, second = (",".join(f"{value:g}" for value in end) for end in longest)
        raise UserError(f"{source}: where does the seam run? Its longest sharp edge is --pick {first} --pick {second}")


def seam_along(
    vertices: NDArray[np.float64],
    edges: NDArray[np.int64],
    normals: NDArray[np.float64],
    picks: list[tuple[float, float, float]],
    scale: float,
    source: str,
) -> Seam:
    """Return the shortest seam along edges between picked points.

    Parameters
    ----------
    vertices : array of shape (n, 3)
        In the unit of the picks.
    edges : array of shape (m, 2)
        Indices of vertices.
    normals : array of shape (m, 3)
        Of the edges.
    picks : list of points
        At least two; see `check_picks`.
    scale : float
        Metres per unit.
    source : str
        Of the edges, for errors.

    Raises
    ------
    UserError
        Where no edges connect the points.
    """
    indices = _shortest_path(vertices, edges, np.array(picks), source)
    at_edge = {tuple(sorted(edge)): normal for edge, normal in zip(edges.tolist(), normals, strict=True)}
    along = np.array([at_edge[tuple(sorted(pair))] for pair in itertools.pairwise(indices)])
    at_points = np.concatenate([along[:1], along[:-1] + along[1:], along[-1:]])
    at_points /= np.linalg.norm(at_points, axis=1, keepdims=True)
    return Seam(scale * vertices[indices], at_points)


def _load(path: Path) -> Any:
    import trimesh

    try:
        mesh = trimesh.load(path, force="mesh", process=True)
        mesh.merge_vertices(merge_norm=True, merge_tex=True)
    except Exception as error:  # trimesh's readers raise whatever their parsers do
        raise UserError(
            f"{path}: is no mesh: {str(error).splitlines()[0] if str(error) else type(error).__name__}"
        ) from None
    if not len(mesh.faces) or not np.isfinite(mesh.vertices).all():
        raise UserError(f"{path}: has no faces, or vertices that are not finite")
    return mesh


def _sharp_edges(mesh: Any) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Return the sharp edges (m, 2) and the normal (m, 3) of that face of each that looks more upwards."""
    sharp = np.asarray(mesh.face_adjacency_angles) > SHARP_ANGLE
    edges = np.asarray(mesh.face_adjacency_edges)[sharp]
    faces = np.asarray(mesh.face_adjacency)[sharp]
    normals = np.asarray(mesh.face_normals)[faces]
    upper = np.argmax(normals[:, :, 2], axis=1)
    return edges, normals[np.arange(len(edges)), upper]


def _shortest_path(
    vertices: NDArray[np.float64], edges: NDArray[np.int64], picks: NDArray[np.float64], source: str
) -> list[int]:
    """Return the vertices along edges through those that are nearest to points."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import dijkstra

    lengths = np.linalg.norm(vertices[edges[:, 0]] - vertices[edges[:, 1]], axis=1)
    size = len(vertices)
    graph = coo_matrix((lengths, (edges[:, 0], edges[:, 1])), shape=(size, size)).tocsr()
    on_edges = np.unique(edges)
    nearest = [int(on_edges[np.argmin(np.linalg.norm(vertices[on_edges] - pick, axis=1))]) for pick in picks]
    out = [nearest[0]]
    for start, end in itertools.pairwise(nearest):
        _, before = dijkstra(graph, directed=False, indices=start, return_predecessors=True)
        part = [end]
        while part[-1] != start:
            previous = int(before[part[-1]])
            if previous < 0:
                raise UserError(
                    f"{source}: no sharp edges connect {vertices[start].tolist()} and {vertices[end].tolist()}"
                )
            part.append(previous)
        out += part[-2::-1]
    return out
