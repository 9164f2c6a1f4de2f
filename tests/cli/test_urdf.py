"""`daidalos urdf` and the commands of urdfdom."""

import json

import pytest

from daidalos.cli.daidalos import main
from daidalos.nodes.urdfdom import check_urdf, urdf_to_graphviz

ROBOT = """<robot name="r">
  <link name="base"><inertial><mass value="2"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="9"/></inertial>
  </link>
  <link name="tip"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <joint name="j" type="revolute"><parent link="base"/><child link="tip"/>
    <limit lower="-1" upper="2" effort="3" velocity="4"/></joint>
</robot>
"""


@pytest.fixture
def robot(tmp_path):
    path = tmp_path / "r.urdf"
    path.write_text(ROBOT)
    return path


def test_it_tells_tree_masses_doubts_and_limits(robot, capsys):
    assert main(["urdf", str(robot)]) == 0
    said = capsys.readouterr().out
    assert "child(1):  tip" in said
    assert "mass: 2 kg in 2 links" in said
    assert "-1 .. 2 rad, 4 rad/s, 3 N m" in said
    assert "doubtful inertias:" in said


def test_it_speaks_json(robot, capsys):
    assert main(["urdf", str(robot), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["joints"][0]["type"] == "revolute"


def test_a_check_says_nothing_but_faults(robot, capsys):
    assert main(["urdf", str(robot), "--check"]) == 0
    said = capsys.readouterr()
    assert said.out == ""
    assert "'base'" in said.err  # its inertia is changed


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (ROBOT.replace('link="tip"', 'link="top"'), 'r.urdf:5: <joint name="j">'),
        (ROBOT.replace("0.1", "ten"), "r.urdf:4: <sphere>"),
        ("<robot", "r.urdf:1"),
    ],
)
def test_a_fault_is_one_line(tmp_path, capsys, text, words):
    path = tmp_path / "r.urdf"
    path.write_text(text)
    for check in ([], ["--check"]):
        assert main(["urdf", str(path), *check]) == 2
        said = capsys.readouterr().err
        assert words in said
        assert said.count("\n") == 1


def test_xacro_takes_arguments(tmp_path, capsys):
    path = tmp_path / "r.urdf.xacro"
    path.write_text(
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:arg name="n" default="a"/>'
        '<link name="$(arg n)"/></robot>'
    )
    assert main(["urdf", str(path), "n:=wheel"]) == 0
    assert "root Link: wheel" in capsys.readouterr().out
    assert main(["urdf", str(path), "wheel"]) == 2


def test_it_draws(robot, tmp_path, monkeypatch, capsys):
    assert main(["urdf", str(robot), "--svg", str(tmp_path / "a.svg")]) == 0
    assert "<svg" in (tmp_path / "a.svg").read_text()
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("sys.argv", ["urdf_to_graphviz", str(robot)])
    assert urdf_to_graphviz.main() == 0
    assert "tip" in (tmp_path / "r.svg").read_text()
    assert (tmp_path / "r.gv").read_text().startswith("digraph")


def test_check_urdf_prints_the_tree(robot, monkeypatch, capsys):
    monkeypatch.setattr("sys.argv", ["check_urdf", str(robot)])
    assert check_urdf.main() == 0
    assert capsys.readouterr().out.startswith("robot name is: r\n")
    monkeypatch.setattr("sys.argv", ["check_urdf", str(robot) + "x"])
    assert check_urdf.main() == 2
    assert "r.urdfx" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("geometry", "words"),
    [
        ('<mesh filename="none.stl"/></geometry>', "r.urdf:2: mesh none.stl not found"),
        ('<mesh filename="torn.stl"/></geometry>', "r.urdf:2: mesh torn.stl holds no triangles"),
        (
            '<box size="1 1 1"/></geometry><material name="m"><texture filename="none.png"/></material>',
            "r.urdf:1: image none.png not found",
        ),
    ],
)
def test_a_check_warns_of_missing_and_broken_files(tmp_path, capsys, monkeypatch, geometry, words):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "torn.stl").write_text("solid x\nfacet normal 0 0 1\nouter loop\nvertex a b c\n")
    text = f'<robot name="r"><link name="a">\n<visual><geometry>{geometry}</visual></link></robot>'
    (tmp_path / "r.urdf").write_text(text)
    assert main(["urdf", "r.urdf"]) == 0
    capsys.readouterr()
    assert main(["urdf", "r.urdf", "--check"]) == 0
    said = capsys.readouterr().err
    assert words in said
    assert said.startswith("warning: ")
    assert said.count("\n") == 1


MODEL = """<model name="m">
  <link name="a"/>
  <link name="b"><collision name="c"><geometry><sphere><radius>{radius}</radius></sphere></geometry></collision></link>
  <joint name="j" type="revolute"><parent>a</parent><child>b</child></joint>
</model>"""
WORLD = """<world name="yard"><light name="sun" type="directional"/>
<model name="floor"><static>true</static><link name="l"/></model>
{model}
</world>"""


def written(path, body):
    path.parent.mkdir(exist_ok=True)
    path.write_text(f"<?xml version='1.0'?>\n<!-- a comment first -->\n<sdf version='1.9'>{body}</sdf>")
    return str(path)


def test_it_looks_at_models_in_sdf(tmp_path, capsys):
    file = written(tmp_path / "m" / "m.sdf", MODEL.format(radius=1))
    (tmp_path / "m" / "model.config").write_text("<model><sdf>m.sdf</sdf></model>")
    for path in (file, str(tmp_path / "m"), written(tmp_path / "m.xml", MODEL.format(radius=1))):
        assert main(["urdf", path]) == 0
        said = capsys.readouterr().out
        assert said.startswith("model name is: m\n")
        assert "child(1):  b" in said
        assert "2 kg in 2 links, 1 joints" in said  # SDF's default
        assert main(["urdf", path, "--check", "--svg", str(tmp_path / "m.svg")]) == 0
        assert capsys.readouterr().out == ""
        assert "<svg" in (tmp_path / "m.svg").read_text()


def test_it_looks_at_worlds(tmp_path, capsys):
    path = written(tmp_path / "yard.world", WORLD.format(model=MODEL.format(radius=1)))
    assert main(["urdf", path]) == 0
    said = capsys.readouterr().out.splitlines()
    assert said[0] == "world name is: yard"
    assert "lights: sun" in said
    assert [line.split()[0] for line in said if line.endswith((" 0", " 1"))] == ["floor", "m"]
    assert main(["urdf", path, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["models"][0]["static"] is True
    assert main(["urdf", path, "--check"]) == 0
    assert main(["urdf", path, "--svg", str(tmp_path / "w.svg")]) == 2
    assert "draw one of its models" in capsys.readouterr().err


def test_xacro_may_make_sdf(tmp_path, capsys):
    body = "<xacro:arg name='r' default='2'/>" + MODEL.format(radius="$(arg r)")
    path = tmp_path / "m.sdf.xacro"
    path.write_text(f"<sdf version='1.9' xmlns:xacro='http://www.ros.org/wiki/xacro'>{body}</sdf>")
    assert main(["urdf", str(path)]) == 0
    assert "model name is: m" in capsys.readouterr().out
    assert main(["urdf", str(path), "r:=x"]) == 2
    assert "should be a number, got 'x'" in capsys.readouterr().err


def test_a_model_that_is_not_found_is_a_warning_as_in_the_simulator(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    address = "https://fuel.gazebosim.org/1.0/OpenRobotics/models/Nothing"
    written(tmp_path / "m.sdf", WORLD.format(model=f"<include><uri>{address}</uri></include>"))
    for check in ([], ["--check"]):
        assert main(["urdf", "m.sdf", *check]) == 0
        said = capsys.readouterr().err
        assert said.startswith(f"warning: m.sdf:5: <include>: {address} not found; ")
        assert said.count("\n") == 1


@pytest.mark.parametrize(
    ("body", "words"),
    [
        (MODEL.format(radius="ten"), "m.sdf:5: <radius>"),
        (WORLD.format(model=MODEL.format(radius=1).replace("<child>b", "<child>c")), "m.sdf:8: <child>"),
        ("<world", "m.sdf:3: not well-formed XML"),
    ],
)
def test_a_fault_in_sdf_is_one_line(tmp_path, capsys, monkeypatch, body, words):
    monkeypatch.chdir(tmp_path)
    written(tmp_path / "m.sdf", body)
    for check in ([], ["--check"]):
        assert main(["urdf", "m.sdf", *check]) == 2
        said = capsys.readouterr().err
        assert words in said
        assert said.count("\n") == 1
