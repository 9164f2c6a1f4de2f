"""Triangles of mesh files (cached in memory) and of all other shapes."""

from __future__ import annotations

import logging
import re
from collections.abc import Callable
from contextvars import ContextVar
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daidalos.description.errors import DescriptionError
from daidalos.description.geometry import (
    Box,
    Capsule,
    Cone,
    Cylinder,
    Ellipsoid,
    Geometry,
    Mesh,
    Polyline,
    Sphere,
    require_size,
)
from daidalos.description.resolve import texture_file

_log = logging.getLogger(__name__)
_FORMATS = ("stl", "dae", "obj", "gltf", "glb", "ply", "off")


@dataclass(frozen=True, eq=False)
class TriangleMesh:
    """Triangles in the frame of a shape.

    Parameters
    ----------
    vertices : array (n, 3)
        [m].
    faces : array (m, 3) of int32
        Rows of `vertices`, counter-clockwise seen from outside.
    """

    vertices: NDArray[np.float64]
    faces: NDArray[np.int32]


def triangles_of(geometry: Geometry, segments: int = 48) -> TriangleMesh:
    """Return the surface of a shape as triangles.

    Parameters
    ----------
    geometry : Geometry
        Any closed shape; a plane, a heightmap and an empty shape have no closed surface.
    segments : int
        Sides of what is round.

    Returns
    -------
    TriangleMesh

    Raises
    ------
    DescriptionError
        When a mesh file is missing or cannot be read, or a shape has no extent.
    TypeError
        When the shape has no closed surface.
    """
    if isinstance(geometry, Mesh):
        return load_mesh(geometry)
    maker = _MAKERS.get(type(geometry))
    if maker is None:
        raise TypeError(f"a {type(geometry).__name__} has no closed surface")
    require_size(geometry)
    made = maker(geometry, segments)
    return TriangleMesh(np.asarray(made.vertices, dtype=np.float64), np.asarray(made.faces, dtype=np.int32))


def load_mesh(mesh: Mesh) -> TriangleMesh:
    """Read a mesh file with its scale, part and centring applied.

    A mirrored scale turns the triangles round, so that they still look outwards.

    Raises
    ------
    DescriptionError
        When the file is not found, is not a mesh or lacks the part.
    """
    if mesh.path is None:
        raise DescriptionError(f"mesh {mesh.uri} not found", mesh.where)
    whole = _read(mesh.path, mesh.submesh, mesh.path.stat().st_mtime_ns, mesh.where)
    scale = np.array(mesh.scale)
    vertices, faces = whole.vertices, whole.faces
    if mesh.center and len(vertices):
        vertices = vertices - (vertices.min(axis=0) + vertices.max(axis=0)) / 2
    if np.prod(scale) < 0:
        faces = faces[:, ::-1]
    return TriangleMesh(vertices * scale, np.ascontiguousarray(faces))


@lru_cache(maxsize=256)
def _read(path: Path, submesh: str, _modified: int, where: str) -> TriangleMesh:
    """Read all triangles of a file in its own units, or those of one part."""
    import trimesh

    scene = read_scene(path, where)
    parts = [part for names, *part in _parts(scene) if not submesh or submesh in names]
    if submesh and not parts:
        raise DescriptionError(f"mesh {path} has no part {submesh!r}", where)
    if not parts:
        raise DescriptionError(f"mesh {path} holds no triangles", where)
    starts = np.cumsum([0, *(len(vertices) for vertices, _ in parts[:-1])])
    whole = trimesh.Trimesh(
        np.concatenate([vertices for vertices, _ in parts]),
        np.concatenate([faces + start for (_, faces), start in zip(parts, starts, strict=True)]),
        process=False,
    )
    whole.merge_vertices()
    return TriangleMesh(np.asarray(whole.vertices, dtype=np.float64), np.asarray(whole.faces, dtype=np.int32))


class _OneLine(logging.Handler):
    """Handler that logs a message of trimesh as one line with the file that is read, instead of a traceback."""

    def emit(self, record: logging.LogRecord) -> None:
        reason = f": {record.exc_info[1]}" if record.exc_info else ""
        _log.log(record.levelno, "mesh %s: %s", _reading.get(), " ".join(f"{record.getMessage()}{reason}".split()))


_ONE_LINE = _OneLine()
_reading: ContextVar[Path | str] = ContextVar("reading", default="")


def read_scene(path: Path, where: str, with_materials: bool = False) -> Any:
    """Open a mesh file as a trimesh scene, in metres.

    As in RViz, a COLLADA file's unit counts and its up axis does not.

    Raises
    ------
    DescriptionError
        When the file is no mesh; `where` is the place in the description.
    """
    import trimesh

    kind = path.suffix.lower().lstrip(".")
    if kind not in _FORMATS:
        raise DescriptionError(f"mesh {path}: {kind or 'no'} format; known are {', '.join(_FORMATS)}", where)
    log = logging.getLogger("trimesh")
    log.addHandler(_ONE_LINE)
    log.propagate = False
    _reading.set(path)
    try:
        scene = trimesh.load_scene(
            path, file_type=kind, skip_materials=not with_materials, resolver=_texture_resolver(path)
        )
        unit = _collada_unit(path) if kind == "dae" else 1.0
        return scene if unit == 1.0 else scene.scaled(unit)
    except Exception as problem:
        # The readers of the formats raise whatever their file's content leads them to.
        raise DescriptionError(f"mesh {path} cannot be read: {_reason(problem, kind)}", where) from None


def _texture_resolver(path: Path) -> Any:
    """Return what finds the files that a mesh names: beside it, or where Gazebo's models keep textures."""
    from trimesh.resolvers import FilePathResolver

    class Resolver(FilePathResolver):  # type: ignore[misc]  # trimesh's is not typed
        def get(self, name: str) -> bytes:
            named = texture_file(path.parent / name.strip())
            data: bytes = named.read_bytes() if named.is_file() else super().get(name)
            return data

    return Resolver(str(path))


def _reason(problem: Exception, kind: str) -> str:
    """Return why a reader failed; errors that only mean something in its code say that the file is damaged."""
    if isinstance(problem, LookupError | TypeError | AttributeError | AssertionError):
        return f"it is incomplete, damaged or no {kind} file"
    return " ".join(str(problem).split()) or type(problem).__name__


def _collada_unit(path: Path) -> float:
    with path.open("rb") as file:
        found = re.search(rb"<unit\b[^>]*\bmeter\s*=\s*[\"']([^\"']+)", file.read(1 << 16))
    return float(found[1]) if found else 1.0


def _parts(scene: Any) -> list[tuple[tuple[str, str], NDArray[np.float64], NDArray[np.int64]]]:
    """Return every instance in a scene: names of node and geometry, vertices in the scene, faces."""
    parts = []
    for node in scene.graph.nodes_geometry:
        transform, name = scene.graph[node]
        part = scene.geometry[name]
        if hasattr(part, "faces") and len(part.faces):
            vertices = part.vertices @ transform[:3, :3].T + transform[:3, 3]
            faces = part.faces[:, ::-1] if np.linalg.det(transform[:3, :3]) < 0 else part.faces
            parts.append(((str(node), str(name)), np.asarray(vertices), np.asarray(faces)))
    return parts


def _box(shape: Box, _: int) -> Any:
    import trimesh

    return trimesh.creation.box(extents=shape.size)


def _sphere(shape: Sphere, segments: int) -> Any:
    import trimesh

    # trimesh leaves small triangles out, which a small sphere has nothing else than.
    sphere = trimesh.creation.uv_sphere(radius=1.0, count=(segments // 2 + 1, segments))
    return sphere.apply_scale(shape.radius)


def _ellipsoid(shape: Ellipsoid, segments: int) -> Any:
    sphere = _sphere(Sphere(1.0), segments)
    sphere.apply_scale(shape.radii)
    return sphere


def _cylinder(shape: Cylinder, segments: int) -> Any:
    import trimesh

    return trimesh.creation.cylinder(radius=shape.radius, height=shape.length, sections=segments)


def _capsule(shape: Capsule, segments: int) -> Any:
    import trimesh

    capsule = trimesh.creation.capsule(radius=shape.radius, height=shape.length, count=(segments // 2, segments))
    capsule.apply_translation(-capsule.bounds.mean(axis=0))
    return capsule


def _cone(shape: Cone, segments: int) -> Any:
    import trimesh

    cone = trimesh.creation.cone(radius=shape.radius, height=shape.length, sections=segments)
    cone.apply_translation((0, 0, -shape.length / 2))
    return cone


def _polyline(shape: Polyline, _: int) -> Any:
    """Extrude the outlines; further outlines are holes if they lie inside an earlier one."""
    import shapely
    import trimesh

    area = shapely.Polygon()
    for outline in shape.outlines:
        area = area.symmetric_difference(shapely.Polygon(outline).buffer(0))
    polygons = getattr(area, "geoms", [area])
    parts = [_extrude(polygon, shape.height) for polygon in polygons if polygon.area > 0]
    return trimesh.util.concatenate(parts)


def _extrude(polygon: Any, height: float) -> Any:
    """Extrude a polygon with holes; the flat ends are its constrained triangulation."""
    import shapely
    import trimesh

    triangles = shapely.constrained_delaunay_triangles(shapely.geometry.polygon.orient(polygon))
    corners = np.array([t.exterior.coords[:3] for t in triangles.geoms], dtype=np.float64)[:, :, :2]
    vertices, index = np.unique(corners.reshape(-1, 2), axis=0, return_inverse=True)
    faces = index.reshape(-1, 3)
    return trimesh.creation.extrude_triangulation(vertices, faces, height=height)


_MAKERS: dict[type, Callable[[Any, int], Any]] = {
    Box: _box,
    Sphere: _sphere,
    Ellipsoid: _ellipsoid,
    Cylinder: _cylinder,
    Capsule: _capsule,
    Cone: _cone,
    Polyline: _polyline,
}
