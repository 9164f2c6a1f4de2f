import math

import pytest

from daidalos.description import urdf
from daidalos.description.errors import DescriptionError
from daidalos.description.markup import parse_markup
from daidalos.description.xacro import load_xacro

ROBOT = """<?xml version="1.0"?>
<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="mass" default="1"/>
  <xacro:property name="half" value="${pi/2}"/>
  <xacro:include filename="wheel.xacro"/>
  <link name="base"/>
  <xacro:wheel side="left">
    <origin rpy="${-M_PI*0.5} 0 ${half}"/>
  </xacro:wheel>
</robot>
"""
WHEEL = """<?xml version="1.0"?>
<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="wheel" params="side *place">
    <link name="${side}_wheel">
      <inertial><mass value="$(arg mass)"/></inertial>
    </link>
    <joint name="${side}_joint" type="continuous">
      <parent link="base"/><child link="${side}_wheel"/>
      <xacro:insert_block name="place"/>
    </joint>
  </xacro:macro>
</robot>
"""


@pytest.fixture
def files(tmp_path):
    (tmp_path / "wheel.xacro").write_text(WHEEL)
    (tmp_path / "r.urdf.xacro").write_text(ROBOT)
    return tmp_path


def change(path, old, new):
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))


def test_macros_blocks_arguments_and_m_pi(files):
    robot = urdf.load(files / "r.urdf.xacro", {"mass": "3"})
    assert robot.links["left_wheel"].inertial.mass == 3
    roll, _, yaw = robot.joints["left_joint"].origin.rpy
    assert (roll, yaw) == pytest.approx((-math.pi / 2, math.pi / 2))
    assert urdf.load(files / "r.urdf.xacro").links["left_wheel"].inertial.mass == 1


def test_elements_know_where_they_were_written(files):
    joint = urdf.load(files / "r.urdf.xacro").joints["left_joint"]
    assert joint.where == f"{files / 'wheel.xacro'}:7"


def test_the_text_carries_no_marks(files):
    text = load_xacro(files / "r.urdf.xacro")
    assert "daidalos" not in text
    assert "xacro:" not in text
    assert parse_markup(text).require("joint").attribute("name") == "left_joint"


def test_find_asks_the_resolver(files):
    change(files / "r.urdf.xacro", "wheel.xacro", "$(find my_robot)/wheel.xacro")
    assert "left_wheel" in urdf.load(files / "r.urdf.xacro", resolve=lambda name: files).links


def test_find_knows_the_package_around_the_file(files):
    change(files / "r.urdf.xacro", "wheel.xacro", "$(find my_robot)/wheel.xacro")
    (files / "package.xml").write_text("<package format='3'><name>my_robot</name></package>")
    assert "left_wheel" in urdf.load(files / "r.urdf.xacro").links


def test_an_own_m_pi_wins(files):
    change(files / "r.urdf.xacro", "<link name", '<xacro:property name="M_PI" value="3"/><link name')
    assert urdf.load(files / "r.urdf.xacro").joints["left_joint"].origin.rpy[0] == pytest.approx(-1.5)


@pytest.mark.parametrize(
    ("file", "old", "new", "place", "words"),
    [
        ("r.urdf.xacro", "M_PI*0.5", "TAU", "r.urdf.xacro:8", "name 'TAU' is not defined"),
        ("wheel.xacro", "$(arg mass)", "heavy", "wheel.xacro:5", "should be a number, got 'heavy'"),
        ("r.urdf.xacro", "wheel.xacro", "whel.xacro", "r.urdf.xacro:5", "no such file or directory"),
        (
            "r.urdf.xacro",
            "wheel.xacro",
            "$(find nobody)/w.xacro",
            "r.urdf.xacro:5",
            "package 'nobody' not found",
        ),
        ("r.urdf.xacro", "xacro:wheel", "xacro:wheal", "r.urdf.xacro:7", "unknown macro name: xacro:wheal"),
        ("r.urdf.xacro", ' side="left"', "", "r.urdf.xacro:7", "undefined parameters [side]"),
        ("wheel.xacro", "</joint>", "", "wheel.xacro:11", "mismatched tag"),
        ("r.urdf.xacro", "wheel.xacro", "r.urdf.xacro", "r.urdf.xacro:5", "the file includes itself"),
        (
            "wheel.xacro",
            "</joint>",
            '</joint><xacro:wheel side="x"><origin/></xacro:wheel>',
            "r.urdf.xacro:7",
            "<xacro:wheel>: the macro calls itself without end",
        ),
    ],
)
def test_mistakes_are_named_with_their_place(files, file, old, new, place, words):
    change(files / file, old, new)
    with pytest.raises(DescriptionError) as caught:
        urdf.load(files / "r.urdf.xacro")
    assert words in str(caught.value)
    assert str(caught.value).startswith(str(files / place))
    assert "\n" not in str(caught.value)


def test_a_mistake_leaves_nothing_behind(files):
    good = files / "good.urdf.xacro"
    good.write_text(ROBOT)
    change(files / "r.urdf.xacro", "M_PI*0.5", "TAU")
    with pytest.raises(DescriptionError):
        urdf.load(files / "r.urdf.xacro", {"mass": "9"})
    assert urdf.load(good).links["left_wheel"].inertial.mass == 1


def test_missing_file(tmp_path):
    with pytest.raises(DescriptionError, match="no such file"):
        load_xacro(tmp_path / "no.xacro")
