"""Compilation of the renderer's kernels ahead of the first picture."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from daidalos.common.pose3 import Pose
from daidalos.description.geometry import Box, Plane
from daidalos.description.link import Light, Material, Visual
from daidalos.simulation.rendering.image_effects import add_noise, distort, mosaic, pick, points_of
from daidalos.simulation.rendering.lighting import Lighting
from daidalos.simulation.rendering.optics import Pinhole
from daidalos.simulation.rendering.renderer import Renderer
from daidalos.simulation.rendering.scene import Item, make_scene


def steps() -> Iterator[tuple[float, str]]:
    """Draw a tiny picture of everything once; see `daidalos.common.kernels.warm_up`."""
    yield 0.0, "triangles"
    pinhole = Pinhole.from_field_of_view(8, 6, 1.0)
    renderer = Renderer(pinhole, 0.1, 10.0)
    red = Material("red", (1.0, 0.0, 0.0, 1.0))
    visuals = (Visual(Plane(size=(9.0, 9.0))), Visual(Box((1.0, 1.0, 1.0)), Pose((3.0, 0.0, 0.0)), red))
    scene = make_scene([Item(visual, 0, i, 0) for i, visual in enumerate(visuals)], lambda line: None)
    positions, rotations = np.zeros((1, 3)), np.eye(3).reshape(1, 9)
    view = renderer.render(scene, positions, rotations, Pose((0.0, 0.0, 1.0)))
    yield 0.4, "light and shadow"
    sun = Light("sun", "directional", cast_shadows=True, direction=(1.0, 0.0, -1.0))
    picture = renderer.paint(positions, rotations, Lighting([(sun, Pose())]))
    yield 0.8, "lenses"
    bent = np.zeros_like(picture)
    distort(picture, pinhole.lookup, bent)
    depth = view.depth()
    points_of(depth, pinhole.rays, np.zeros((6, 8, 3), dtype=np.float32))
    pick(depth, pinhole.lookup, np.zeros((6, 8), dtype=np.float32))
    mosaic(bent, np.zeros((2, 2), dtype=np.int64), np.zeros((6, 8), dtype=np.uint8))
    add_noise(bent.reshape(-1), np.zeros(4, dtype=np.float32), 0)
