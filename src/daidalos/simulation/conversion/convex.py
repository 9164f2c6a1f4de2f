"""Convex parts of meshes: MuJoCo collides with convex shapes only. Results are kept on disk."""

from __future__ import annotations

import hashlib
import os
import sys
import tempfile
import zipfile
from pathlib import Path
from typing import Any

import numpy as np

from daidalos.description.meshes import TriangleMesh

CONVEX_ENOUGH = 0.95
"""A mesh that fills this share of its convex hull is taken as convex."""

_FLAT = 1e-9


def convex_parts(mesh: TriangleMesh, key: str) -> tuple[list[TriangleMesh], bool]:
    """Split a mesh into convex parts.

    Parameters
    ----------
    mesh : TriangleMesh
    key : str
        `content_key` of the mesh.

    Returns
    -------
    parts : list of TriangleMesh
        By approximate convex decomposition (CoACD, Wei et al. 2022) where the mesh is not convex.
    concave : bool
        Whether they differ from the mesh.
    """
    import trimesh

    hull = _hull(mesh.vertices)
    solid = trimesh.Trimesh(mesh.vertices, mesh.faces, process=True)
    if solid.is_watertight and abs(solid.volume) >= CONVEX_ENOUGH * trimesh.Trimesh(hull.vertices, hull.faces).volume:
        return [hull], False
    file = cache_folder() / "convex" / f"{key}.npz"
    parts = _load(file)
    if parts is None:
        parts = _decompose(solid) or [hull]
        _save(file, parts)
    return parts, True


def content_key(mesh: TriangleMesh) -> str:
    """Return a short name for the content of a mesh."""
    digest = hashlib.sha256(np.ascontiguousarray(mesh.vertices, dtype=np.float32).tobytes())
    digest.update(np.ascontiguousarray(mesh.faces, dtype=np.int32).tobytes())
    return digest.hexdigest()[:24]


def cache_folder() -> Path:
    """Return the folder for what can be made again: ``DAIDALOS_CACHE``, else the system's."""
    chosen = os.environ.get("DAIDALOS_CACHE")
    if chosen:
        return Path(chosen)
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA", Path.home() / "AppData" / "Local")) / "daidalos"
    if sys.platform == "darwin":
        return Path.home() / "Library" / "Caches" / "daidalos"
    return Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache")) / "daidalos"


def _hull(vertices: np.ndarray) -> TriangleMesh:
    """Return the convex hull; a flat mesh is given the thickness that a hull needs."""
    import trimesh

    extent = vertices.max(axis=0) - vertices.min(axis=0)
    thin = extent < max(1e-4 * float(extent.max()), 1e-6)
    if thin.any():
        thickness = np.where(thin, max(1e-3 * float(extent.max()), 1e-5), 0.0)
        vertices = np.concatenate((vertices - thickness / 2, vertices + thickness / 2))
    hull = trimesh.convex.convex_hull(vertices)
    return TriangleMesh(np.asarray(hull.vertices, dtype=np.float64), np.asarray(hull.faces, dtype=np.int32))


def _decompose(solid: Any) -> list[TriangleMesh]:
    import coacd

    coacd.set_log_level("error")
    mesh = coacd.Mesh(solid.vertices, solid.faces)
    found = coacd.run_coacd(mesh, threshold=0.05, seed=0, max_ch_vertex=64)
    return [
        TriangleMesh(np.asarray(vertices, dtype=np.float64), np.asarray(faces, dtype=np.int32))
        for vertices, faces in found
        if len(vertices) >= 4
    ]


def _load(file: Path) -> list[TriangleMesh] | None:
    try:
        with np.load(file) as arrays:
            count = len(arrays.files) // 2
            return [TriangleMesh(arrays[f"vertices{i}"], arrays[f"faces{i}"]) for i in range(count)]
    except (OSError, ValueError, KeyError, zipfile.BadZipFile):
        return None


def _save(file: Path, parts: list[TriangleMesh]) -> None:
    """Write the parts; a reader never sees half a file. A folder that can not be written is no harm."""
    arrays: dict[str, Any] = {f"vertices{i}": part.vertices for i, part in enumerate(parts)}
    arrays |= {f"faces{i}": part.faces for i, part in enumerate(parts)}
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile(dir=file.parent, suffix=".npz", delete=False) as draft:
            np.savez_compressed(draft, **arrays)
        os.replace(draft.name, file)
    except OSError:
        return
