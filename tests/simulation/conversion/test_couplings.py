import math

import pytest

from daidalos.common.pose3 import Pose
from daidalos.description import sdf
from daidalos.simulation import Simulation

SECOND = 1_000_000_000
FIXED = "<joint name='w' type='fixed'><parent>world</parent><child>a</child></joint>"


def weightless(body):
    text = f"<sdf version='1.9'><world name='w'><gravity>0 0 0</gravity><model name='m'>{body}</model></world></sdf>"
    return Simulation(sdf.parse(text))


def link(name, x, y=0.0):
    return f"<link name='{name}'><pose>{x} {y} 0 0 0 0</pose></link>"


def joint(name, kind, parent, child, axis="0 0 1", pose="0 0 0 0 0 0", extra=""):
    return (
        f"<joint name='{name}' type='{kind}'><pose>{pose}</pose><parent>{parent}</parent><child>{child}</child>"
        f"<axis><xyz>{axis}</xyz></axis>{extra}</joint>"
    )


def test_a_screw_advances_with_each_turn():
    pitch = "<screw_thread_pitch>0.5</screw_thread_pitch>"
    simulation = weightless(link("a", 0) + link("b", 1) + FIXED + joint("j", "screw", "a", "b", extra=pitch))
    simulation.physics.data.qvel[0] = 2 * math.pi
    simulation.advance(SECOND)
    turned = simulation.joint("m", "j").position
    assert turned > 3
    assert simulation.pose("m", "b").position == pytest.approx((1, 0, 0.5 * turned / (2 * math.pi)), abs=2e-3)


def test_gears_turn_against_each_other():
    gears = link("a", 0) + link("b", 1) + link("c", 2) + FIXED
    gears += joint("jb", "revolute", "a", "b") + joint("jc", "revolute", "a", "c")
    gears += (
        "<joint name='g' type='gearbox'><parent>b</parent><child>c</child><gearbox_ratio>2</gearbox_ratio>"
        "<gearbox_reference_body>a</gearbox_reference_body><axis><xyz>0 0 1</xyz></axis>"
        "<axis2><xyz>0 0 1</xyz></axis2></joint>"
    )
    simulation = weightless(gears)
    simulation.physics.data.qvel[simulation.joint("m", "jb").dof] = 1.0
    simulation.advance(SECOND)
    first, second = simulation.joint("m", "jb").position, simulation.joint("m", "jc").position
    assert first == pytest.approx(0.2, abs=0.03)
    assert second == pytest.approx(-2 * first, abs=5e-3)


def test_a_four_bar_linkage_closes():
    """A parallelogram: the coupler stays parallel to the base while it swings."""
    bars = link("a", 0) + link("left", 0) + link("right", 1) + link("top", 0, 1) + FIXED
    bars += joint("jl", "revolute", "a", "left") + joint("jr", "revolute", "a", "right")
    bars += joint("lt", "revolute", "left", "top") + joint("rt", "revolute", "right", "top", pose="1 0 0 0 0 0")
    simulation = weightless(bars)
    simulation.physics.data.qvel[simulation.joint("m", "jl").dof] = 0.5
    simulation.advance(SECOND)
    angle = simulation.joint("m", "jl").position
    assert angle > 0.1
    top = simulation.pose("m", "top")
    assert top.position == pytest.approx((-math.sin(angle), math.cos(angle), 0), abs=5e-3)
    assert top.yaw == pytest.approx(0, abs=5e-3)
    assert simulation.joint("m", "jr").position == pytest.approx(angle, abs=5e-3)
    assert simulation.joint("m", "rt").position == pytest.approx(-angle, abs=5e-3)


def test_a_second_joint_to_the_world_holds():
    loop = link("a", 0) + link("b", 1) + FIXED + joint("j", "revolute", "a", "b", pose="-1 0 0 0 0 0")
    loop += "<joint name='w2' type='fixed'><parent>world</parent><child>b</child></joint>"
    simulation = weightless(loop)
    simulation.physics.data.qvel[0] = 1.0
    simulation.advance(SECOND)
    assert simulation.pose("m", "b").position == pytest.approx((1, 0, 0), abs=5e-3)


def test_joints_may_go_in_a_circle():
    """Each link hangs on the other: one joint makes the tree, the other closes the loop."""
    simulation = weightless(
        link("a", 0)
        + link("b", 1)
        + joint("j", "revolute", "a", "b")
        + joint("k", "revolute", "b", "a", pose="1 0 0 0 0 0")
    )
    simulation.physics.data.qvel[simulation.joint("m", "j").dof] = 1.0
    simulation.advance(SECOND // 2)
    assert simulation.joint("m", "k").position == pytest.approx(-simulation.joint("m", "j").position, abs=1e-3)


def test_a_loaded_four_bar_linkage_stays_closed():
    """Both ends of the loop stay together within 0.1 mm, under 200 N and with a swinging load."""

    def bar(name, place, end, mass):
        x, z = end
        return (
            f"<link name='{name}'><pose>{place[0]} 0 {place[1]} 0 0 0</pose><inertial><mass>{mass}</mass>"
            f"<pose>{x / 2} 0 {z / 2} 0 0 0</pose><inertia><ixx>0.02</ixx><iyy>0.02</iyy><izz>0.02</izz></inertia>"
            "</inertial></link>"
        )

    bars = bar("left", (0, 0), (0.2, -0.5), 1) + bar("right", (1, 0), (0, -0.6), 1)
    bars += bar("top", (0.2, -0.5), (0.8, -0.1), 20)
    bars += joint("jl", "revolute", "world", "left", "0 1 0") + joint("jr", "revolute", "world", "right", "0 1 0")
    bars += joint("lt", "revolute", "left", "top", "0 1 0")
    bars += joint("tr", "revolute", "top", "right", "0 1 0", "0 0 -0.6 0 0 0")
    world = f"<sdf version='1.9'><world name='w'><model name='m'>{bars}</model></world></sdf>"
    simulation = Simulation(sdf.parse(world))
    simulation.physics.data.qvel[simulation.joint("m", "jl").dof] = 3.0
    gaps = []
    for _ in range(500):
        simulation.step(2)
        top, right = simulation.pose("m", "top"), simulation.pose("m", "right")
        ends = top.transform((0.8, 0.0, -0.1)), right.transform((0.0, 0.0, -0.6))
        gaps.append(math.dist(*ends))
    assert max(gaps) < 1e-4


def test_what_loops_goes_with_its_model():
    loop = link("a", 0) + link("b", 1) + FIXED + joint("j", "revolute", "a", "b", pose="-1 0 0 0 0 0")
    loop += "<joint name='w2' type='fixed'><parent>world</parent><child>b</child></joint>"
    simulation = weightless(loop)
    simulation.delete("m")
    assert not simulation._compilation.spec.equalities
    assert simulation.physics.model.nbody == 1


BALL = (
    "<model name='{0}'><pose>{1} 0 1.1 0 0 0</pose><link name='l'><inertial><inertia><ixx>0.004</ixx><iyy>0.004</iyy>"
    "<izz>0.004</izz></inertia></inertial><collision name='c'><geometry><sphere><radius>0.1</radius></sphere>"
    "</geometry><surface><bounce><restitution_coefficient>{2}</restitution_coefficient></bounce></surface>"
    "</collision></link></model>"
)


@pytest.mark.parametrize("restitution", [0.0, 0.1, 0.3, 0.6, 0.9])
def test_balls_bounce_as_high_as_they_should(restitution):
    ground = "<include><uri>model://ground_plane</uri></include>"
    world = f"<sdf version='1.9'><world name='w'>{ground}{BALL.format('b', 0, restitution)}</world></sdf>"
    simulation = Simulation(sdf.parse(world))
    heights = []
    for _ in range(200):
        simulation.advance(SECOND // 200)
        heights.append(simulation.pose("b").position[2] - 0.1)
    low = heights.index(min(heights[:120]))
    assert max(heights[low:]) == pytest.approx(restitution**2, abs=0.04)


def test_collide_bitmasks_keep_things_apart():
    def box(name, z, mask):
        return (
            f"<model name='{name}'><pose>0 0 {z} 0 0 0</pose><static>{int(name == 'floor')}</static><link name='l'>"
            "<collision name='c'><geometry><box><size>1 1 1</size></box></geometry><surface><contact>"
            f"<collide_bitmask>{mask}</collide_bitmask></contact></surface></collision></link></model>"
        )

    parts = box("floor", 0, 1) + box("ghost", 1.2, 2) + box("stone", 3.5, 3)
    simulation = Simulation(sdf.parse(f"<sdf version='1.9'><world name='w'>{parts}</world></sdf>"))
    simulation.advance(2 * SECOND)
    assert simulation.pose("ghost").position[2] < -5
    assert simulation.pose("stone").position == pytest.approx(Pose((0, 0, 1)).position, abs=1e-2)
