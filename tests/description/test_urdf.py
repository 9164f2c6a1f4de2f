import math
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from daidalos.common.pose3 import Pose
from daidalos.description import urdf
from daidalos.description.errors import DescriptionError
from daidalos.description.geometry import Box, Capsule, Cylinder, Empty, Mesh, Plane
from daidalos.description.joint import JointType
from daidalos.description.markup import parse_markup
from description.robots import ARM, SHARE, problem_of, share_of
from properties import examples


def test_everything_in_a_robot_is_read():
    robot = urdf.parse(ARM)
    assert (robot.name, robot.root) == ("arm", "base")
    assert list(robot.links) == ["base", "upper", "fore", "finger", "thumb"]
    base = robot.links["base"]
    assert base.visuals[0].geometry == Box((1, 2, 3))
    assert base.visuals[0].material.color == (0, 0, 0.8, 1)
    assert base.collisions[0].geometry == Cylinder(0.1, 1)
    assert base.collisions[0].pose == Pose((0, 0, 0.5))
    assert base.inertial.mass == 2
    shoulder = robot.joints["shoulder"]
    assert shoulder.type is JointType.REVOLUTE
    assert shoulder.axis.xyz == (0, 1, 0)
    assert (shoulder.axis.lower, shoulder.axis.upper) == (-1, 2)
    assert (shoulder.axis.effort, shoulder.axis.velocity) == (10, 3)
    assert (shoulder.axis.damping, shoulder.axis.friction) == (0.5, 0.1)
    assert shoulder.safety.k_velocity == 4
    assert shoulder.calibration.rising == 0.2
    assert shoulder.calibration.falling is None
    assert robot.joints["elbow"].axis.upper == math.inf
    assert robot.joints["grip_mirror"].mimic.multiplier == 2
    assert robot.transmissions[0].joints[0].hardware_interfaces == ("EffortJointInterface",)
    assert robot.transmissions[0].actuators[0].mechanical_reduction == 50
    assert robot.gazebo[0].reference == "upper"
    assert robot.ros2_control[0].attribute("name") == "c"


@pytest.mark.parametrize(
    ("old", "new", "line", "words"),
    [
        ('<link name="upper"/>', '<link name="base"/>', 9, "defined before"),
        ('<link name="upper"/>', "<link/>", 9, '"name" is missing'),
        ('<parent link="upper"/>', '<parent link="uper"/>', 20, "parent link 'uper' does not exist"),
        ('type="continuous"', 'type="spinning"', 20, "unknown joint type 'spinning'"),
        ('xyz="0 2 0"', 'xyz="0 0 0"', 13, "no direction"),
        ('xyz="0 2 0"', 'xyz="0 2"', 15, "should be 3 numbers"),
        ('<mass value="2"/>', '<mass value="two"/>', 7, "should be a number, got 'two'"),
        ('<mass value="2"/>', '<mass value="-2"/>', 7, "mass should not be negative"),
        ('<box size="1 2 3"/>', '<bax size="1 2 3"/>', 5, "expected one of box"),
        ('<child link="thumb"/>', '<child link="finger"/>', 27, "child of more than one joint"),
        ('<link name="thumb"/>', '<link name="thumb"/><link name="lost"/>', 2, "have no parent: base, lost"),
    ],
)
def test_mistakes_are_named_with_their_place(old, new, line, words):
    assert ARM.count(old) == 1
    with pytest.raises(DescriptionError) as caught:
        urdf.parse(ARM.replace(old, new), "arm.urdf")
    assert words in str(caught.value)
    assert (caught.value.source, caught.value.line) == ("arm.urdf", line)
    assert "\n" not in str(caught.value)


def test_a_revolute_joint_needs_limits():
    with pytest.raises(DescriptionError, match="a revolute joint needs <limit>"):
        urdf.parse(ARM.replace('<limit lower="-1" upper="2" effort="10" velocity="3"/>', ""))


def test_a_mimic_of_nothing_is_noted():
    robot = urdf.parse(ARM.replace('<mimic joint="grip"', '<mimic joint="grap"'), "arm.urdf")
    assert robot.warnings == ("arm.urdf:27: joint 'grip_mirror' mimics 'grap', which does not exist",)
    assert robot.joints["grip_mirror"].mimic is None


def test_what_the_kinematics_do_not_need_is_left_out_with_a_warning():
    text = ARM.replace('<mass value="2"/>', "").replace(">50</mech", ">reduction</mech")
    robot = urdf.parse(text, "arm.urdf")
    assert [line.partition(": ")[2] for line in robot.warnings] == [
        "<inertial>: <mass> is missing, the inertial is left out",
        "<mechanicalReduction>: the text should be a number, got 'reduction'; the transmission is left out",
    ]
    assert not robot.transmissions


def test_a_joint_may_hang_on_the_world_without_a_link_of_that_name():
    robot = urdf.parse(
        "<robot name='r'><link name='a'/>\n<joint name='j' type='fixed'><parent link='world'/><child link='a'/>"
        "</joint></robot>",
        "r.urdf",
    )
    assert robot.root == "world"
    assert "r.urdf:2: link 'world' does not exist and was added" in robot.warnings[0]


def test_what_bullet_adds_is_read_with_a_warning():
    robot = urdf.parse(
        """<robot name="b">
        <link name="floor"><collision><geometry><plane normal="0 1 0"/></geometry></collision></link>
        <link name="ball"><collision><geometry><cdf filename="bowl.cdf"/></geometry></collision></link>
        <joint name="neck" type="spherical"><parent link="floor"/><child link="ball"/></joint></robot>"""
    )
    assert robot.links["floor"].collisions[0].geometry == Plane((0, 1, 0))
    assert robot.links["ball"].collisions[0].geometry == Empty()
    assert (robot.joints["neck"].type, robot.joints["neck"].axes) == (JointType.BALL, ())
    assert [re.search(r":(\d+): .*Bullet", warning)[1] for warning in robot.warnings] == ["2", "3", "4"]


def test_a_xacro_file_may_be_called_urdf(tmp_path):
    file = tmp_path / "robot.urdf"
    file.write_text(
        """<robot name="r" xmlns:xacro="http://ros.org/wiki/xacro"><xacro:arg name="side" default="2"/>
        <link name="base"><visual><geometry><box size="1 1 $(arg side)"/></geometry></visual></link></robot>"""
    )
    assert urdf.load(file, {"side": "3"}).links["base"].visuals[0].geometry == Box((1, 1, 3))


@pytest.mark.parametrize(
    ("links", "pairs", "line", "ways"),
    [
        ("ab", ("ab", "ba"), 2, "a -> b -> a|b -> a -> b"),
        ("rab", ("ab", "ba"), 2, "a -> b -> a|b -> a -> b"),
        ("abcd", ("ab", "bc", "ca", "ad"), 3, "a -> b -> c -> a|b -> c -> a -> b|c -> a -> b -> c"),
    ],
)
def test_a_loop_is_no_tree(links, pairs, line, ways):
    text = "".join(f"<link name='{name}'/>" for name in links) + "\n".join(
        f"<joint name='{p}{c}' type='fixed'><parent link='{p}'/><child link='{c}'/></joint>" for p, c in pairs
    )
    with pytest.raises(
        DescriptionError, match=rf"^r.urdf:{line}: <joint name=\"..\">: the joints form a loop: ({ways})$"
    ):
        urdf.parse(f"<robot name='r'>{text}</robot>", "r.urdf")


@pytest.mark.parametrize("leaders", [{"a": "a"}, {"a": "b", "b": "a"}, {"a": "b", "b": "c", "c": "b"}])
def test_a_joint_that_follows_itself_does_not(leaders):
    names = "abc"
    links = "".join(f"<link name='{name}'/>" for name in "r" + names)
    joints = "".join(
        f"<joint name='{name}' type='continuous'><parent link='r'/><child link='{name}'/>"
        + (f"<mimic joint='{leaders[name]}'/>" if name in leaders else "")
        + "</joint>"
        for name in names
    )
    robot = urdf.parse(f"<robot name='r'>{links}{joints}</robot>", "r.urdf")
    assert [line.partition(": ")[2].partition(" mimics")[2] for line in robot.warnings] == [" itself"]
    for name in names:
        seen = set()
        while (mimic := robot.joints[name].mimic) is not None:
            assert name not in seen
            seen.add(name)
            name = mimic.joint


def test_a_material_that_nobody_defines_is_noted():
    text = "<robot name='r'><link name='a'>\n<visual><geometry><sphere radius='1'/></geometry><material name='{}'/>"
    text += "</visual></link><material name='red'><color rgba='1 0 0 1'/></material></robot>"
    assert urdf.parse(text.format("red")).warnings == ()
    assert urdf.parse(text.format("rde"), "r.urdf").warnings == ("r.urdf:2: material 'rde' is not defined",)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("<sdf/>", "expected <robot>"),
        ("<robot name='r'/>", "no link"),
    ],
)
def test_what_is_no_robot(text, words):
    with pytest.raises(DescriptionError, match=words):
        urdf.parse(text)


def test_missing_file(tmp_path):
    with pytest.raises(DescriptionError, match="no such file"):
        urdf.load(tmp_path / "no.urdf")


def test_mesh_addresses_scales_and_capsules(tmp_path):
    (tmp_path / "m.stl").touch()
    shapes = (
        '<mesh filename="m.stl" scale="1 -1 2"/>',
        '<mesh filename="package://nowhere/m.stl"/>',
        '<capsule radius="1" length="2"/>',
    )
    visuals = "".join(f"<visual><geometry>{shape}</geometry></visual>" for shape in shapes)
    file = tmp_path / "r.urdf"
    file.write_text(f"<robot name='r'><link name='a'>{visuals}</link></robot>")
    near, unknown, capsule = (visual.geometry for visual in urdf.load(file).links["a"].visuals)
    assert near == Mesh("m.stl", tmp_path / "m.stl", (1, -1, 2))
    assert near.where == f"{file}:1"
    assert unknown.path is None
    assert capsule == Capsule(1, 2)


@pytest.mark.parametrize("name", ["waffle", "burger"])
def test_the_turtlebots_load(name):
    path = SHARE / f"turtlebot3_description/urdf/turtlebot3_{name}.urdf.xacro"
    robot = urdf.load(path, resolve=share_of)
    assert robot.root == "base_footprint"
    assert {"base_link", "wheel_left_link", "wheel_right_link", "imu_link", "base_scan"} <= set(robot.links)
    meshes = [v.geometry for link in robot.links.values() for v in link.visuals]
    assert meshes
    assert all(mesh.path is not None for mesh in meshes)
    assert not robot.warnings


@examples(200)
@given(st.data())
def test_damaged_robots_give_robots_or_descriptions_errors(data):
    """Change one attribute or drop one element: either it still is a robot or the error has a place."""
    root = parse_markup(ARM, "arm.urdf")
    element = data.draw(st.sampled_from(list(root.walk())))
    if element.children and data.draw(st.booleans()):
        element.children.remove(data.draw(st.sampled_from(element.children)))
    elif element.attributes:
        key = data.draw(st.sampled_from(sorted(element.attributes)))
        element.attributes[key] = data.draw(st.text(st.characters(codec="ascii", categories=["L", "N", "P"])))
    problem = problem_of(lambda: urdf.read_robot(root))
    assert problem is None or re.match(r"arm.urdf:\d+: <", problem)


def test_rests_of_xacro_in_a_urdf_are_ignored_with_a_warning(tmp_path):
    file = tmp_path / "robot.urdf"
    file.write_text(
        '<robot name="r" xmlns:xacro="http://ros.org/wiki/xacro">\n<link name="base">\n<xacro:grey/></link>'
        "<xacro:sensors/></robot>"
    )
    robot = urdf.load(file)
    assert list(robot.links) == ["base"]
    assert robot.warnings[0].startswith(f"{file}:3: <xacro:grey>: xacro can not expand it")
    file.rename(tmp_path / "robot.urdf.xacro")
    with pytest.raises(DescriptionError, match="unknown macro name: xacro:grey"):
        urdf.load(tmp_path / "robot.urdf.xacro")


def test_part_of_a_robot_may_hang_on_a_link_that_is_elsewhere():
    joint = '<joint name="{0}" type="fixed"><parent link="{1}"/><child link="{2}"/></joint>'
    links = '<robot name="r"><link name="a"/><link name="b"/>\n'
    robot = urdf.parse(links + joint.format("i", "hand", "a") + joint.format("j", "a", "b") + "</robot>", "r.urdf")
    assert robot.root == "hand"
    assert "r.urdf:2: link 'hand' does not exist and was added" in robot.warnings[0]
    with pytest.raises(DescriptionError, match=r"r\.urdf:2: .*its parent link 'aa' does not exist"):
        urdf.parse(links + joint.format("j", "aa", "b") + "</robot>", "r.urdf")


def test_a_robot_without_name_is_noted():
    robot = urdf.parse("<robot>\n<link name='a'/></robot>", "r.urdf")
    assert robot.name == "robot"
    assert "r.urdf:1: <robot> has no name" in robot.warnings[0]
