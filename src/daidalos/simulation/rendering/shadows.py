"""Shadow maps of a directional light around cameras."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.simulation.rendering.flat_raster import draw_flat
from daidalos.simulation.rendering.raster import place_parts
from daidalos.simulation.rendering.scene import Scene, planes_of
from daidalos.simulation.rendering.sunlight import BLOCK_BITS, coarsen

_MAX_REACH = 16.0
_LINGER = 30
"""Pictures after which what came to rest counts as standing."""

_KEPT = 300
"""Pictures for which a map is kept that no camera uses."""

_SHIFT = 1e-5
"""Change of a position [m] or of an axis below which a body stands."""

_NEVER = np.array((1 << 30, -1, 1 << 30, -1), dtype=np.int64)


class ShadowMaps:
    """Shadow maps of a scene by the squares that they cover, each kept while a camera uses it.

    Cameras whose squares are the same share one map, which is drawn once for each instant.

    Parameters
    ----------
    scene : Scene
    size : int
        Pixels a side.
    """

    def __init__(self, scene: Scene, size: int = 1024) -> None:
        self._scene = scene
        self._size = size
        self._shapes: dict[float, Shapes] = {}
        self._maps: dict[tuple[float, ...], ShadowMap] = {}
        self._pictures = 0

    def at(self, positions: Array, rotations: Array, light: Array, eye: Array, ahead: Array, far: float) -> ShadowMap:
        """Return the map around a camera, drawn for the given poses.

        Parameters
        ----------
        positions, rotations : array (bodies, 3) and (bodies, 9)
            Of MuJoCo's bodies.
        light : array (3,)
            Unit vector in which the light shines.
        eye, ahead : array (3,)
            Where the camera is and where it looks.
        far : float
            How far it sees [m].
        """
        half = min(_MAX_REACH, max(far, 0.5)) / 2
        reach = 1.2 * half
        axes = _axes(light)
        step = reach / 4
        x, y = (math.floor(value / step) * step for value in (axes[:2] @ (eye + ahead * 0.8 * half)).tolist())
        key = (x, y, reach, *light.tolist())
        found = self._maps.pop(key, None)
        if found is None:
            texel = 2 * reach / self._size
            if texel not in self._shapes:
                self._shapes[texel] = simplify(self._scene, texel)
            corner = (x + step / 2 - reach, y + step / 2 - reach)
            found = ShadowMap(self._scene, self._shapes[texel], axes, corner, texel, self._size)
        self._maps[key] = found  # the last used comes last
        self._pictures += 1
        found.picture = self._pictures
        oldest = next(iter(self._maps))
        if self._pictures - self._maps[oldest].picture > _KEPT:
            del self._maps[oldest]
        found.update(positions, rotations)
        return found


def _axes(light: Array) -> Array:
    """Return the axes (3, 3) of the maps of a light, the third along it."""
    up = np.array((0.0, 1.0, 0.0)) if abs(light[2]) > 0.9 else np.array((0.0, 0.0, 1.0))
    right = np.cross(up, light)
    right /= np.linalg.norm(right)
    return np.stack((right, np.cross(light, right), light))


class ShadowMap:
    """Depths along a light of a square.

    What stands is drawn again only when something starts or stops to move; what moves is drawn over it each time.

    Parameters
    ----------
    scene : Scene
    shapes : Shapes
        What casts shadows.
    axes : array (3, 3)
        The third along the light.
    corner : tuple of 2 floats
        Of the square, along the first two axes [m].
    texel : float
        Side of a pixel [m].
    size : int
        Pixels a side.

    Attributes
    ----------
    depths : array (size, size) of float32
    coarse : array of float32
        The nearest depth in each block.
    to_map : array (3, 4)
        From the world to pixels and depth.
    texel : float
    picture : int
        Number of the last picture that used it.
    """

    def __init__(
        self, scene: Scene, shapes: Shapes, axes: Array, corner: tuple[float, float], texel: float, size: int
    ) -> None:
        self.depths = np.full((size, size), np.inf, dtype=np.float32)
        self.coarse = np.full(((size >> BLOCK_BITS) + 1, (size >> BLOCK_BITS) + 1), np.inf, dtype=np.float32)
        self.to_map = np.zeros((3, 4))
        self.to_map[:, :3] = axes
        self.to_map[:2] /= texel
        self.to_map[0, 3], self.to_map[1, 3] = -corner[0] / texel, -corner[1] / texel
        self.texel = texel
        self.picture = 0
        self._still = np.empty_like(self.depths)
        self._scene = scene
        self._shapes = shapes
        self._placed = np.empty((len(scene.body), 3, 4))
        self._scratch = np.empty(shapes.vertices.shape)
        self._dirty = _NEVER.copy()
        self._drawn: Array | None = None
        self._moving = np.zeros(0, dtype=np.bool_)

    def update(self, positions: Array, rotations: Array) -> None:
        """Draw the map for poses of MuJoCo's bodies, (bodies, 3) and (bodies, 9), unless it was drawn for them."""
        scene, poses = self._scene, np.concatenate((positions, rotations), axis=1)
        if self._drawn is None:
            self._poses, self._rest = poses.copy(), np.full(len(poses), _LINGER)
        elif np.array_equal(poses, self._drawn):
            return
        place_parts(scene.body, scene.pose, positions, rotations, self.to_map, self._placed)
        moving = self._find_moving(poses)[scene.body]
        if self._drawn is None or not np.array_equal(moving, self._moving):
            self._moving = moving
            self._draw_still(scene)
        self._draw_moving(scene)
        self._drawn = poses

    def _find_moving(self, poses: Array) -> NDArray[np.bool_]:
        """Return for each body whether it moved recently."""
        shifted = (np.abs(poses - self._poses) > _SHIFT).any(axis=1)
        self._poses[shifted] = poses[shifted]
        self._rest = np.where(shifted, 0, self._rest + 1)
        return self._rest < _LINGER

    def _draw_still(self, scene: Scene) -> None:
        self._still.fill(np.inf)
        self._draw(scene, scene.casts & ~self._moving, self._still, _NEVER.copy())
        self.depths[:] = self._still
        last = len(self.depths) - 1
        coarsen(self.depths, self.coarse, np.array((0, last, 0, last), dtype=np.int64))
        self._dirty = _NEVER.copy()

    def _draw_moving(self, scene: Scene) -> None:
        old = self._dirty
        if old[1] >= old[0]:
            rows, columns = slice(old[0], old[1] + 1), slice(old[2], old[3] + 1)
            self.depths[rows, columns] = self._still[rows, columns]
        box = _NEVER.copy()
        self._draw(scene, scene.casts & self._moving, self.depths, box)
        both = np.array(
            (min(box[0], old[0]), max(box[1], old[1]), min(box[2], old[2]), max(box[3], old[3])), dtype=np.int64
        )
        if both[1] >= both[0]:
            coarsen(self.depths, self.coarse, both)
        self._dirty = box

    def _draw(
        self,
        scene: Scene,
        wanted: NDArray[np.bool_],
        depths: NDArray[np.float32],
        box: NDArray[np.int64],
    ) -> None:
        shapes = self._shapes
        draw_flat(
            wanted,
            self._placed,
            shapes.face_ranges,
            shapes.vertex_ranges,
            scene.two_sided,
            shapes.vertices,
            shapes.faces,
            shapes.planes,
            self._scratch,
            depths,
            box,
        )


@dataclass(frozen=True, eq=False)
class Shapes:
    """Shadow casters: triangles of the parts of a scene, whose ranges are rows of `faces` and `vertices`."""

    vertices: NDArray[np.float32] = field(default_factory=lambda: np.zeros((0, 3), dtype=np.float32))
    faces: NDArray[np.int32] = field(default_factory=lambda: np.zeros((0, 3), dtype=np.int32))
    planes: NDArray[np.float32] = field(default_factory=lambda: np.zeros((0, 4), dtype=np.float32))
    face_ranges: NDArray[np.int64] = field(default_factory=lambda: np.zeros((0, 2), dtype=np.int64))
    vertex_ranges: NDArray[np.int64] = field(default_factory=lambda: np.zeros((0, 2), dtype=np.int64))


def simplify(scene: Scene, cell: float) -> Shapes:
    """Return the triangles of a scene with the vertices of each grid cell merged.

    What is closed stays closed, and triangles that no longer have three corners are gone (Rossignac and Borrel,
    "Multi-resolution 3D approximations for rendering complex scenes", 1993).

    Parameters
    ----------
    scene : Scene
    cell : float
        Side of a cube [m].
    """
    shape = np.searchsorted(np.unique(scene.vertex_ranges[:, 0]), np.arange(len(scene.vertices)), side="right")
    cubes = np.floor(scene.vertices / cell).astype(np.int64)
    _, first, place = np.unique(_hash(shape, *cubes.T), return_index=True, return_inverse=True)
    # In the old order, so that shapes lie behind one another still.
    kept, rank = np.sort(first), np.empty(len(first), dtype=np.int32)
    rank[np.argsort(first)] = np.arange(len(first), dtype=np.int32)
    faces = rank[place.ravel()][scene.faces].reshape(-1, 3)
    whole = (faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 2] != faces[:, 0])
    before = np.concatenate(([0], np.cumsum(whole)))
    vertices = scene.vertices[kept]
    return Shapes(
        vertices,
        faces[whole],
        planes_of(vertices[faces[whole]].astype(np.float64)).astype(np.float32),
        before[(scene.face_ranges.T - scene.face_ranges[:, 0] + scene.face_rows).T],
        np.searchsorted(kept, scene.vertex_ranges),
    )


def _hash(*numbers: NDArray[np.int64]) -> NDArray[np.uint64]:
    """Mix integers into a hash, practically without collisions."""
    mixed = np.zeros(len(numbers[0]), dtype=np.uint64)
    for number in numbers:
        mixed = (mixed ^ number.astype(np.uint64)) * np.uint64(0x9E3779B97F4A7C15)
        mixed ^= mixed >> np.uint64(29)
    return mixed
