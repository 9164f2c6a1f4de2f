"""Software renderer of a scene for a camera."""

from __future__ import annotations

from dataclasses import InitVar, dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.pose3 import Pose, rotate
from daidalos.description.link import Light, Rgba
from daidalos.simulation.rendering.image_effects import depths_of
from daidalos.simulation.rendering.lighting import Lighting
from daidalos.simulation.rendering.lights import DIRECTIONAL, LIGHT_SIZE, POINT, SPOT
from daidalos.simulation.rendering.optics import OPTICAL, Pinhole
from daidalos.simulation.rendering.pool import Pool
from daidalos.simulation.rendering.raster import EDGES, NOTHING, PROJECTED, draw, place_parts
from daidalos.simulation.rendering.scene import Scene
from daidalos.simulation.rendering.shading import shade
from daidalos.simulation.rendering.shadows import ShadowMap, ShadowMaps

_SKY: tuple[Rgba, Rgba] = ((0.75, 0.84, 0.93, 1.0), (0.25, 0.47, 0.80, 1.0))
_KINDS = {"point": POINT, "spot": SPOT, "directional": DIRECTIONAL}
_NO_SHADOW = np.zeros((0, 0), dtype=np.float32)


@dataclass(frozen=True, eq=False)
class View:
    """View of a camera; its arrays are reused by the next `Renderer.render` of the scene.

    Parameters
    ----------
    inverse : array (rows, columns) of float32
        Inverse depth along the optical axis [1/m].
    triangles : array (rows, columns) of int32
        Numbers of the scene's triangles, as in `Scene.face_part`; negative for nothing.
    scene : Scene
    pool : Pool
        Where arrays for others come from.
    """

    inverse: NDArray[np.float32]
    triangles: NDArray[np.int32]
    scene: Scene
    pool: Pool

    def depth(self, near: float = 0.0, far: float = np.inf) -> NDArray[np.float32]:
        """Return depths along the optical axis [m], infinite beyond `far`, minus infinite before `near`."""
        depths = self.pool.take(self.inverse.shape, np.float32)
        depths_of(self.inverse, self.triangles, np.float32(near), np.float32(far), depths)
        return depths

    def of_parts(self, values: NDArray[Any], nothing: int = 0) -> NDArray[Any]:
        """Return for each pixel the value of the part that it sees."""
        result = values[self.scene.face_part[self.triangles.clip(0)]] if len(values) else self.triangles * 0
        return np.where(self.triangles < 0, np.asarray(nothing, dtype=result.dtype), result)


@dataclass(eq=False)
class _Buffers:
    """Arrays that depend on the scene, shared by all cameras that draw it, one after the other.

    Parameters
    ----------
    scene : Scene

    Attributes
    ----------
    drawn_by : Renderer or None
        Whose picture they hold.
    pool : Pool
        Of pictures and depths for others.
    """

    scene: InitVar[Scene]
    drawn_by: Renderer | None = field(default=None, init=False)
    placed: Array = field(init=False)
    projected: NDArray[np.float32] = field(init=False)
    edges: NDArray[np.float32] = field(init=False)
    flipped: NDArray[np.bool_] = field(init=False)
    face_shift: NDArray[np.int64] = field(init=False)

    def __post_init__(self, scene: Scene) -> None:
        self.placed = np.zeros((len(scene.body), 3, 4))
        self.projected = np.zeros((len(scene.vertices), PROJECTED), dtype=np.float32)
        self.edges = np.zeros((len(scene.face_part), EDGES), dtype=np.float32)
        self.flipped = np.zeros(len(scene.face_part), dtype=np.bool_)
        self.face_shift = scene.face_rows - scene.face_ranges[:, 0]
        self.pool = Pool()
        self._images: dict[tuple[int, int, bool], tuple[NDArray[np.float32], NDArray[np.int32]]] = {}

    def image(self, shape: tuple[int, int], transparent: bool = False) -> tuple[NDArray[np.float32], NDArray[np.int32]]:
        """Return the arrays of inverse depths and triangles of pictures of a shape."""
        key = (*shape, transparent)
        if key not in self._images:
            self._images[key] = np.empty(shape, dtype=np.float32), np.empty(shape, dtype=np.int32)
        return self._images[key]


class Renderer:
    """Rasterizer of one camera with its buffers.

    Parameters
    ----------
    pinhole : Pinhole
        Without distortion.
    near, far : float
        Depths between which things are seen [m].
    mask : int
        Sees parts whose visibility flags have a bit in common with it.
    """

    def __init__(self, pinhole: Pinhole, near: float, far: float, mask: int = 0xFFFFFFFF) -> None:
        self.pinhole = pinhole
        self.near, self.far = near, far
        self._mask = np.uint32(mask & 0xFFFFFFFF)
        self._scene: Scene | None = None

    def render(self, scene: Scene, positions: Array, rotations: Array, pose: Pose) -> View:
        """Rasterize the scene.

        Parameters
        ----------
        scene : Scene
        positions, rotations : array (bodies, 3) and (bodies, 9)
            Of MuJoCo's bodies.
        pose : Pose
            The sensor's frame (x ahead, z up) in the world.
        """
        if self._scene is not scene:
            self._scene = scene
            self._buffers = scene.share(_Buffers)
            self._inverse, self._triangles = self._buffers.image((self.pinhole.height, self.pinhole.width))
        self._pose = pose
        self._camera_pose = pose @ OPTICAL
        self._view = self._camera_pose.inverse.matrix[:3]
        self._buffers.drawn_by = self
        place_parts(scene.body, scene.pose, positions, rotations, self._view, self._buffers.placed)
        self._inverse.fill(1.0 / self.far)
        self._triangles.fill(NOTHING)
        seen = scene.visible & ((scene.flags & self._mask) != 0)
        self._draw(seen & scene.opaque, self._inverse, self._triangles)
        self._transparent = seen & ~scene.opaque
        return View(self._inverse, self._triangles, scene, self._buffers.pool)

    def paint(self, positions: Array, rotations: Array, lighting: Lighting) -> NDArray[np.uint8]:
        """Return the colours (rows, columns, 3) of the last `render`, including transparent surfaces."""
        scene = self._scene
        assert scene is not None
        if self._buffers.drawn_by is not self:  # another camera drew since
            self.render(scene, positions, rotations, self._pose)
        sun, lights = sort_lights(lighting)
        direction = np.array((0.0, 0.0, -1.0)) if sun is None else light_direction(*sun)
        shadow = self._shadow(scene, positions, rotations, direction, lighting, sun)
        picture = self._buffers.pool.take((*self._triangles.shape, 3), np.uint8)
        self._shade(self._triangles, self._inverse, lighting, sun, direction, lights, shadow, picture, blend=False)
        if self._transparent.any():
            inverse, triangles = self._buffers.image(self._triangles.shape, transparent=True)
            np.copyto(inverse, self._inverse)
            triangles.fill(NOTHING)
            self._draw(self._transparent, inverse, triangles)
            self._shade(triangles, inverse, lighting, sun, direction, lights, shadow, picture, blend=True)
        return picture

    def _draw(self, wanted: NDArray[np.bool_], inverse: NDArray[np.float32], triangles: NDArray[np.int32]) -> None:
        scene, buffers = self._scene, self._buffers
        assert scene is not None
        draw(
            wanted, buffers.placed, scene.spheres, scene.face_ranges, scene.face_rows, scene.vertex_ranges,
            scene.two_sided, scene.vertices, scene.faces, scene.planes, self.pinhole.lens, self.near, self.far,
            buffers.projected, buffers.edges, buffers.flipped, inverse, triangles,
        )  # fmt: skip

    def _shadow(
        self,
        scene: Scene,
        positions: Array,
        rotations: Array,
        direction: Array,
        lighting: Lighting,
        sun: tuple[Light, Pose] | None,
    ) -> ShadowMap | None:
        if sun is None or not sun[0].cast_shadows or not lighting.shadows:
            return None
        ahead = np.array(rotate(self._camera_pose.orientation, (0.0, 0.0, 1.0)))
        eye = np.array(self._camera_pose.position)
        return scene.share(ShadowMaps).at(positions, rotations, direction, eye, ahead, self.far)

    def _shade(
        self,
        triangles: NDArray[np.int32],
        inverse: NDArray[np.float32],
        lighting: Lighting,
        sun: tuple[Light, Pose] | None,
        direction: Array,
        lights: list[tuple[Light, Pose]],
        shadow: ShadowMap | None,
        picture: NDArray[np.uint8],
        blend: bool,
    ) -> None:
        scene, buffers, view = self._scene, self._buffers, self._view
        assert scene is not None
        eye = self._camera_pose.matrix
        to_shadow = np.zeros((3, 4)) if shadow is None else shadow.to_map @ eye
        offset = np.zeros(2) if shadow is None else np.array((1.5, 1.0)) * shadow.texel
        colors = background_of(lighting)
        shade(
            triangles, inverse, buffers.edges, buffers.flipped, scene.face_part, buffers.face_shift, scene.faces,
            scene.normals, scene.uv, buffers.placed, scene.colors, scene.emissions, scene.alphas, scene.texture_of,
            scene.atlas.texels, scene.atlas.textures, scene.atlas.levels, self.pinhole.lens,
            np.array([color[:3] for color in colors], dtype=np.float32), np.ascontiguousarray(eye[2, :3]),
            np.array(lighting.ambient[:3], dtype=np.float32), -(view[:, :3] @ direction),
            np.zeros(3, dtype=np.float32) if sun is None else light_color(sun[0]), light_table(lights, view),
            _NO_SHADOW if shadow is None else shadow.depths, _NO_SHADOW if shadow is None else shadow.coarse,
            to_shadow, offset, picture, blend,
        )  # fmt: skip


def background_of(lighting: Lighting) -> tuple[Rgba, Rgba]:
    """Return the colours of the sky at the horizon and at the zenith."""
    return _SKY if lighting.sky else (lighting.background, lighting.background)


def sort_lights(lighting: Lighting) -> tuple[tuple[Light, Pose] | None, list[tuple[Light, Pose]]]:
    """Return the directional light that casts shadows, and all other lights."""
    shining = [pair for pair in lighting.lights if pair[0].on and pair[0].intensity > 0]
    parallel = [pair for pair in shining if pair[0].type == "directional"]
    sun = next((pair for pair in parallel if pair[0].cast_shadows), parallel[0] if parallel else None)
    return sun, [pair for pair in shining if pair is not sun]


def light_direction(light: Light, pose: Pose) -> Array:
    """Return the unit vector of a light's direction in the world."""
    direction = np.array(rotate(pose.orientation, light.direction))
    length = float(np.linalg.norm(direction))
    return direction / length if length > 0 else np.array((0.0, 0.0, -1.0))


def light_color(light: Light) -> NDArray[np.float32]:
    """Return a light's colour (3,) times its intensity."""
    return np.array(light.diffuse[:3], dtype=np.float32) * np.float32(light.intensity)


def light_table(lights: list[tuple[Light, Pose]], view: Array) -> Array:
    """Return an array (n, LIGHT_SIZE) of lights in the camera frame; see `rendering.lights` for the columns."""
    table = np.zeros((len(lights), LIGHT_SIZE))
    for row, (light, pose) in zip(table, lights, strict=True):
        row[0] = _KINDS.get(light.type, POINT)
        row[1:4] = view[:, :3] @ pose.position + view[:, 3]
        row[4:7] = view[:, :3] @ light_direction(light, pose)
        row[7:10] = light_color(light)
        row[10:14] = (
            light.attenuation_range,
            light.attenuation_constant,
            light.attenuation_linear,
            light.attenuation_quadratic,
        )
        row[14:17] = np.cos(light.spot_inner_angle / 2), np.cos(light.spot_outer_angle / 2), light.spot_falloff or 1.0
        row[17] = 1.0
    return table
