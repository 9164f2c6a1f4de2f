"""Visible geometry of a simulation as arrays for the rasterizer."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.pose3 import Pose
from daidalos.description.errors import DescriptionError
from daidalos.description.geometry import Mesh
from daidalos.description.link import Visual
from daidalos.description.visuals import Part, visual_parts
from daidalos.simulation.rendering.textures import TextureAtlas, make_atlas

Floats = NDArray[np.float32]
T = TypeVar("T")

UNLABELLED = 0
_ALL = 0xFFFFFFFF


@dataclass(frozen=True)
class Item:
    """Visual in the simulation.

    Parameters
    ----------
    visual : Visual
    body : int
        The body in MuJoCo's arrays that carries it.
    owner : int
        Number of its model.
    label : int
        Class that a segmentation camera reports.
    """

    visual: Visual
    body: int
    owner: int
    label: int


@dataclass(frozen=True, eq=False)
class Scene:
    """Triangles of n parts; parts of the same shape, such as those of equal robots, share v vertices and f faces.

    Parameters
    ----------
    vertices, normals : array (v, 3) of float32
        In the parts' frames.
    uv : array (v, 2) of float32
    faces : array (f, 3) of int32
    planes : array (f, 4) of float32
        Normal of each triangle, of any length, and its scalar product with the triangle's points.
    face_part : array (t,) of int32
        The part of each triangle, where those of all parts are counted one after the other.
    body : array (n,) of int64
    pose : array (n, 3, 4)
        Of each part in its body.
    spheres : array (n, 4)
        Centre and radius of a ball around each part, in its frame.
    face_ranges : array (n, 2) of int64
        First triangle of each part, and the one behind its last, in the order of `face_part`.
    face_rows : array (n,) of int64
        Row in `faces` of each part's first triangle.
    vertex_ranges : array (n, 2) of int64
        First row in `vertices` of each part, and the one behind its last.
    two_sided, opaque, visible, casts : array (n,) of bool
    colors, emissions : array (n, 3) of float32
    alphas : array (n,) of float32
    texture_of : array (n,) of int32
    flags : array (n,) of uint32
        Visibility flags; a camera sees a part when its mask has a bit in common.
    labels, owners : array (n,) of int32
    atlas : TextureAtlas
    shared : dict
        What the renderers of the scene share, by its class; it is theirs.
    """

    vertices: Floats
    normals: Floats
    uv: Floats
    faces: NDArray[np.int32]
    planes: Floats
    face_part: NDArray[np.int32]
    body: NDArray[np.int64]
    pose: Array
    spheres: Array
    face_ranges: NDArray[np.int64]
    face_rows: NDArray[np.int64]
    vertex_ranges: NDArray[np.int64]
    two_sided: NDArray[np.bool_]
    opaque: NDArray[np.bool_]
    visible: NDArray[np.bool_]
    casts: NDArray[np.bool_]
    colors: NDArray[np.float32]
    emissions: NDArray[np.float32]
    alphas: NDArray[np.float32]
    texture_of: NDArray[np.int32]
    flags: NDArray[np.uint32]
    labels: NDArray[np.int32]
    owners: NDArray[np.int32]
    atlas: TextureAtlas
    shared: dict[Any, Any] = field(default_factory=dict)

    def share(self, kind: Callable[[Scene], T]) -> T:
        """Return the object of a class that all renderers of the scene share, made at the first call."""
        found: T | None = self.shared.get(kind)
        if found is None:
            found = self.shared[kind] = kind(self)
        return found


def make_scene(items: Iterable[Item], warn: Callable[[str], None]) -> Scene:
    """Collect the triangles of visuals.

    Parameters
    ----------
    items : iterable of Item
    warn : callable
        Called with a line for each visual that cannot be drawn; it is left out.
    """
    pairs: list[tuple[Item, Part]] = []
    for item in items:
        try:
            parts = _parts(replace(item.visual, pose=Pose(), name="", label=None))
        except DescriptionError as problem:
            warn(f"{problem}; the visual is not drawn")
            continue
        pairs += [(item, part) for part in parts if len(part.faces)]
    images: dict[int, NDArray[np.uint8]] = {id(p.texture): p.texture for _, p in pairs if p.texture is not None}
    numbers = {key: number for number, key in enumerate(images)}
    shapes = list({id(part): part for _, part in pairs}.values())
    shape_of = _numbers([id(shape) for shape in shapes], [id(part) for _, part in pairs])
    vertex_ranges = _ranges([len(shape.vertices) for shape in shapes])
    face_ranges = _ranges([len(part.faces) for _, part in pairs])
    alphas = np.array([part.color[3] for _, part in pairs], dtype=np.float32)
    uvs = (np.zeros((len(part.vertices), 2), dtype=np.float32) if part.uv is None else part.uv for part in shapes)
    faces = (part.faces + first for part, (first, _) in zip(shapes, vertex_ranges, strict=True))
    return Scene(
        vertices=_stack((part.vertices for part in shapes), 3, np.float32),
        normals=_stack((part.normals for part in shapes), 3, np.float32),
        uv=_stack(uvs, 2, np.float32),
        faces=_stack(faces, 3, np.int32),
        planes=_stack((_planes(part) for part in shapes), 4, np.float32),
        face_part=np.repeat(np.arange(len(pairs), dtype=np.int32), np.diff(face_ranges).ravel()),
        body=np.array([item.body for item, _ in pairs], dtype=np.int64),
        pose=np.array([item.visual.pose.matrix[:3] for item, _ in pairs]).reshape(-1, 3, 4),
        spheres=np.array([_ball(part.vertices) for _, part in pairs]).reshape(-1, 4),
        face_ranges=face_ranges,
        face_rows=_ranges([len(shape.faces) for shape in shapes])[shape_of, 0],
        vertex_ranges=vertex_ranges[shape_of],
        two_sided=np.array([_open(item, part) for item, part in pairs], dtype=np.bool_),
        opaque=alphas >= 1.0,
        visible=alphas > 0.0,
        casts=np.array([item.visual.cast_shadows for item, _ in pairs], dtype=np.bool_) & (alphas >= 1.0),
        colors=np.array([part.color[:3] for _, part in pairs], dtype=np.float32).reshape(-1, 3),
        emissions=np.array([_emission(item.visual) for item, _ in pairs], dtype=np.float32).reshape(-1, 3),
        alphas=alphas,
        texture_of=np.array([-1 if p.texture is None else numbers[id(p.texture)] for _, p in pairs], dtype=np.int32),
        flags=np.array([item.visual.visibility_flags & _ALL for item, _ in pairs], dtype=np.uint32),
        labels=np.array([item.label for item, _ in pairs], dtype=np.int32),
        owners=np.array([item.owner for item, _ in pairs], dtype=np.int32),
        atlas=make_atlas(list(images.values())),
    )


def _ranges(counts: list[int]) -> NDArray[np.int64]:
    """Return the first row and the one behind the last (n, 2) of blocks that lie one behind the other."""
    ends = np.cumsum(counts, dtype=np.int64)
    return np.stack((ends - np.array(counts, dtype=np.int64), ends), axis=1)


def _numbers(known: list[int], keys: list[int]) -> NDArray[np.int64]:
    """Return the places (n,) of keys among known ones."""
    places = {key: place for place, key in enumerate(known)}
    return np.array([places[key] for key in keys], dtype=np.int64)


@lru_cache(maxsize=512)
def _parts(visual: Visual) -> tuple[Part, ...]:
    """Return the parts of a visual, with identical vertices merged."""
    return tuple(_merged(part) for part in visual_parts(visual))


def _merged(part: Part) -> Part:
    columns = [part.vertices, part.normals] + ([] if part.uv is None else [part.uv])
    rows = np.ascontiguousarray(np.concatenate(columns, axis=1, dtype=np.float32) + np.float32(0.0))
    keys = rows.view(np.dtype((np.void, rows.dtype.itemsize * rows.shape[1]))).ravel()
    _, first, place = np.unique(keys, return_index=True, return_inverse=True)
    return replace(
        part,
        vertices=part.vertices[first],
        normals=part.normals[first],
        uv=None if part.uv is None else part.uv[first],
        faces=place.ravel()[part.faces].astype(np.int32),
    )


def _open(item: Item, part: Part) -> bool:
    """Return whether a part must be drawn from both sides, since its triangles may be oriented either way."""
    return isinstance(item.visual.geometry, Mesh) and not _is_closed(part)


@lru_cache(maxsize=1024)
def _is_closed(part: Part) -> bool:
    """Return whether the surface is closed and consistently oriented, with its inside inside."""
    _, place = np.unique(np.round(part.vertices, 6), axis=0, return_inverse=True)
    faces = place.ravel()[part.faces].astype(np.int64)
    faces = faces[(faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 2] != faces[:, 0])]
    edges = np.concatenate((faces[:, (0, 1)], faces[:, (1, 2)], faces[:, (2, 0)]))
    size = int(faces.max(initial=0)) + 1
    forward, backward = np.sort(edges[:, 0] * size + edges[:, 1]), np.sort(edges[:, 1] * size + edges[:, 0])
    corners = part.vertices[part.faces].astype(np.float64)
    volume = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum()
    return bool(np.array_equal(forward, backward) and volume > 0)


def planes_of(corners: Array) -> Array:
    """Return the planes (f, 4) of triangles (f, 3, 3)."""
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return np.concatenate((normals, np.einsum("ij,ij->i", normals, corners[:, 0])[:, None]), axis=1)


def _ball(vertices: NDArray[np.float32]) -> tuple[float, float, float, float]:
    x, y, z = (vertices.min(axis=0).astype(float) + vertices.max(axis=0)) / 2
    return x, y, z, float(np.linalg.norm(vertices - np.array((x, y, z)), axis=1).max())


def _emission(visual: Visual) -> tuple[float, float, float]:
    glow = visual.material.emissive if visual.material is not None else None
    return (0.0, 0.0, 0.0) if glow is None else (glow[0], glow[1], glow[2])


def _planes(part: Part) -> NDArray[np.float32]:
    return planes_of(part.vertices.astype(np.float32)[part.faces].astype(np.float64)).astype(np.float32)


def _stack(arrays: Iterable[NDArray[Any]], width: int, dtype: type[np.generic]) -> NDArray[Any]:
    return np.concatenate([np.zeros((0, width), dtype=dtype), *(array.astype(dtype, copy=False) for array in arrays)])
