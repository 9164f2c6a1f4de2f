"""`daidalos sim` without a graph."""

import os

from daidalos.cli.daidalos import main
from daidalos.cli.daidalos.overlays import leave_overlays

BOX = """<sdf version="1.9"><model name="crate"><pose>0 0 0.5 0 0 0</pose><link name="l"><collision name="c"><geometry>
<box><size>1 1 1</size></box></geometry></collision></link></model></sdf>"""


def test_it_simulates_and_says_how_fast(tmp_path, capsys):
    (tmp_path / "crate.sdf").write_text(BOX)
    assert main(["sim", "hexagon", "-m", str(tmp_path / "crate.sdf"), "--duration", "0.5"]) == 0
    said = capsys.readouterr().out
    assert "simulated 0.5 s" in said
    assert "crate: 0.000 0.000 0.500" in said


def test_an_unknown_world_is_answered_with_those_that_are_known(capsys):
    assert main(["sim", "moon"]) == 2
    assert "no world file 'moon'; known by name are arena, hexagon" in capsys.readouterr().err


def test_faulty_files_are_one_line(tmp_path, capsys):
    world = tmp_path / "w.world"
    world.write_text("<sdf version='1.6'>\n<world name='w'>\n<model/></world></sdf>")
    assert main(["sim", str(world), "--duration", "1"]) == 2
    assert "w.world:3: <model>" in capsys.readouterr().err
    (tmp_path / "r.urdf").write_text("<robot name='r'/>")
    assert main(["sim", "-m", str(tmp_path / "r.urdf"), "--headless"]) == 2
    assert "r.urdf" in capsys.readouterr().err


def test_a_sourced_package_does_not_replace_the_products_own(tmp_path, monkeypatch, capsys):
    for package in ("turtlebot3_gazebo", "gazebo_ros"):
        (tmp_path / "share" / package).mkdir(parents=True)
        (tmp_path / "share" / package / "package.xml").write_text(f"<package><name>{package}</name></package>")
        index = tmp_path / "share" / "ament_index" / "resource_index" / "packages"
        index.mkdir(parents=True, exist_ok=True)
        (index / package).touch()
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path))
    assert main(["sim", "arena", "--duration", "0.05"]) == 0
    assert "simulated 0.05 s" in capsys.readouterr().out


def test_the_demonstration_leaves_sourced_workspaces(tmp_path, monkeypatch):
    overlay = tmp_path / "install"
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(overlay))
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join([str(overlay / "lib" / "python"), str(tmp_path / "mine")]))
    leave_overlays()
    assert "AMENT_PREFIX_PATH" not in os.environ
    assert os.environ["PYTHONPATH"] == str(tmp_path / "mine")
