import math

import numpy as np
import pytest

from daidalos.common.pose3 import Pose
from daidalos.description import sdf, urdf
from daidalos.description.kinematics import KinematicTree
from daidalos.simulation import Simulation
from description.robots import ARM
from simulation.models import box, world

SECOND = 1_000_000_000


ANCHORED = ARM.replace('<link name="base">', '<link name="world"/><link name="base">', 1).replace(
    "</robot>",
    '<joint name="w" type="fixed"><parent link="world"/><child link="base"/></joint></robot>',
)


def weightless(body, **options):
    text = f"<sdf version='1.9'><world name='w'><gravity>0 0 0</gravity><model name='m'>{body}</model></world></sdf>"
    return Simulation(sdf.parse(text), **options)


def two_links(kind, axis="<axis><xyz>0 0 1</xyz></axis>", extra=""):
    return (
        "<link name='a'><pose>0 0 1 0 0 0</pose></link><link name='b'><pose>1 0 1 0 0 0</pose></link>"
        "<joint name='w' type='fixed'><parent>world</parent><child>a</child></joint>"
        f"<joint name='j' type='{kind}'><pose>-0.5 0 0 0 0 0</pose><parent>a</parent><child>b</child>"
        f"{axis}{extra}</joint>"
    )


def push(simulation, dof, speed=1.0):
    """Set the speed of one degree of freedom and return where b is after a tenth of a second."""
    simulation.physics.data.qvel[dof] = speed
    simulation.advance(SECOND // 10)
    return simulation.pose("m", "b")


TWO_AXES = "<axis><xyz>0 0 1</xyz></axis><axis2><xyz>0 1 0</xyz></axis2>"


@pytest.mark.parametrize(
    ("kind", "axis", "dof", "expected"),
    [
        ("revolute", None, 0, Pose.from_xyz_rpy((0.5 + 0.5 * math.cos(0.1), 0.5 * math.sin(0.1), 1), (0, 0, 0.1))),
        ("prismatic", None, 0, Pose((1, 0, 1.1))),
        ("continuous", None, 0, Pose.from_xyz_rpy((0.5 + 0.5 * math.cos(0.1), 0.5 * math.sin(0.1), 1), (0, 0, 0.1))),
        ("universal", TWO_AXES, 1, Pose.from_xyz_rpy((0.5 + 0.5 * math.cos(0.1), 0, 1 - 0.5 * math.sin(0.1)),
                                                     (0, 0.1, 0))),
        ("ball", "", 1, Pose.from_xyz_rpy((0.5 + 0.5 * math.cos(0.1), 0, 1 - 0.5 * math.sin(0.1)), (0, 0.1, 0))),
    ],
)  # fmt: skip
def test_joints_move_about_their_anchor(kind, axis, dof, expected):
    simulation = weightless(two_links(kind) if axis is None else two_links(kind, axis))
    pose = push(simulation, dof)
    np.testing.assert_allclose(pose.matrix, expected.matrix, atol=2e-3)
    assert simulation.pose("m", "a") == Pose((0, 0, 1))


def test_fixed_joints_hold():
    simulation = weightless(two_links("fixed", ""))
    assert simulation.physics.model.nv == 0


def test_limits_hold():
    limits = "<axis><xyz>0 0 1</xyz><limit><lower>-0.2</lower><upper>0.3</upper></limit></axis>"
    simulation = weightless(two_links("revolute", limits))
    simulation.physics.data.qvel[0] = 3.0
    positions = []
    for _ in range(50):
        simulation.advance(SECOND // 100)
        positions.append(simulation.joint("m", "j").position)
    assert 0.29 < max(positions) < 0.32
    assert min(positions) > -0.22


def test_springs_and_damping():
    """A spring pulls to its reference; with damping it gets there."""
    axis = (
        "<axis><xyz>0 0 1</xyz><dynamics><damping>5</damping><spring_stiffness>20</spring_stiffness>"
        "<spring_reference>0.4</spring_reference></dynamics></axis>"
    )
    simulation = weightless(two_links("revolute", axis))
    simulation.advance(10 * SECOND)
    assert simulation.joint("m", "j").position == pytest.approx(0.4, abs=1e-3)


def test_links_are_where_forward_kinematics_says():
    """The same robot in MuJoCo and in `KinematicTree`, at random joint positions."""
    robot = urdf.parse(ANCHORED)
    tree, random = KinematicTree(robot), np.random.default_rng(0)
    simulation = Simulation(sdf.parse("<sdf version='1.9'><world name='w'/></sdf>"))
    place = Pose.from_xyz_rpy((1, 2, 3), (0.1, 0.2, 0.3))
    simulation.spawn(robot, "arm", place)
    for _ in range(5):
        positions = random.uniform(-1, 1, len(tree.joint_names))
        for name, value in zip(tree.joint_names, positions, strict=True):
            simulation.physics.data.qpos[simulation.joint("arm", name).qpos] = value
        mirrored = 2 * positions[tree.index("grip")] + 0.01
        simulation.physics.data.qpos[simulation.joint("arm", "grip_mirror").qpos] = mirrored
        simulation.physics.changed()
        matrices = dict(zip(tree.link_names, tree.link_matrices(positions), strict=True))
        for link in ("base", "upper", "fore", "finger", "thumb"):
            np.testing.assert_allclose(simulation.pose("arm", link).matrix, place.matrix @ matrices[link], atol=1e-9)


def test_mimics_follow():
    robot = urdf.parse(ANCHORED)
    simulation = Simulation(sdf.parse("<sdf version='1.9'><world name='w'><gravity>0 0 0</gravity></world></sdf>"))
    simulation.spawn(robot, "arm")
    assert simulation.joint("arm", "grip_mirror").position == pytest.approx(0.01, abs=1e-9)
    simulation.advance(SECOND // 10)
    np.testing.assert_allclose(simulation.physics.data.qvel, 0, atol=1e-6)  # nothing begins with a blow
    simulation.physics.data.qvel[simulation.joint("arm", "grip").dof] = 0.05
    simulation.advance(SECOND)
    grip, mirror = simulation.joint("arm", "grip").position, simulation.joint("arm", "grip_mirror").position
    assert mirror == pytest.approx(2 * grip + 0.01, abs=2e-3)


def test_links_without_mass_that_move_get_some():
    lines = []
    solid = "<collision><geometry><box size='1 1 1'/></geometry></collision>"
    robot = urdf.parse(f"<robot name='r'><link name='a'>{solid}</link></robot>", "r.urdf")
    simulation = Simulation(world(), warn=lines.append)
    simulation.spawn(robot, pose=Pose((0, 0, 0.5)))
    assert lines == ["r.urdf:1: link 'a' moves but has no mass; assumed 200 kg/m^3 for its collisions"]
    assert simulation.physics.model.body("r::a").mass[0] == pytest.approx(200)
    simulation.advance(SECOND)
    assert simulation.pose("r").position[2] == pytest.approx(0.5, abs=1e-2)


def test_a_footprint_without_mass_is_no_problem():
    mass = "<inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1'/></inertial>"
    robot = urdf.parse(
        f"<robot name='r'><link name='foot'/><link name='body'>{mass}</link><joint name='j' type='fixed'>"
        "<parent link='foot'/><child link='body'/></joint></robot>"
    )
    simulation = Simulation(world())
    simulation.spawn(robot)
    assert not simulation.warnings


def test_gravity_can_be_switched_off_for_a_link():
    model = "<model name='m'><pose>0 0 3 0 0 0</pose><link name='l'><gravity>false</gravity></link></model>"
    simulation = Simulation(world(model))
    simulation.advance(SECOND)
    assert simulation.pose("m").position == pytest.approx((0, 0, 3), abs=1e-6)


@pytest.mark.parametrize("collide", [False, True])
def test_self_collision_is_off_unless_asked_for(collide):
    ball = "<collision name='c'><geometry><sphere><radius>0.3</radius></sphere></geometry></collision>"
    links = "".join(f"<link name='{n}'><pose>{x} 0 0 0 0 0</pose>{ball}</link>" for n, x in (("a", 0), ("b", 0.5)))
    simulation = weightless(f"<self_collide>{str(collide).lower()}</self_collide>{links}")
    simulation.advance(SECOND // 10)
    distance = simulation.pose("m", "b").position[0] - simulation.pose("m", "a").position[0]
    assert distance == pytest.approx(0.5) if not collide else distance > 0.55


def test_missing_collision_meshes_are_left_out_with_a_line():
    lines = []
    robot = urdf.parse(
        "<robot name='r'><link name='a'><collision><geometry><mesh filename='package://x/a.stl'/></geometry>"
        "</collision></link></robot>",
        "r.urdf",
    )
    Simulation(world(), warn=lines.append).spawn(robot)
    assert lines[-1] == "r.urdf:1: mesh package://x/a.stl not found; the collision is left out"


@pytest.mark.parametrize("static", ["true", "false"])
def test_missing_files_of_visuals_are_named_though_no_camera_looks(static):
    lines = []
    visuals = "".join(
        f"<visual name='{kind}'><geometry><{kind}><uri>{kind}.bin</uri></{kind}></geometry></visual>\n"
        for kind in ("mesh", "heightmap")
    )
    text = f"<sdf version='1.9'><model name='m'><static>{static}</static><link name='l'>{visuals}</link></model></sdf>"
    Simulation(world(), warn=lines.append).spawn(sdf.parse_model(text, "m.sdf"))
    assert lines[:2] == [
        "m.sdf:1: mesh mesh.bin not found; the visual is not drawn",
        "m.sdf:2: heightmap heightmap.bin not found; the visual is not drawn",
    ]


def test_terrain_carries_at_its_height(tmp_path):
    """Dark in the south, bright in the north: the image's top row is the largest y."""
    image = pytest.importorskip("PIL.Image")
    heights = np.zeros((33, 33), dtype=np.uint8)
    heights[:16] = 255
    image.fromarray(heights).save(tmp_path / "h.png")
    terrain = (
        "<model name='t'><static>1</static><link name='l'><collision name='c'><geometry><heightmap><uri>h.png</uri>"
        "<size>20 20 2</size><pos>0 0 1</pos></heightmap></geometry></collision></link></model>"
    )
    boxes = box("north", "0 5 4 0 0 0") + box("south", "0 -5 4 0 0 0")
    text = f"<sdf version='1.9'><world name='w'>{terrain}{boxes}</world></sdf>"
    simulation = Simulation(sdf.parse(text, str(tmp_path / "w.sdf")))
    simulation.advance(2 * SECOND)
    assert simulation.pose("north").position == pytest.approx((0, 5, 3.5), abs=2e-2)
    assert simulation.pose("south").position == pytest.approx((0, -5, 1.5), abs=2e-2)
    simulation.delete("t")
    assert not simulation._compilation.spec.hfields


def test_zero_outside_the_limits_starts_at_the_nearest():
    limits = "<axis><xyz>0 0 1</xyz><limit><lower>0.5</lower><upper>1</upper></limit></axis>"
    simulation = weightless(two_links("revolute", limits))
    assert simulation.joint("m", "j").position == 0.5
    simulation.advance(SECOND // 10)
    simulation.reset()
    assert simulation.joint("m", "j").position == 0.5


def test_equal_limits_lock():
    limits = "<axis><xyz>0 0 1</xyz><limit><lower>0.3</lower><upper>0.3</upper></limit></axis>"
    simulation = weightless(two_links("revolute", limits))
    simulation.advance(SECOND)
    assert simulation.joint("m", "j").position == pytest.approx(0.3, abs=1e-3)


def test_an_infinite_plane_stays_where_it_is():
    text = "<robot name='floor'><link name='floor'><collision><geometry><plane/></geometry></collision></link></robot>"
    lines = []
    simulation = Simulation(world(), warn=lines.append)
    simulation.spawn(urdf.parse(text), pose=Pose((0, 0, 2)))
    simulation.step(100)
    assert simulation.pose("floor") == Pose((0, 0, 2))
    assert lines[-1].endswith("link 'floor' stays where it is, as an infinite plane cannot move")


def test_shapes_without_size_are_left_out_with_a_line():
    lines = []
    shape = "<collision><geometry><sphere radius='0'/></geometry></collision>"
    robot = urdf.parse(f"<robot name='r'><link name='a'>{shape}</link></robot>", "r.urdf")
    Simulation(world(), warn=lines.append).spawn(robot)
    assert lines[-1] == "r.urdf:1: a sphere needs positive sizes, got 0; the collision is left out"


def test_floating_joints_bind_nothing():
    simulation = Simulation(world())
    robot = urdf.parse(
        "<robot name='r'><link name='a'/><link name='b'/><joint name='j' type='floating'><parent link='a'/>"
        "<child link='b'/><origin xyz='2 0 0'/></joint></robot>"
    )
    simulation.spawn(robot, pose=Pose((0, 0, 5)))
    assert simulation.pose("r", "b") == Pose((2, 0, 5))
    simulation.advance(SECOND // 10)
    assert simulation.physics.model.nv == 12


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "count"), [("fixed", 1000), ("revolute", 520)])
def test_an_arm_may_have_more_links_than_python_calls_functions_within_each_other(kind, count):
    links = "".join(
        f"<link name='l{i}'><inertial><mass value='0.1'/><inertia ixx='1e-3' iyy='1e-3' izz='1e-3'/></inertial></link>"
        for i in range(count + 1)
    )
    joints = "".join(
        f"<joint name='j{i}' type='{kind}'><parent link='l{i}'/><child link='l{i + 1}'/><origin xyz='0 0 0.1'/>"
        "<limit lower='-1' upper='1' effort='1' velocity='1'/></joint>"
        for i in range(count)
    )
    simulation = Simulation(world())
    name = simulation.spawn(urdf.parse(f"<robot name='long'>{links}{joints}</robot>"))
    assert simulation.instance(name).link(f"l{count}").pose.position[2] == pytest.approx(0.1 * count)


def test_a_static_nested_model_stays_in_a_model_that_falls():
    """What hangs on it by a joint hangs as well, and the rest falls."""
    cube = "<collision name='c'><geometry><box><size>0.1 0.1 0.1</size></box></geometry></collision>"
    link = f"<link name='{{}}'><pose>{{}} 0 0 0</pose>{cube}</link>"
    joint = "<joint name='{}' type='fixed'><parent>{}</parent><child>{}</child></joint>"
    wall = f"<model name='wall'><static>1</static>{link.format('l', '0 0 5')}</model>"
    links = [link.format(name, place) for name, place in (("lamp", "0 0 4"), ("sign", "0 2 4"), ("stone", "3 0 4"))]
    joints = [joint.format("j", "wall::l", "lamp"), joint.format("k", "sign", "wall::l")]
    described = world(f"<model name='m'>{''.join((wall, *links, *joints))}</model>")
    simulation = Simulation(described, warn=lambda line: None)
    simulation.advance(SECOND // 2)
    assert simulation.pose("m", "wall::l") == Pose((0, 0, 5))
    assert simulation.pose("m", "lamp") == Pose((0, 0, 4))
    np.testing.assert_allclose(simulation.pose("m", "sign").position, (0, 2, 4), atol=2e-3)
    assert simulation.pose("m", "stone").position[2] == pytest.approx(4 - 9.8 / 8, abs=0.02)
