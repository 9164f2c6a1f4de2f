import pytest

from daidalos.description import sdf
from daidalos.description.geometry import Box, Cylinder, Ellipsoid, Mesh, Polyline, Sphere
from daidalos.description.primitives import primitive
from daidalos.description.scaling import scaled, scaled_geometry, stretched_geometry

TEXT = """<sdf version="1.9"><model name="m"><link name="a"><pose>1 0 0 0 0 0</pose><inertial><mass>2</mass>
<inertia><ixx>3</ixx></inertia></inertial><collision name="c"><pose>0 0 1 0 0 0</pose><geometry><box><size>1 2 3</size>
</box></geometry></collision></link><link name="b"/><joint name="j" type="prismatic"><parent>a</parent><child>b</child>
<axis><xyz>0 0 1</xyz><limit><lower>-1</lower><upper>2</upper></limit></axis></joint></model></sdf>"""


def test_lengths_areas_and_weights_grow_as_they_should():
    model = scaled(sdf.parse_model(TEXT), 2.0)
    link = model.links["a"]
    assert link.pose.position == (2, 0, 0)
    assert (link.inertial.mass, link.inertial.inertia[0]) == (2 * 8, 3 * 32)
    assert link.collisions[0].geometry == Box((2, 4, 6))
    assert link.collisions[0].pose.position == (0, 0, 2)
    assert (model.joints["j"].axis.lower, model.joints["j"].axis.upper) == (-2, 4)


def test_every_shape_is_scaled():
    assert scaled_geometry(Sphere(1.5), 2) == Sphere(3.0)
    assert scaled_geometry(Cylinder(1, 2), 0.5) == Cylinder(0.5, 1.0)
    assert scaled_geometry(Mesh("m.stl", None, scale=(1, 1, -1)), 3).scale == (3, 3, -3)
    assert scaled_geometry(Polyline((((0, 0), (1, 0), (0, 1)),), 1.0), 2).outlines == (((0, 0), (2, 0), (0, 2)),)


def test_shapes_are_stretched_along_their_axes():
    assert stretched_geometry(Box((1, 2, 3)), (2, 3, 1)) == Box((2, 6, 3))
    assert stretched_geometry(Sphere(1.0), (1, 2, 3)) == Ellipsoid((1, 2, 3))
    assert stretched_geometry(Cylinder(1, 2), (3, 3, 0.5)) == Cylinder(3, 1.0)
    with pytest.raises(ValueError, match="a cylinder cannot be scaled by 1, 2, 1"):
        stretched_geometry(Cylinder(1, 2), (1, 2, 1))


def test_a_stretched_box_weighs_and_turns_like_one_of_that_size():
    model = scaled(primitive("box", (1.0, 2.0, 3.0), 2.0, (0, 0, 0, 1)), (2.0, 1.0, 0.5))
    inertial = primitive("box", (2.0, 2.0, 1.5), 2.0, (0, 0, 0, 1)).links["link"].inertial
    assert model.links["link"].inertial.mass == inertial.mass
    assert model.links["link"].inertial.inertia == pytest.approx(inertial.inertia)


def test_a_model_of_several_links_is_not_stretched():
    with pytest.raises(ValueError, match="m can only be scaled as a whole"):
        scaled(sdf.parse_model(TEXT), (1.0, 1.0, 2.0))


def test_a_factor_should_be_positive():
    with pytest.raises(ValueError, match="positive, got 0"):
        scaled(sdf.parse_model(TEXT), 0.0)
