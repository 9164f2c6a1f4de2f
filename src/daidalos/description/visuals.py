"""Geometry of visuals for renderers: triangles with normals, colours and textures."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daidalos.common.pose3 import quaternion_between, rotation_matrix
from daidalos.description.errors import DescriptionError
from daidalos.description.geometry import Box, Empty, Heightmap, Mesh, Plane
from daidalos.description.images import read_grey, read_rgba
from daidalos.description.link import Material, Rgba, Visual
from daidalos.description.meshes import read_scene, triangles_of

GREY: Rgba = (0.7, 0.7, 0.7, 1.0)
WHITE: Rgba = (1.0, 1.0, 1.0, 1.0)

_CREASE = 0.76
"""Cosine of the angle between triangles from which on an edge is seen: 40 degrees."""

_MAX_CORNERS = 256


@dataclass(frozen=True, eq=False)
class Part:
    """Triangles of one material.

    Parameters
    ----------
    vertices : array (n, 3) of float32
        In the visual's frame [m].
    normals : array (n, 3) of float32
    faces : array (m, 3) of int32
    color : tuple of 4 floats
        Red, green, blue, alpha in 0..1; multiplies the texture.
    uv : array (n, 2) of float32 or None
        Texture coordinates, v upwards.
    texture : array (rows, columns, 4) of uint8 or None
        The top row first.
    """

    vertices: NDArray[np.float32]
    normals: NDArray[np.float32]
    faces: NDArray[np.int32]
    color: Rgba
    uv: NDArray[np.float32] | None = None
    texture: NDArray[np.uint8] | None = None


def visual_parts(visual: Visual, segments: int = 32) -> tuple[Part, ...]:
    """Return the parts of a visual.

    A mesh keeps the colours of its file unless the description's material overrides them, as SDF's
    and Gazebo's do and URDF's do not.

    Parameters
    ----------
    visual : Visual
    segments : int
        Sides of what is round.

    Raises
    ------
    DescriptionError
        When a mesh or an image is missing or cannot be read.
    """
    shape, material = visual.geometry, visual.material
    if isinstance(shape, Empty):
        return ()
    if isinstance(shape, Mesh):
        if shape.path is None:
            raise DescriptionError(f"mesh {shape.uri} not found", shape.where)
        found = _mesh_parts(shape.path, shape.submesh, shape.path.stat().st_mtime_ns, shape.where)
        parts = [_shaped(part, shape) for part in found]
    elif isinstance(shape, Plane):
        parts = [_plane(shape)]
    elif isinstance(shape, Heightmap):
        parts = [_terrain(shape)]
    else:
        mesh = triangles_of(shape, segments)
        parts = [_wrapped(_flat(mesh.vertices, mesh.faces), boxed=isinstance(shape, Box))]
    return tuple(_painted(part, material, visual.transparency, isinstance(shape, Mesh)) for part in parts)


@lru_cache(maxsize=128)
def _mesh_parts(path: Path, submesh: str, _modified: int, where: str) -> tuple[Part, ...]:
    scene = read_scene(path, where, with_materials=True)
    parts = []
    for node in scene.graph.nodes_geometry:
        transform, name = scene.graph[node]
        geometry = scene.geometry[name]
        if hasattr(geometry, "faces") and (not submesh or submesh in (str(node), str(name))):
            part = _textured(geometry, np.asarray(transform))
            if path.suffix.lower() == ".stl":
                # Such a file has no normals of vertices: edges would look smeared.
                part = replace(_flat(part.vertices.astype(np.float64), part.faces), color=part.color)
            parts.append(part)
    if not any(len(part.faces) for part in parts):
        raise DescriptionError(f"mesh {path} {f'has no part {submesh!r}' if submesh else 'holds no triangles'}", where)
    return tuple(parts)


def _textured(geometry: Any, transform: NDArray[np.float64]) -> Part:
    rotation = transform[:3, :3]
    vertices = geometry.vertices @ rotation.T + transform[:3, 3]
    normals = geometry.vertex_normals @ np.linalg.inv(rotation)
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    faces = geometry.faces[:, ::-1] if np.linalg.det(rotation) < 0 else geometry.faces
    material = getattr(geometry.visual, "material", None)
    uv = getattr(geometry.visual, "uv", None)
    # Without a material of its own a mesh has no colour; -1 marks what the description may fill in.
    color: Rgba = (-1.0, -1.0, -1.0, 1.0)
    source = material if material is not None else (geometry.visual if geometry.visual.defined else None)
    if source is not None:
        red, green, blue, alpha = (float(value) / 255 for value in source.main_color)
        color = (red, green, blue, alpha)
    image = getattr(material, "image", None) or getattr(material, "baseColorTexture", None)
    return Part(
        vertices.astype(np.float32),
        (normals / np.where(lengths == 0, 1, lengths)).astype(np.float32),
        np.ascontiguousarray(faces, dtype=np.int32),
        color,
        None if uv is None else np.asarray(uv, dtype=np.float32),
        None if image is None else np.asarray(image.convert("RGBA"), dtype=np.uint8),
    )


def _shaped(part: Part, mesh: Mesh) -> Part:
    """Apply the description's centring and scale."""
    scale = np.array(mesh.scale, dtype=np.float32)
    if not scale.all():
        raise DescriptionError(f"mesh {mesh.uri} has a scale of zero", mesh.where)
    vertices = part.vertices
    if mesh.center:
        vertices = vertices - (vertices.min(axis=0) + vertices.max(axis=0)) / 2
    normals = part.normals / scale
    normals = normals / np.linalg.norm(normals, axis=1, keepdims=True).clip(1e-12)
    faces = part.faces[:, ::-1] if np.prod(scale) < 0 else part.faces
    return replace(part, vertices=vertices * scale, normals=normals, faces=np.ascontiguousarray(faces))


def _flat(vertices: NDArray[np.float64], faces: NDArray[np.int32]) -> Part:
    """Return triangles with separate corners, whose normals are smooth over edges of less than 40 degrees."""
    corners = vertices[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas = np.linalg.norm(normals, axis=1, keepdims=True)
    unit = normals / np.where(areas == 0, 1, areas)
    _, place = np.unique(np.round(corners.reshape(-1, 3), 6), axis=0, return_inverse=True)
    place = place.ravel()
    owner = np.repeat(np.arange(len(faces)), 3)
    first, second = _pairs(place)
    alike = np.einsum("ij,ij->i", unit[owner[first]], unit[owner[second]]) > _CREASE
    first, second = first[alike], second[alike]
    sums = [np.bincount(first, normals[owner[second], axis], minlength=len(owner)) for axis in range(3)]
    smooth: NDArray[np.float64] = np.stack(sums, axis=1).astype(np.float64)
    smooth = smooth / np.linalg.norm(smooth, axis=1, keepdims=True).clip(1e-12)
    triangles = np.arange(len(owner), dtype=np.int32).reshape(-1, 3)
    return Part(corners.reshape(-1, 3).astype(np.float32), smooth.astype(np.float32), triangles, GREY)


def _pairs(place: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return all pairs of corners, including equal ones, at the same position.

    Where very many meet, such as in the tip of a finely cut cone, each is paired with itself alone.
    """
    order = np.argsort(place, kind="stable")
    starts = np.searchsorted(place[order], np.arange(place.max(initial=-1) + 2))
    counts = np.diff(starts)[place]
    counts[counts > _MAX_CORNERS] = 1
    first = np.repeat(np.arange(len(place)), counts)
    step = np.arange(len(first)) - np.repeat(np.cumsum(counts) - counts, counts)
    alone = counts[first] == 1
    second = np.where(alone, first, order[np.minimum(starts[place[first]] + step, len(place) - 1)])
    return first, second


def _wrapped(part: Part, boxed: bool) -> Part:
    """Return a shape's texture coordinates: an image per side of a box, wrapped around z on round shapes.

    What points up or down is seen from above; images stand upright on the sides, seen from outside.
    """
    corners = part.vertices[part.faces].astype(np.float64)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lowest, extent = part.vertices.min(axis=0), np.ptp(part.vertices, axis=0).clip(1e-12)
    x, y, z = np.moveaxis((corners - lowest) / extent, -1, 0)
    side = np.abs(normals).argmax(axis=1)[:, None]
    ahead = np.take_along_axis(normals, side, axis=1) > 0
    flat = np.where(ahead, x, 1 - x), y
    if boxed:
        u = np.where(side == 0, np.where(ahead, y, 1 - y), np.where(side == 1, np.where(ahead, 1 - x, x), flat[0]))
        v = np.where(side == 2, flat[1], z)
    else:
        turn = np.arctan2(corners[..., 1], corners[..., 0]) / (2 * np.pi) + 0.5
        # A triangle across the seam goes on beyond 1; textures repeat.
        turn = np.where((np.ptp(turn, axis=1, keepdims=True) > 0.5) & (turn < 0.5), turn + 1, turn)
        lid = (np.ptp(z, axis=1, keepdims=True) < 1e-6) & (side == 2)
        u, v = np.where(lid, flat[0], turn), np.where(lid, flat[1], z)
    return replace(part, uv=np.stack((u, v), axis=-1).reshape(-1, 2).astype(np.float32))


def _plane(plane: Plane) -> Part:
    turn = rotation_matrix(quaternion_between((0.0, 0.0, 1.0), plane.normal))
    x, y = plane.size[0] / 2, plane.size[1] / 2
    corners = np.array([(-x, -y, 0), (x, -y, 0), (x, y, 0), (-x, y, 0)]) @ turn.T
    normals = np.tile(np.array(plane.normal, dtype=np.float32), (4, 1))
    faces = np.array([(0, 1, 2), (0, 2, 3)], dtype=np.int32)
    uv = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], dtype=np.float32)
    return Part(corners.astype(np.float32), normals, faces, GREY, uv)


def _terrain(shape: Heightmap) -> Part:
    if shape.path is None:
        raise DescriptionError(f"heightmap {shape.uri} not found", shape.where)
    heights = read_grey(shape.path, shape.where)[::-1]
    rows, columns = heights.shape
    y, x = np.mgrid[-0.5 : 0.5 : rows * 1j, -0.5 : 0.5 : columns * 1j]
    points = np.stack((x * shape.size[0], y * shape.size[1], heights * shape.size[2]), axis=-1)
    slope_y, slope_x = np.gradient(points[:, :, 2], shape.size[1] / (rows - 1), shape.size[0] / (columns - 1))
    normals = np.stack((-slope_x, -slope_y, np.ones_like(slope_x)), axis=-1)
    normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
    corner = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).ravel()
    lower = np.stack((corner, corner + 1, corner + columns + 1), axis=1)
    upper = np.stack((corner, corner + columns + 1, corner + columns), axis=1)
    vertices = points.reshape(-1, 3) + shape.position
    uv = np.stack((x + 0.5, y + 0.5), axis=-1).reshape(-1, 2)
    return Part(
        vertices.astype(np.float32),
        normals.reshape(-1, 3).astype(np.float32),
        np.concatenate((lower, upper)).astype(np.int32),
        GREY,
        uv.astype(np.float32),
    )


def _painted(part: Part, material: Material | None, transparency: float, is_mesh: bool) -> Part:
    """Apply the description's material where it takes precedence."""
    uncolored = part.color[0] < 0
    overrides = material is not None and (uncolored or not is_mesh or material.ambient is not None)
    color = part.color if not uncolored else GREY
    texture = part.texture
    if material is not None and overrides:
        color = material.color or color
        if material.texture_path is not None and part.uv is not None:
            texture = read_rgba(material.texture_path)
            color = material.color or WHITE
        elif material.color is not None:
            texture = None
    red, green, blue, alpha = color
    return replace(part, color=(red, green, blue, alpha * (1 - transparency)), texture=texture)
