"""Which renderer draws, and that OpenGL and software draw the same."""

import sys

import numpy as np
import pytest

from daidalos.common.pose3 import Pose
from daidalos.description.geometry import Box, Plane, Sphere
from daidalos.description.link import Light, Material, Visual
from daidalos.simulation.rendering import backends
from daidalos.simulation.rendering.lighting import Lighting
from daidalos.simulation.rendering.optics import Pinhole
from daidalos.simulation.rendering.renderer import Renderer
from daidalos.simulation.rendering.scene import Item, make_scene

PINHOLE = Pinhole(160, 120, 130.0, 135.0, 81.5, 57.25)
EYE = Pose.from_xyz_rpy((0.0, 0.0, 1.5), (0.1, 0.35, 0.2))
BODIES = np.array([(0.0, 0.0, 0.0), (3.0, 0.6, 0.5), (2.5, -0.7, 0.4), (1.7, 0.0, 0.8)])


def scene():
    glass = Material("glass", (0.2, 0.4, 1.0, 0.5))
    shapes = Plane(size=(30.0, 30.0)), Box((1.0, 1.0, 1.0)), Sphere(0.4), Box((0.05, 0.5, 0.5))
    paints = Material("sand", (0.8, 0.7, 0.5, 1.0)), Material("red", (0.9, 0.1, 0.1, 1.0)), None, glass
    visuals = [Visual(shape, material=paint) for shape, paint in zip(shapes, paints, strict=True)]
    return make_scene([Item(visual, number, number, number) for number, visual in enumerate(visuals)], pytest.fail)


def pictures(renderer):
    rotations = np.tile(np.eye(3).reshape(9), (4, 1))
    seen = scene()
    view = renderer.render(seen, BODIES, rotations, EYE)
    sun = Light("sun", "directional", cast_shadows=True, direction=(0.5, 0.3, -1.0), diffuse=(0.6, 0.6, 0.6, 1.0))
    point = Light("point", "point", diffuse=(0.5, 0.5, 0.3, 1.0), attenuation_range=8.0)
    lights = [(sun, Pose()), (point, Pose((2.0, 1.5, 1.5)))]
    return view, renderer.paint(BODIES, rotations, Lighting(lights, sky=True)).astype(int)


def test_software_draws_unless_it_is_told_otherwise(monkeypatch):
    monkeypatch.delenv(backends.VARIABLE, raising=False)
    assert isinstance(backends.make_renderer(PINHOLE, 0.1, 50.0, 1), Renderer)


@pytest.mark.parametrize(
    ("wanted", "line"),
    [("egl", "needs the extra daidalos[egl]; cameras are drawn in software"), ("vulkan", "expected 'software' or")],
)
def test_software_draws_where_the_other_is_missing_and_says_so_once(monkeypatch, caplog, wanted, line):
    monkeypatch.setenv(backends.VARIABLE, wanted)
    monkeypatch.setitem(sys.modules, "daidalos.simulation.rendering.gl_renderer", None)
    backends.log_once.cache_clear()
    for _ in range(2):
        assert isinstance(backends.make_renderer(PINHOLE, 0.1, 50.0, 1), Renderer)
    assert [line in record.message for record in caplog.records] == [True]


def test_opengl_draws_what_software_draws():
    moderngl = pytest.importorskip("moderngl", reason="needs the extra daidalos[egl]")
    gl_renderer = pytest.importorskip("daidalos.simulation.rendering.gl_renderer")
    try:
        gl_renderer.context()
    except Exception as problem:  # a driver may fail in any way
        pytest.skip(f"there is no EGL device: {problem}")
    assert moderngl
    (view, picture), (other_view, other) = (
        pictures(make(PINHOLE, 0.1, 50.0)) for make in (Renderer, gl_renderer.GlRenderer)
    )
    alike = view.triangles == other_view.triangles
    assert alike.mean() > 0.995
    assert set(np.unique(view.of_parts(view.scene.labels, nothing=9))) == {0, 1, 2, 9}
    assert other_view.depth()[alike] == pytest.approx(view.depth()[alike], rel=2e-3)
    difference = np.abs(picture - other).max(axis=2)
    assert np.mean(difference > 12) < 0.02
    assert picture.std() > 30
