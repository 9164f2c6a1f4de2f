import numpy as np
import pytest

from daidalos.common.pose3 import Pose
from daidalos.description import sdf
from daidalos.description.geometry import Sphere
from daidalos.description.link import Visual
from daidalos.samples.sensors import ImageSample
from daidalos.simulation import Simulation
from daidalos.simulation.rendering.scene import Item, make_scene
from daidalos.simulation.rendering.shading import HEMISPHERE
from daidalos.simulation.rendering.shadows import simplify

SUN = (
    "<light name='sun' type='directional'><cast_shadows>true</cast_shadows><diffuse>0.6 0.6 0.6 1</diffuse>"
    "<direction>{} 0 -1</direction></light>"
)
LOOKS_DOWN = (
    "<model name='eye'><static>true</static><pose>0 0 6 0 1.5707963267948966 0</pose><link name='l'>"
    "<sensor name='s' type='camera'><update_rate>50</update_rate><camera><horizontal_fov>1.0</horizontal_fov>"
    "<image><width>200</width><height>200</height></image></camera></sensor></link></model>"
)
POLE = (
    "<model name='post'><static>true</static><pose>0 0 0.5 0 0 0</pose><link name='l'><visual name='v'>"
    "<geometry><box><size>0.4 0.4 1</size></box></geometry>{}</visual></link></model>"
)
FLOOR = (
    "<model name='floor'><static>true</static><link name='l'><visual name='v'><cast_shadows>false</cast_shadows>"
    "<geometry><plane><size>20 20</size></plane></geometry><material><ambient>1 1 1 1</ambient>"
    "<diffuse>1 1 1 1</diffuse></material></visual></link></model>"
)


def picture(*parts):
    simulation = Simulation(
        sdf.parse(f"<sdf version='1.9'><world name='w'>{FLOOR}{LOOKS_DOWN}{''.join(parts)}</world></sdf>")
    )
    return [s for s in simulation.advance(25_000_000) if isinstance(s, ImageSample)][-1].pixels


def ground(picture, x, y):
    """Return the brightness of the floor at a place; the camera looks down, its up is +x."""
    focal = 100 / np.tan(0.5)
    return int(picture[int(100 - focal * x / 6), int(100 - focal * y / 6), 0])


def test_a_post_throws_a_shadow_as_long_as_the_sun_is_low():
    """The sun shines towards +x at 45 degrees: the shadow of a post of 1 m reaches 1 m."""
    seen = picture(SUN.format(1), POLE.format(""))
    lit, dark = ground(seen, -1.0, 0.0), ground(seen, 0.8, 0.0)
    assert lit > dark + 60
    assert ground(seen, 1.1, 0.0) == pytest.approx(dark, abs=3)
    assert ground(seen, 1.3, 0.0) == pytest.approx(lit, abs=3)
    assert ground(seen, 0.8, 0.35) == pytest.approx(lit, abs=3)


def test_what_casts_no_shadow_leaves_the_floor_bright():
    seen = picture(SUN.format(1), POLE.format("<cast_shadows>false</cast_shadows>"))
    assert ground(seen, 0.8, 0.0) == ground(seen, -1.0, 0.0)


def test_a_point_light_lights_what_is_near_it():
    light = (
        "<light name='point' type='point'><pose>1 0 1 0 0 0</pose><diffuse>0.5 0.5 0.5 1</diffuse>"
        "<attenuation><range>5</range><constant>1</constant><linear>0</linear><quadratic>0</quadratic></attenuation>"
        "</light>"
    )
    seen = picture(light)
    ambient = 255 * 0.4 * (1 + HEMISPHERE)
    assert ground(seen, 1.0, 0.0) == pytest.approx(ambient + 255 * 0.5, abs=2)
    # Lambert: one metre aside of a light one metre up, the cosine is 1 / sqrt(2).
    assert ground(seen, 0.0, 0.0) == pytest.approx(ambient + 255 * 0.5 / np.sqrt(2), abs=2)


def test_a_shadow_follows_what_moves_and_stays_when_it_rests():
    simulation = Simulation(
        sdf.parse(
            f"<sdf version='1.9'><world name='w'>{FLOOR}{LOOKS_DOWN}{SUN.format(1)}{POLE.format('')}</world></sdf>"
        )
    )
    for place in (0.0, -1.5, -1.5, 0.5):
        simulation.set_pose("post", Pose((place, 0.0, 0.5)))
        # Longer than it takes to count as standing.
        samples = simulation.advance(900_000_000)
        pictures = [sample.pixels for sample in samples if isinstance(sample, ImageSample)]
        for seen in (pictures[0], pictures[-1]):
            lit = ground(seen, place - 1.0, 0.0)
            assert ground(seen, place + 0.8, 0.0) < lit - 60
            assert ground(seen, place + 1.3, 0.0) == pytest.approx(lit, abs=3)


def test_shapes_are_simplified_and_stay_closed():
    balls = [Visual(Sphere(0.5)), Visual(Sphere(0.2))]
    scene = make_scene([Item(ball, 0, number, 0) for number, ball in enumerate(balls)], pytest.fail)
    shapes = simplify(scene, 0.1)
    assert len(shapes.faces) < len(scene.faces) / 2
    assert shapes.face_ranges[-1, 1] == len(shapes.faces)
    for (first, last), (begin, end), radius in zip(shapes.face_ranges, shapes.vertex_ranges, (0.5, 0.2), strict=True):
        faces = shapes.faces[first:last]
        assert faces.min() >= begin
        assert faces.max() < end
        assert np.linalg.norm(shapes.vertices[begin:end], axis=1) == pytest.approx(radius, rel=1e-5)
        edges = np.concatenate((faces[:, (0, 1)], faces[:, (1, 2)], faces[:, (2, 0)]))
        assert sorted(map(tuple, edges.tolist())) == sorted(map(tuple, edges[:, ::-1].tolist()))
