import pytest

from daidalos.description import sdf
from daidalos.simulation import Simulation
from simulation.models import box, world

SECOND = 1_000_000_000
BODY = (
    "<link name='body'><pose>0 0 0.9 0 0 0</pose><collision name='c'><geometry><cylinder><radius>0.3</radius>"
    "<length>1.8</length></cylinder></geometry></collision></link>"
)


def walker(x):
    points = "".join(f"<waypoint><time>{t}</time><pose>{t} {x} 0 0 0 0</pose></waypoint>" for t in (0, 4))
    script = f"<script><loop>0</loop><trajectory id='0' type='walk'>{points}</trajectory></script>"
    return f"<actor name='walker'>{BODY}{script}</actor>"


def test_an_actor_walks_its_way_and_pushes():
    simulation = Simulation(world(walker(0), box("b", "2 0 0.5 0 0 0", "0.5 0.5 1")))
    simulation.advance(SECOND)
    assert simulation.pose("walker").position == pytest.approx((1, 0, 0), abs=0.03)
    assert simulation.pose("b").position[0] == pytest.approx(2, abs=1e-3)
    simulation.advance(4 * SECOND)
    assert simulation.pose("walker").position == pytest.approx((4, 0, 0), abs=0.03)
    assert simulation.pose("b").position[0] > 4.5
    simulation.delete("walker")
    assert simulation.models == ("ground_plane", "b")


def test_joints_between_models():
    tie = "<joint name='tie' type='ball'><parent>a::link</parent><child>b::link</child></joint>"
    parts = box("a", "0 0 5 0 0 0", "0.2 0.2 0.2", static=True) + box("b", "1 0 5 0 0 0", "0.2 0.2 0.2")
    text = f"<sdf version='1.9'><world name='w'>{parts}{tie.replace('</joint>', '<pose>-1 0 0 0 0 0</pose></joint>')}"
    simulation = Simulation(sdf.parse(f"{text}</world></sdf>"))
    distances = []
    for _ in range(40):
        simulation.advance(SECOND // 20)
        x, y, z = simulation.pose("b").position
        distances.append((x * x + y * y + (z - 5) ** 2) ** 0.5)
    assert distances == pytest.approx([1.0] * 40, abs=0.02)
    assert simulation.pose("b").position[2] < 4.9
    simulation.delete("b")
    simulation.advance(SECOND)
    assert not simulation._compilation.spec.equalities
