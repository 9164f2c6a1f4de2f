"""What the cameras of one scene share."""

import gc
import weakref

import numpy as np
import pytest

from daidalos.common.pose3 import Pose, quaternion_from_yaw
from daidalos.description import sdf
from daidalos.description.geometry import Box, Plane, Sphere
from daidalos.description.link import Light, Visual
from daidalos.samples.sensors import ImageSample
from daidalos.simulation import Simulation
from daidalos.simulation.rendering.lighting import Lighting
from daidalos.simulation.rendering.optics import Pinhole
from daidalos.simulation.rendering.renderer import Renderer
from daidalos.simulation.rendering.scene import Item, Scene, make_scene
from daidalos.simulation.rendering.shadows import ShadowMaps
from simulation.models import box, world

SUN = Lighting([(Light("sun", "directional", cast_shadows=True, direction=(1.0, 0.5, -1.0)), Pose())])
NEAR, TURNED, FAR = (
    Pose((0.0, 0.0, 1.0)),
    Pose((0.1, 0.0, 1.2), quaternion_from_yaw(0.02)),
    Pose((60.0, 0.0, 1.0), quaternion_from_yaw(2.0)),
)
STILL = np.zeros((1, 3)), np.eye(3).reshape(1, 9)
EYE = """<sdf version="1.9"><model name="eye"><static>true</static><link name="l"><pose>0 0 0.5 0 0 0</pose>
  <sensor name="s" type="camera"><topic>/image</topic><update_rate>10</update_rate><camera><image><width>32</width>
  <height>24</height></image></camera></sensor></link></model></sdf>"""


def scene() -> Scene:
    visuals = (Visual(Plane(size=(200.0, 200.0))), Visual(Box((1.0, 1.0, 1.0)), Pose((4.0, 0.0, 0.5))))
    return make_scene([Item(visual, 0, number, 0) for number, visual in enumerate(visuals)], pytest.fail)


def renderer() -> Renderer:
    return Renderer(Pinhole.from_field_of_view(64, 48, 1.2), 0.1, 50.0)


def test_a_picture_is_the_same_whoever_draws_in_between() -> None:
    shared = scene()
    alone = []
    for pose in (NEAR, FAR):
        camera = renderer()
        camera.render(scene(), *STILL, pose)
        alone.append(camera.paint(*STILL, SUN).copy())
    first, second = renderer(), renderer()
    first.render(shared, *STILL, NEAR)
    second.render(shared, *STILL, FAR)
    assert np.array_equal(first.paint(*STILL, SUN), alone[0])
    assert np.array_equal(second.paint(*STILL, SUN), alone[1])


def test_cameras_with_the_same_square_share_a_shadow_map() -> None:
    shared = scene()
    maps = shared.share(ShadowMaps)
    light, ahead = np.array((0.0, 0.0, -1.0)), np.array((1.0, 0.0, 0.0))
    one, same, other = (maps.at(*STILL, light, np.array(pose.position), ahead, 50.0) for pose in (NEAR, TURNED, FAR))
    assert one is same
    assert other is not one
    assert np.isfinite(one.depths).any()


@pytest.mark.slow
def test_a_map_that_no_camera_uses_is_dropped() -> None:
    maps = scene().share(ShadowMaps)
    light, ahead = np.array((0.0, 0.0, -1.0)), np.array((1.0, 0.0, 0.0))
    left = weakref.ref(maps.at(*STILL, light, np.array(NEAR.position), ahead, 50.0))
    for _ in range(400):
        maps.at(*STILL, light, np.array(FAR.position), ahead, 50.0)
    gc.collect()
    assert left() is None


@pytest.mark.slow
def test_the_scene_of_a_world_that_changed_is_freed() -> None:
    simulation = Simulation(world(box("crate", "3 0 0.5 0 0 0")))
    simulation.spawn(sdf.parse_model(EYE), "eye")
    assert any(isinstance(sample, ImageSample) for sample in simulation.advance(200_000_000))
    old = weakref.ref(simulation.stage.scene)
    simulation.delete("crate")
    simulation.advance(200_000_000)
    assert simulation.stage.scene is not old()
    gc.collect()
    assert old() is None


def test_parts_of_one_shape_share_its_triangles() -> None:
    """The picture is that of shapes of their own, which differ by nothing that is seen."""
    places = [Pose((4.0, -1.0, 1.0)), Pose((5.0, 1.0, 0.5), quaternion_from_yaw(0.6)), Pose((6.0, 0.2, 1.5))]
    alike = [Visual(Sphere(0.5), place) for place in places]
    unlike = [Visual(Sphere(0.5 + 1e-7 * number), place) for number, place in enumerate(places)]
    pictures = []
    for visuals, most in ((alike, 0.4), (unlike, 1.0)):
        ground = Visual(Plane(size=(200.0, 200.0)))
        items = [Item(visual, 0, number, number + 1) for number, visual in enumerate([ground, *visuals])]
        made = make_scene(items, pytest.fail)
        assert len(made.faces) <= most * len(made.face_part)
        camera = renderer()
        view = camera.render(made, *STILL, NEAR)
        assert set(np.unique(view.of_parts(made.labels))) == {0, 1, 2, 3, 4}
        pictures.append((camera.paint(*STILL, SUN).copy(), view.of_parts(made.labels)))
    np.testing.assert_allclose(pictures[0][0].astype(int), pictures[1][0], atol=1)
    assert np.array_equal(pictures[0][1], pictures[1][1])
