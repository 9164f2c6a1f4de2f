"""`daidalos sim` without a graph."""

from daidalos.cli.daidalos import main

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
