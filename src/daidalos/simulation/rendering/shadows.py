"""Shadow map of a directional light around a camera."""

from __future__ import annotations

import math
from dataclasses import InitVar, dataclass, field
from weakref import WeakKeyDictionary

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

_SHIFT = 1e-5
"""Change of a position [m] or of an axis below which a body stands."""

_NEVER = np.array((1 << 30, -1, 1 << 30, -1), dtype=np.int64)


@dataclass(eq=False)
class _Canvas:
    """Map in which what moves is drawn over what stands, shared by the cameras of a scene, one after the other.

    Parameters
    ----------
    size : int
        Pixels a side.

    Attributes
    ----------
    owner : ShadowMap or None
        Whose map it holds.
    """

    size: InitVar[int]
    owner: ShadowMap | None = field(default=None, init=False)
    depths: NDArray[np.float32] = field(init=False)
    coarse: NDArray[np.float32] = field(init=False)

    def __post_init__(self, size: int) -> None:
        self.depths, self.coarse = _empty_map(size)


def _empty_map(size: int) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Return infinite depths, and their blocks."""
    blocks = (size >> BLOCK_BITS) + 1
    return np.full((size, size), np.inf, dtype=np.float32), np.full((blocks, blocks), np.inf, dtype=np.float32)


_canvases: WeakKeyDictionary[Scene, dict[int, _Canvas]] = WeakKeyDictionary()


class ShadowMap:
    """Depths along a light of a square around a camera.

    What stands is drawn again only when the square moves on or something starts or stops to move; what moves is drawn
    over it each time.

    Parameters
    ----------
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
        Side of a pixel [m].
    """

    def __init__(self, size: int = 1024) -> None:
        self._size = size
        self._still, self._still_coarse = _empty_map(size)
        self.depths, self.coarse = self._still, self._still_coarse
        self.to_map = np.zeros((3, 4))
        self.texel = 1.0
        self._scene: Scene | None = None
        self._placed = np.empty((0, 3, 4))
        self._scratch = np.empty((0, 3))
        self._shapes = Shapes()
        self._light = np.zeros(3)
        self._corner = (math.nan, math.nan)
        self._dirty = _NEVER.copy()
        self._poses = np.zeros((0, 12))
        self._rest = np.zeros(0, dtype=np.int64)
        self._moving = np.zeros(0, dtype=np.bool_)

    def update(
        self, scene: Scene, positions: Array, rotations: Array, light: Array, eye: Array, ahead: Array, far: float
    ) -> None:
        """Update the map.

        Parameters
        ----------
        scene : Scene
        positions, rotations : array (bodies, 3) and (bodies, 9)
            Of MuJoCo's bodies.
        light : array (3,)
            Unit vector in which the light shines.
        eye, ahead : array (3,)
            Where the camera is and where it looks.
        far : float
            How far it sees [m].
        """
        reach = min(_MAX_REACH, max(far, 0.5)) / 2
        moved = self._aim(light, eye + ahead * 0.8 * reach, 1.2 * reach)
        if scene is not self._scene:
            self._scene, moved = scene, True
            known = _canvases.setdefault(scene, {})
            self._canvas = known.get(self._size) or known.setdefault(self._size, _Canvas(self._size))
            self.depths, self.coarse = self._canvas.depths, self._canvas.coarse
            self._shapes = _shapes_of(scene, self.texel)
            self._placed = np.empty((len(scene.body), 3, 4))
            self._scratch = np.empty(self._shapes.vertices.shape)
            self._poses = np.concatenate((positions, rotations), axis=1)
            self._rest = np.full(len(positions), _LINGER)
        place_parts(scene.body, scene.pose, positions, rotations, self.to_map, self._placed)
        moving = self._find_moving(positions, rotations)[scene.body]
        if moved or not np.array_equal(moving, self._moving):
            self._moving = moving
            self._draw_still(scene)
            self._canvas.owner = None
        if self._canvas.owner is not self:
            self._canvas.owner = self
            self.depths[:], self.coarse[:] = self._still, self._still_coarse
            self._dirty = _NEVER.copy()
        self._draw_moving(scene)

    def _find_moving(self, positions: Array, rotations: Array) -> NDArray[np.bool_]:
        """Return for each body whether it moved recently."""
        poses = np.concatenate((positions, rotations), axis=1)
        shifted = (np.abs(poses - self._poses) > _SHIFT).any(axis=1)
        self._poses[shifted] = poses[shifted]
        self._rest = np.where(shifted, 0, self._rest + 1)
        return self._rest < _LINGER

    def _aim(self, light: Array, centre: Array, reach: float) -> bool:
        """Place the square around a position, in steps so that it rarely moves; return whether it moved."""
        texel = 2 * reach / self._size
        up = np.array((0.0, 1.0, 0.0)) if abs(light[2]) > 0.9 else np.array((0.0, 0.0, 1.0))
        right = np.cross(up, light)
        right /= np.linalg.norm(right)
        axes = np.stack((right, np.cross(light, right), light))
        step = reach / 4
        x, y = (math.floor(value / step) * step for value in (axes[:2] @ centre).tolist())
        corner = (x + step / 2 - reach, y + step / 2 - reach)
        if corner == self._corner and texel == self.texel and np.array_equal(light, self._light):
            return False
        self._corner, self.texel, self._light = corner, texel, light.copy()
        self.to_map[:, :3] = axes
        self.to_map[:, 3] = 0.0
        self.to_map[:2] /= texel
        self.to_map[0, 3], self.to_map[1, 3] = -corner[0] / texel, -corner[1] / texel
        return True

    def _draw_still(self, scene: Scene) -> None:
        self._still.fill(np.inf)
        self._draw(scene, scene.casts & ~self._moving, self._still, _NEVER.copy())
        last = self._size - 1
        coarsen(self._still, self._still_coarse, np.array((0, last, 0, last), dtype=np.int64))

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
    """Shadow casters: triangles of the parts of a scene."""

    vertices: NDArray[np.float32] = field(default_factory=lambda: np.zeros((0, 3), dtype=np.float32))
    faces: NDArray[np.int32] = field(default_factory=lambda: np.zeros((0, 3), dtype=np.int32))
    planes: NDArray[np.float32] = field(default_factory=lambda: np.zeros((0, 4), dtype=np.float32))
    face_ranges: NDArray[np.int64] = field(default_factory=lambda: np.zeros((0, 2), dtype=np.int64))
    vertex_ranges: NDArray[np.int64] = field(default_factory=lambda: np.zeros((0, 2), dtype=np.int64))


_shapes: WeakKeyDictionary[Scene, dict[float, Shapes]] = WeakKeyDictionary()


def _shapes_of(scene: Scene, cell: float) -> Shapes:
    """Return the simplified triangles of a scene, which all cameras share; see `simplify`."""
    known = _shapes.setdefault(scene, {})
    if cell not in known:
        known[cell] = simplify(scene, cell)
    return known[cell]


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
    part = np.repeat(np.arange(len(scene.body)), np.diff(scene.vertex_ranges, axis=1).ravel())
    cubes = np.floor(scene.vertices / cell).astype(np.int64)
    _, first, place = np.unique(_hash(part, *cubes.T), return_index=True, return_inverse=True)
    # In the old order, so that parts lie behind one another still.
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
        before[scene.face_ranges],
        np.searchsorted(kept, scene.vertex_ranges),
    )


def _hash(*numbers: NDArray[np.int64]) -> NDArray[np.uint64]:
    """Mix integers into a hash, practically without collisions."""
    mixed = np.zeros(len(numbers[0]), dtype=np.uint64)
    for number in numbers:
        mixed = (mixed ^ number.astype(np.uint64)) * np.uint64(0x9E3779B97F4A7C15)
        mixed ^= mixed >> np.uint64(29)
    return mixed
