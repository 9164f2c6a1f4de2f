import pytest

from daidalos.description.geometry import Box, Cylinder, Sphere
from daidalos.description.primitives import primitive


def test_shapes_weigh_what_they_should():
    """Closed forms: m (b^2 + c^2) / 12, 2 m r^2 / 5, m r^2 / 2."""
    box = primitive("box", (1, 2, 3), 6.0).links["link"]
    assert box.collisions[0].geometry == Box((1, 2, 3))
    assert box.inertial.inertia[0] == pytest.approx(6 * (4 + 9) / 12)
    sphere = primitive("sphere", (2, 0, 0), 5.0).links["link"]
    assert sphere.visuals[0].geometry == Sphere(1.0)
    assert sphere.inertial.inertia[3] == pytest.approx(2.0)
    cylinder = primitive("cylinder", (2, 0, 4), 3.0).links["link"]
    assert cylinder.visuals[0].geometry == Cylinder(1.0, 4)
    assert cylinder.inertial.inertia[5] == pytest.approx(1.5)


def test_without_weight_it_never_moves():
    assert primitive("box", (1, 1, 1), 0.0).static


@pytest.mark.parametrize(
    ("shape", "size", "mass", "words"),
    [
        ("cube", (1, 1, 1), 1, "no shape 'cube'"),
        ("sphere", (0, 1, 1), 1, "positive sizes"),
        ("box", (1, 1, 1), -1, "mass"),
    ],
)
def test_nonsense_is_named(shape, size, mass, words):
    with pytest.raises(ValueError, match=words):
        primitive(shape, size, mass)
