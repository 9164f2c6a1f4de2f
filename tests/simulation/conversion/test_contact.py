import mujoco
import pytest

from daidalos.description.link import Surface
from daidalos.simulation.conversion.contact import friction_of, set_surface


@pytest.mark.parametrize(
    ("surface", "friction"),
    [
        (Surface(), 1.0),
        (Surface(mu=0.4), 0.4),
        (Surface(mu=0.4, mu2=0.2), 0.3),
        (Surface(mu=1e5, mu2=1e5), 2.0),
        (Surface(mu=0.0, mu2=0.0), 0.0),
        (Surface(mu=-1.0), 0.0),
    ],
)
def test_coefficients(surface, friction):
    assert friction_of(surface) == pytest.approx(friction)


@pytest.mark.parametrize("mus", [(1.0, 0.2), (100.0, 1e5), (0.5, 0.0)])
def test_the_smaller_friction_of_two_surfaces_counts(mus):
    spec = mujoco.MjSpec()
    for place, mu in enumerate(mus):
        body = spec.worldbody.add_body(pos=[0, 0, 0.19 * place])
        if place:
            body.add_freejoint()
        geom = body.add_geom(type=mujoco.mjtGeom.mjGEOM_SPHERE, size=[0.1, 0, 0])
        set_surface(geom, Surface(mu=mu))
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    smaller = min(*mus, 2.0)
    assert data.ncon == 1
    assert data.contact.dim[0] == (1 if smaller == 0 else 3)
    if smaller:
        assert data.contact.friction[0, 0] == pytest.approx(smaller)
