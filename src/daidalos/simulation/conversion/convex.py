"""Convex decomposition of meshes, which MuJoCo needs for collisions; results are cached on disk."""

from __future__ import annotations

import hashlib
import itertools
import logging
import os
import tempfile
import zipfile
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from daidalos.common.cache_folder import cache_folder
from daidalos.description.meshes import TriangleMesh
from daidalos.simulation.conversion import decomposition
from daidalos.simulation.conversion.decomposition import check_cancelled

CONVEX_ENOUGH = 0.95
"""Volume ratio to its convex hull from which a mesh counts as convex."""

MAX_HULLS = 24
"""Number of pieces above which a mesh gets one hull around all of them, unless it is to be decomposed."""

_log = logging.getLogger(__name__)


def split_pieces(pieces: list[TriangleMesh], is_cancelled: Callable[[], bool]) -> list[list[TriangleMesh]]:
    """Return the convex parts that each piece is split into by `decomposition`.

    Raises
    ------
    decomposition.Cancelled
    """
    return [[hull_of_points(points) for points in decomposition.decompose(piece, is_cancelled)] for piece in pieces]


def convex_parts(
    mesh: TriangleMesh,
    key: str,
    decompose: bool,
    is_cancelled: Callable[[], bool] = lambda: False,
    split: Callable[[list[TriangleMesh], Callable[[], bool]], list[list[TriangleMesh]]] = split_pieces,
) -> tuple[list[TriangleMesh], bool]:
    """Split a mesh into convex parts.

    Parameters
    ----------
    mesh : TriangleMesh
    key : str
        `content_key` of the mesh.
    decompose : bool
        Split pieces that are not convex by `decomposition`; otherwise
        each piece gets its convex hull.
    is_cancelled : callable
        Asked often; see `decomposition.Cancelled`.
    split : callable
        Splits what is not convex, maybe in another process.

    Returns
    -------
    parts : list of TriangleMesh
    concave : bool
        Whether they differ from the mesh.

    Raises
    ------
    decomposition.Cancelled
    """
    check_cancelled(is_cancelled)
    pieces = connected_pieces(mesh)
    check_cancelled(is_cancelled)
    if not decompose and len(pieces) > MAX_HULLS:
        return [hull_of_points(mesh.vertices)], True
    hulls = [hull_of_points(piece.vertices) for piece in pieces]
    check_cancelled(is_cancelled)
    convex = [_is_convex(piece, hull) for piece, hull in zip(pieces, hulls, strict=True)]
    if all(convex) or not decompose:
        return hulls, not all(convex)
    file = cache_folder() / "convex" / f"{key}-{decomposition.VERSION}.npz"
    parts = _load(file)
    if parts is None:
        _log.info("splitting a mesh of %d triangles into convex parts; the result is kept", len(mesh.faces))
        concave = [piece for piece, is_convex in zip(pieces, convex, strict=True) if not is_convex]
        splits = iter(split(concave, is_cancelled))
        parts = []
        for hull, is_convex in zip(hulls, convex, strict=True):
            parts += [hull] if is_convex else next(splits)
        _save(file, parts)
    return parts, True


def connected_pieces(mesh: TriangleMesh) -> list[TriangleMesh]:
    """Return the parts of a mesh that share no vertex."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    edges = np.concatenate((mesh.faces[:, :2], mesh.faces[:, 1:]))
    size = len(mesh.vertices)
    graph = coo_array((np.ones(len(edges), dtype=bool), (edges[:, 0], edges[:, 1])), shape=(size, size))
    count, label = connected_components(graph, directed=False)
    if count == 1:
        return [mesh]
    order = np.argsort(label[mesh.faces[:, 0]], kind="stable")
    faces = mesh.faces[order]
    starts = np.searchsorted(label[faces[:, 0]], np.arange(count + 1))
    pieces = []
    for first, last in itertools.pairwise(starts):
        used, index = np.unique(faces[first:last], return_inverse=True)
        if len(used) >= 3:
            pieces.append(TriangleMesh(mesh.vertices[used], index.reshape(-1, 3).astype(np.int32)))
    return pieces


def _is_convex(piece: TriangleMesh, hull: TriangleMesh) -> bool:
    if len(hull.vertices) > len(piece.vertices):
        return True  # a flat piece, whose hull was given a thickness
    edges = np.sort(np.concatenate((piece.faces[:, :2], piece.faces[:, 1:], piece.faces[:, ::2])), axis=1)
    _, shared = np.unique(edges, axis=0, return_counts=True)
    return bool((shared == 2).all() and abs(_volume(piece)) >= CONVEX_ENOUGH * _volume(hull))


def _volume(mesh: TriangleMesh) -> float:
    """Return the volume inside a closed surface by the divergence theorem."""
    a, b, c = mesh.vertices[mesh.faces].transpose(1, 0, 2)
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)


def content_key(mesh: TriangleMesh) -> str:
    """Return a short key of a mesh's content."""
    digest = hashlib.sha256(np.ascontiguousarray(mesh.vertices, dtype=np.float32).tobytes())
    digest.update(np.ascontiguousarray(mesh.faces, dtype=np.int32).tobytes())
    return digest.hexdigest()[:24]


def hull_of_points(vertices: np.ndarray) -> TriangleMesh:
    """Return the convex hull; flat meshes are thickened to the minimum that a solid needs."""
    from scipy.spatial import ConvexHull

    center = vertices.mean(axis=0)
    # The small triangular factor has the singular values and axes of all vertices.
    _, spread, axes = np.linalg.svd(np.linalg.qr(vertices - center, mode="r"), full_matrices=True)
    spread = np.concatenate((spread, np.zeros(3)))[:3]
    size = float(np.ptp(vertices, axis=0).max())
    for axis in axes[spread < max(1e-4 * float(spread[0]), 1e-9)]:
        step = max(5e-4 * size, 1e-5) * axis
        vertices = np.concatenate((vertices - step, vertices + step))
    hull = ConvexHull(vertices, qhull_options="QJ")
    used, index = np.unique(hull.simplices, return_inverse=True)
    faces = index.reshape(-1, 3).astype(np.int32)
    corners = vertices[used][faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    inwards = np.einsum("ij,ij->i", normals, hull.equations[:, :3]) < 0
    faces[inwards] = faces[inwards][:, ::-1]
    return TriangleMesh(vertices[used], faces)


def _load(file: Path) -> list[TriangleMesh] | None:
    try:
        with np.load(file) as arrays:
            count = len(arrays.files) // 2
            return [TriangleMesh(arrays[f"vertices{i}"], arrays[f"faces{i}"]) for i in range(count)]
    except (OSError, EOFError, ValueError, KeyError, zlib.error, zipfile.BadZipFile):
        return None


def _save(file: Path, parts: list[TriangleMesh]) -> None:
    """Write the parts atomically; an unwritable folder and a full disk are ignored."""
    arrays: dict[str, Any] = {f"vertices{i}": part.vertices for i, part in enumerate(parts)}
    arrays |= {f"faces{i}": part.faces for i, part in enumerate(parts)}
    name = ""
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile(dir=file.parent, suffix=".tmp", delete=False) as draft:
            name = draft.name
            np.savez_compressed(draft, **arrays)
        os.replace(name, file)
    except OSError:
        if name:
            Path(name).unlink(missing_ok=True)
