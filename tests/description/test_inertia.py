import numpy as np
import pytest
import trimesh

from daidalos.common.pose3 import Pose
from daidalos.description.geometry import Box, Capsule, Cone, Cylinder, Ellipsoid, Mesh, Plane, Polyline, Sphere
from daidalos.description.inertia import combine, implausibilities, link_properties, solid_properties
from daidalos.description.link import Collision, Inertial, Link
from daidalos.description.meshes import triangles_of

SHAPES = (
    Box((1, 2, 3)),
    Sphere(0.7),
    Cylinder(0.5, 2),
    Ellipsoid((1, 2, 3)),
    Capsule(0.5, 2),
    Cone(0.5, 2),
    Polyline((((0, 0), (3, 0), (0, 2)),), 1.5),
)


@pytest.mark.slow
@pytest.mark.parametrize("shape", SHAPES)
def test_solids_against_trimesh(shape):
    mesh = triangles_of(shape, segments=400)
    reference = trimesh.Trimesh(mesh.vertices, mesh.faces)
    reference.density = 500.0
    mine = solid_properties(shape, 500.0)
    assert mine.mass == pytest.approx(reference.mass, rel=5e-3)
    np.testing.assert_allclose(mine.center, reference.center_mass, atol=2e-3)
    np.testing.assert_allclose(mine.inertia, reference.moment_inertia, rtol=1e-2, atol=1e-2 * mine.inertia.max())


def test_closed_forms():
    sphere = solid_properties(Sphere(2.0), 3.0)
    assert sphere.mass == pytest.approx(3 * 4 / 3 * np.pi * 8)
    np.testing.assert_allclose(sphere.inertia, 0.4 * sphere.mass * 4 * np.eye(3))
    rod = solid_properties(Cylinder(1e-6, 3.0))
    assert rod.inertia[0, 0] == pytest.approx(rod.mass * 9 / 12, rel=1e-6)
    assert solid_properties(Plane()).mass == 0


def test_two_halves_make_a_whole():
    half = solid_properties(Box((1, 2, 3)))
    whole = combine([(half, Pose((0.5, 0, 0))), (half, Pose((-0.5, 0, 0)))])
    expected = solid_properties(Box((2, 2, 3)))
    assert whole.mass == pytest.approx(expected.mass)
    np.testing.assert_allclose(whole.inertia, expected.inertia)
    turned = combine([(half, Pose.from_xyz_rpy((0, 0, 1), (0, 0, np.pi / 2)))])
    np.testing.assert_allclose(turned.inertia, solid_properties(Box((2, 1, 3))).inertia, atol=1e-9)
    np.testing.assert_allclose(turned.center, [0, 0, 1])


def test_a_link_of_two_densities():
    link = Link(
        "l", collisions=(Collision(Box((1, 1, 1)), Pose((1, 0, 0))), Collision(Box((1, 1, 1)), Pose((-1, 0, 0))))
    )
    inertial = link_properties(link, densities=[300.0, 100.0])
    assert inertial.mass == pytest.approx(400)
    assert inertial.pose.position == pytest.approx((0.5, 0, 0))


def link(mass, *moments, at=(0, 0, 0), size=(0.2, 0.2, 0.2)):
    inertia = (moments[0], 0, 0, moments[1], 0, moments[2])
    return Link("l", inertial=Inertial(mass, Pose(at), inertia), collisions=(Collision(Box(size)),))


@pytest.mark.parametrize(
    ("doubtful", "words"),
    [
        (link(8, 0.05, 0.05, 0.05), None),
        (link(0, 0, 0, 0), "mass is zero"),
        (link(8, 0.05, 0.05, -0.05), "should be positive"),
        (link(8, 0.01, 0.01, 0.05), "more than the others together"),
        (link(8, 1, 1, 1), "moment of inertia 1 is too large for 8 kg within 0.173 m"),
        (link(800, 5, 5, 5), "is 1e+05 kg/m^3"),
        (link(1e-5, 1e-9, 1e-9, 1e-9), "0.00125 kg/m^3"),
        (link(8, 0.05, 0.05, 0.05, at=(1, 0, 0)), "far outside"),
        (Link("l", collisions=(Collision(Box((1, 1, 1))),)), "no inertial"),
        (Link("l"), None),
        (Link("l", Pose(), Inertial(1), collisions=(Collision(Mesh("x", None)),)), "should be positive"),
    ],
)
def test_doubts(doubtful, words):
    found = implausibilities(doubtful)
    assert (not found) if words is None else any(words in doubt for doubt in found)
