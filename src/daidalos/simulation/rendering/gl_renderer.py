"""Renderer with OpenGL on an EGL device, without a screen: a replacement of `renderer` for machines with a GPU."""

from __future__ import annotations

import importlib
import threading
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.pose3 import Pose, rotate
from daidalos.description.link import Light
from daidalos.simulation.rendering import shaders
from daidalos.simulation.rendering.lighting import Lighting
from daidalos.simulation.rendering.optics import OPTICAL, Pinhole
from daidalos.simulation.rendering.pool import Pool
from daidalos.simulation.rendering.raster import NOTHING, place_parts
from daidalos.simulation.rendering.renderer import (
    View,
    background_of,
    light_color,
    light_direction,
    light_table,
    sort_lights,
)
from daidalos.simulation.rendering.scene import Scene
from daidalos.simulation.rendering.shading import HEMISPHERE
from daidalos.simulation.rendering.shadows import ShadowMaps

# From the extra daidalos[egl]: type checkers do not find it everywhere.
moderngl: Any = importlib.import_module("moderngl")

_OPAQUE, _CLEAR, _UNSEEN = 1.0, 2.0, 0.0
_contexts = threading.local()


class GlRenderer:
    """OpenGL renderer of one camera, with the interface of `renderer.Renderer`.

    Shadow maps are drawn in software. Transparent things behind one another are mixed in the order of the scene.

    Raises
    ------
    Exception
        Whatever the driver says when there is no EGL device.
    """

    def __init__(self, pinhole: Pinhole, near: float, far: float, mask: int = 0xFFFFFFFF) -> None:
        self.pinhole = pinhole
        self.near, self.far = near, far
        self._mask = np.uint32(mask & 0xFFFFFFFF)
        self._pool = Pool()
        self._scene: Scene | None = None
        self._gl = context()
        size = (pinhole.width, pinhole.height)
        depth = self._gl.depth_renderbuffer(size)
        self._found = self._gl.framebuffer([self._gl.texture(size, 2, dtype="f4")], depth)
        self._picture = self._gl.framebuffer([self._gl.texture(size, 4)], depth)
        self._finder = self._gl.program(vertex_shader=shaders.VERTEX, fragment_shader=shaders.DEPTH)
        self._painter = self._gl.program(vertex_shader=shaders.VERTEX, fragment_shader=shaders.COLOR)
        self._sky = self._gl.program(vertex_shader=shaders.SKY_VERTEX, fragment_shader=shaders.SKY)
        self._sky_array = self._gl.vertex_array(self._sky, [])
        self._textures: dict[str, Any] = {}
        for program in (self._finder, self._painter):
            program["projection"].write(self._projection().T.astype("f4").tobytes())

    def render(self, scene: Scene, positions: Array, rotations: Array, pose: Pose) -> View:
        """Rasterize the scene."""
        if scene is not self._scene:
            self._take(scene)
        self._camera_pose = pose @ OPTICAL
        self._view = self._camera_pose.inverse.matrix[:3]
        placed = np.empty((len(scene.body), 3, 4))
        place_parts(scene.body, scene.pose, positions, rotations, self._view, placed)
        seen = scene.visible & ((scene.flags & self._mask) != 0)
        table = self._table[: len(scene.body)]
        table[:, :3] = placed
        table[:, 4, 3] = np.where(seen, np.where(scene.opaque, _OPAQUE, _CLEAR), _UNSEEN)
        self._fill("parts", self._table, 4)
        self._transparent = bool((seen & ~scene.opaque).any())
        self._found.use()
        self._found.clear()
        self._draw(self._finder, self._finder_array, _OPAQUE)
        found = np.frombuffer(self._found.read(components=2, dtype="f4"), dtype=np.float32)
        found = found.reshape(self.pinhole.height, self.pinhole.width, 2)
        inverse = np.maximum(found[..., 0], np.float32(1.0 / self.far))
        triangles = np.where(found[..., 0] > 0, found[..., 1], NOTHING).astype(np.int32)
        return View(inverse, triangles, scene, self._pool)

    def paint(self, positions: Array, rotations: Array, lighting: Lighting) -> NDArray[np.uint8]:
        """Return the colours (rows, columns, 3) of the last `render`, including transparent surfaces."""
        scene = self._scene
        assert scene is not None
        sun, lights = sort_lights(lighting)
        self._set_light(scene, positions, rotations, lighting, sun, lights)
        self._picture.use()
        self._picture.clear()
        self._gl.disable(moderngl.DEPTH_TEST | moderngl.BLEND)
        self._sky_array.render(moderngl.TRIANGLES, vertices=3)
        self._draw(self._painter, self._painter_array, _OPAQUE)
        if self._transparent:
            self._gl.enable(moderngl.BLEND)
            self._picture.depth_mask = False
            self._draw(self._painter, self._painter_array, _CLEAR)
            self._picture.depth_mask = True
            self._gl.disable(moderngl.BLEND)
        picture: NDArray[np.uint8] = self._pool.take((self.pinhole.height, self.pinhole.width, 3), np.uint8)
        self._picture.read_into(picture, components=3, alignment=1)
        return picture

    def _draw(self, program: Any, vertices: Any, wanted: float) -> None:
        self._gl.enable(moderngl.DEPTH_TEST)
        program["wanted"].value = wanted
        for place, name in enumerate(("parts", "atlas", "levels", "lights", "shadow")):
            if name in program and name in self._textures:
                program[name].value = place
                self._textures[name].use(place)
        vertices.render(moderngl.TRIANGLES)

    def _take(self, scene: Scene) -> None:
        """Upload a scene to the device."""
        self._scene = scene
        rows, triangles = _drawn(scene)
        vertices = self._gl.buffer(rows.tobytes() or bytes(36))
        faces = self._gl.buffer(triangles.tobytes() or bytes(12))
        self._painter_array = self._gl.vertex_array(
            self._painter, [(vertices, "3f 3f 2f 1f", "place", "normal", "uv", "part")], faces
        )
        self._finder_array = self._gl.vertex_array(self._finder, [(vertices, "3f 20x 1f", "place", "part")], faces)
        self._table = np.zeros((max(len(scene.body), 1), shaders.PARTS, 4), dtype=np.float32)
        table = self._table[: len(scene.body)]
        table[:, 3, :3], table[:, 3, 3] = scene.colors, scene.alphas
        table[:, 4, :3] = scene.emissions
        first = np.array([scene.atlas.textures[t] if t >= 0 else (-1, 0) for t in scene.texture_of], dtype=np.float32)
        table[:, 5, :2] = first.reshape(-1, 2)
        table[:, 5, 2] = scene.two_sided
        texels = scene.atlas.texels
        padded = np.zeros((-(-max(len(texels), 1) // shaders.ATLAS_WIDTH) * shaders.ATLAS_WIDTH, 4), dtype=np.uint8)
        padded[: len(texels)] = texels
        self._fill("atlas", padded.reshape(-1, shaders.ATLAS_WIDTH, 4), 4, "f1")
        levels = np.zeros((1, max(len(scene.atlas.levels), 1), 4), dtype=np.float32)
        levels[0, : len(scene.atlas.levels), :3] = scene.atlas.levels
        self._fill("levels", levels, 4)

    def _fill(self, name: str, values: NDArray[Any], components: int, dtype: str = "f4") -> None:
        """Upload an array (rows, columns, components) to a texture."""
        size = (values.shape[1], values.shape[0])
        texture = self._textures.get(name)
        if texture is None or texture.size != size:
            if texture is not None:
                texture.release()
            texture = self._textures[name] = self._gl.texture(size, components, dtype=dtype, alignment=1)
        texture.write(np.ascontiguousarray(values).tobytes())

    def _set_light(
        self,
        scene: Scene,
        positions: Array,
        rotations: Array,
        lighting: Lighting,
        sun: tuple[Light, Pose] | None,
        lights: list[tuple[Light, Pose]],
    ) -> None:
        direction = np.array((0.0, 0.0, -1.0)) if sun is None else light_direction(*sun)
        shadowed = sun is not None and sun[0].cast_shadows and lighting.shadows
        program = self._painter
        program["shadowed"].value = shadowed
        if shadowed:
            self._set_shadow(scene, positions, rotations, direction)
        program["up"].value = tuple(self._camera_pose.matrix[2, :3].tolist())
        program["hemisphere"].value = HEMISPHERE
        program["ambient"].value = tuple(map(float, lighting.ambient[:3]))
        program["sun"].value = tuple((-(self._view[:, :3] @ direction)).tolist())
        program["sun_color"].value = (0.0, 0.0, 0.0) if sun is None else tuple(light_color(sun[0]).tolist())
        table = np.zeros((max(len(lights), 1), shaders.LIGHT_TEXELS * 4), dtype=np.float32)
        numbers = light_table(lights, self._view)
        table[: len(lights), : numbers.shape[1]] = numbers
        self._fill("lights", table.reshape(len(table), shaders.LIGHT_TEXELS, 4), 4)
        program["light_count"].value = len(lights)
        low, high = background_of(lighting)
        self._sky["low"].value, self._sky["high"].value = low[:3], high[:3]
        self._sky["lens"].value = tuple(self.pinhole.lens.tolist())
        self._sky["horizon"].value = tuple(self._camera_pose.matrix[2, :3].tolist())

    def _set_shadow(self, scene: Scene, positions: Array, rotations: Array, direction: Array) -> None:
        ahead = np.array(rotate(self._camera_pose.orientation, (0.0, 0.0, 1.0)))
        eye = np.array(self._camera_pose.position)
        shadow = scene.share(ShadowMaps).at(positions, rotations, direction, eye, ahead, self.far)
        self._fill("shadow", shadow.depths[..., None], 1)
        to_shadow = np.eye(4)
        to_shadow[:3] = shadow.to_map @ self._camera_pose.matrix
        self._painter["to_shadow"].write(to_shadow.T.astype("f4").tobytes())
        self._painter["offset"].value = (1.5 * shadow.texel, 1.0 * shadow.texel)

    def _projection(self) -> Array:
        """Return the matrix from the optical frame to clip space; the first row of pixels is OpenGL's lowest."""
        lens, near, far = self.pinhole, self.near, self.far
        return np.array(
            (
                (2 * lens.fx / lens.width, 0.0, (2 * lens.cx + 1) / lens.width - 1, 0.0),
                (0.0, 2 * lens.fy / lens.height, (2 * lens.cy + 1) / lens.height - 1, 0.0),
                (0.0, 0.0, (far + near) / (far - near), -2 * far * near / (far - near)),
                (0.0, 0.0, 1.0, 0.0),
            )
        )


def _drawn(scene: Scene) -> tuple[NDArray[np.float32], NDArray[np.int32]]:
    """Return the vertices of all parts, with normals, texture coordinates and part, and the triangles among them."""
    counts = np.diff(scene.vertex_ranges, axis=1).ravel()
    part = np.repeat(np.arange(len(scene.body)), counts)
    moved = np.cumsum(counts) - counts - scene.vertex_ranges[:, 0]
    vertex = np.arange(len(part)) - moved[part]
    row = np.arange(len(scene.face_part)) + (scene.face_rows - scene.face_ranges[:, 0])[scene.face_part]
    columns = (scene.vertices[vertex], scene.normals[vertex], scene.uv[vertex], part[:, None])
    triangles = scene.faces[row] + moved[scene.face_part][:, None]
    return np.concatenate(columns, axis=1, dtype=np.float32), np.ascontiguousarray(triangles, dtype=np.int32)


def context() -> Any:
    """Return this thread's OpenGL context on an EGL device, created on first use."""
    made = getattr(_contexts, "made", None)
    if made is None:
        made = _contexts.made = moderngl.create_context(standalone=True, backend="egl")
        # Seen in a picture whose first row is the lowest, fronts turn with the clock.
        made.front_face = "cw"
    return made
