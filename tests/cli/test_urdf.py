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
