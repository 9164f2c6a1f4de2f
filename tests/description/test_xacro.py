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


HOSTILE = {
    "power": '<a v="${9**9**9**9}"/>',
    "escape": """<a v="${().__class__.__bases__[0].__subclasses__()}"/>""",
    "format": """<a v="${'{0.__class__.__init__.__globals__}'.format(xacro.load_yaml)}"/>""",
    "substitution": """<a v="$(eval ().__class__)"/>""",
    "substituted power": """<a v="$(eval 9**9**9**9)"/>""",
    "vars": """<a v="${python.vars(python.str)}"/>""",
    "growing properties": "".join(
        f'<xacro:property name="p{k + 1}" value="${{p{k}}}${{p{k}}}"/>' for k in range(60)
    ).join(['<xacro:property name="p0" value="xx"/>', '<a v="${p60}"/>']),
    "growing macros": "".join(
        f'<xacro:macro name="m{k + 1}"><xacro:m{k}/><xacro:m{k}/></xacro:macro>' for k in range(60)
    ).join(['<xacro:macro name="m0"><a/></xacro:macro>', "<xacro:m60/>"]),
    "pattern": """<a v="${xacro.tokenize('a' * 40, ']|(a+)+$[')}"/><a v="${xacro.nothing}"/>""",
    "file": """<a v="${xacro.load_yaml('/etc/passwd')}"/>""",
    "file above": """<a v="${xacro.load_yaml('../outside.yaml')}"/>""",
    "file behind a link": """<a v="${xacro.load_yaml('link.yaml')}"/>""",
    "YAML bomb": """<a v="${xacro.load_yaml('bomb.yaml')}"/>""",
}


@pytest.mark.slow
@pytest.mark.parametrize("body", HOSTILE.values(), ids=HOSTILE)
def test_hostile_expressions_end_in_one_line(tmp_path, body):
    package = tmp_path / "package"
    package.mkdir()
    (package / "package.xml").write_text("<package><name>package</name></package>")
    (tmp_path / "outside.yaml").write_text("a: 1")
    (package / "link.yaml").symlink_to(tmp_path / "outside.yaml")
    lines = ["a0: &a0 [x]", *(f"a{k + 1}: &a{k + 1} [*a{k}, *a{k}]" for k in range(40))]
    (package / "bomb.yaml").write_text("\n".join(lines))
    file = package / "r.xacro"
    file.write_text(f'<robot xmlns:xacro="http://www.ros.org/wiki/xacro">{body}</robot>')
    with pytest.raises(DescriptionError) as caught:
        load_xacro(file)
    assert str(caught.value).startswith(str(file))
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 1000


def test_yaml_of_packages_and_of_arguments_is_read(tmp_path):
    for name, value in (("arm", 1), ("hand", 2)):
        (tmp_path / name / "config").mkdir(parents=True)
        (tmp_path / name / "urdf").mkdir()
        (tmp_path / name / "package.xml").write_text(f"<package><name>{name}</name></package>")
        (tmp_path / name / "config" / "a.yaml").write_text(
            f"base: &b {{x: {value}}}\nother: {{angle: !degrees 180, y: *b}}"
        )
    (tmp_path / "own.yaml").write_text("x: 3")
    file = tmp_path / "arm" / "urdf" / "r.xacro"
    file.write_text("""<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
      <xacro:arg name="own" default=""/>
      <xacro:property name="arm" value="${xacro.load_yaml('../config/a.yaml')}"/>
      <xacro:property name="hand" value="${xacro.load_yaml('$(find hand)/config/a.yaml')}"/>
      <xacro:property name="own" value="${xacro.load_yaml('$(arg own)')}"/>
      <a v="${arm.base.x} ${hand['base']['x']} ${own.x} ${arm.other.angle} ${hand.other.y.x} ${'x' in own.keys()}"/>
    </robot>""")
    text = load_xacro(file, {"own": str(tmp_path / "own.yaml")}, lambda name: tmp_path / name)
    assert f'v="1 2 3 {math.pi} 2 True"' in text


def test_sources_behind_a_symlinked_installation_are_read(tmp_path):
    source, share = tmp_path / "src" / "arm", tmp_path / "install" / "share" / "arm"
    source.mkdir(parents=True)
    share.mkdir(parents=True)
    (source / "a.yaml").write_text("x: 5")
    (source / "package.xml").write_text("<package><name>arm</name></package>")
    for name in ("a.yaml", "package.xml"):
        (share / name).symlink_to(source / name)
    file = tmp_path / "r.xacro"
    file.write_text(
        """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
        <a v="${xacro.load_yaml('$(find arm)/a.yaml').x}"/></robot>"""
    )
    assert 'v="5"' in load_xacro(file, {}, lambda name: share)
