"""Seams along the edges of STEP models: straight, curved and around corners, and files that are none."""

import sys

import numpy as np
import pytest

from daidalos.cli.daidalos import main
from daidalos.common.errors import UserError
from daidalos.industry.welding.reading import read_seam


@pytest.fixture(scope="module")
def models(tmp_path_factory):
    """A box of 200 x 100 x 30 mm and a cylinder of radius 50 mm and height 20 mm, as STEP."""
    pytest.importorskip("OCP", reason="cadquery-ocp-novtk is not installed; the extra cad brings it")
    from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakeCylinder
    from OCP.STEPControl import STEPControl_AsIs, STEPControl_Writer

    folder = tmp_path_factory.mktemp("step")
    for name, maker in (("box", BRepPrimAPI_MakeBox(200, 100, 30)), ("cylinder", BRepPrimAPI_MakeCylinder(50, 20))):
        writer = STEPControl_Writer()
        writer.Transfer(maker.Shape(), STEPControl_AsIs)
        writer.Write(str(folder / f"{name}.step"))
    return folder


def test_seam_around_a_corner(models):
    seam = read_seam(models / "box.step", [(0, 0, 30), (200, 0, 30), (200, 100, 30)])
    np.testing.assert_allclose(seam.positions[[0, 200, -1]], [[0, 0, 0.03], [0.2, 0, 0.03], [0.2, 0.1, 0.03]])
    assert seam.distances[-1] == pytest.approx(0.3)
    np.testing.assert_allclose(seam.normals, np.tile([0.0, 0.0, 1.0], (len(seam.positions), 1)), atol=1e-12)


def test_seam_along_a_circle_follows_it(models):
    seam = read_seam(models / "cylinder.step", [(50, 0, 20), (0, 50, 20)])
    np.testing.assert_allclose(np.hypot(*seam.positions[:, :2].T), 0.05, atol=1e-6)
    assert seam.distances[-1] == pytest.approx(0.05 * np.pi / 2.0, abs=6e-4)
    np.testing.assert_allclose(seam.normals[:, 2], 1.0)
    # The cylinder's seam line is no edge: its faces meet without an angle.
    with pytest.raises(UserError, match="no sharp edges connect"):
        read_seam(models / "cylinder.step", [(50, 0, 0), (50, 0, 20)])


def test_picks_are_proposed(models):
    with pytest.raises(UserError, match=r"Its longest sharp edge is --pick 0,0,0 --pick 200,0,0"):
        read_seam(models / "box.step")


def test_weld_is_planned_from_a_model(models, tmp_path, capfd):
    command = ["weld", "plan", str(models / "box.step"), "--pick", "0,0,30", "--pick", "200,0,30"]
    place = ["--place", "2200", "-100", "900", "--process", "fsw", "-o", str(tmp_path / "out"), "--json"]
    assert main([*command, *place]) == 0
    printed = capfd.readouterr().out
    assert printed.startswith("{")
    assert (tmp_path / "out" / "weld_box.src").is_file()


@pytest.mark.parametrize("content", ["", "hello", "ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\n#1=BROKEN("])
def test_files_that_are_none_are_refused(models, content, tmp_path, capfd):
    path = tmp_path / "broken.stp"
    path.write_text(content)
    with pytest.raises(UserError, match=r"broken.stp: is no STEP file with a shape"):
        read_seam(path, [(0, 0, 0), (1, 0, 0)])
    assert capfd.readouterr().out == ""


def test_missing_extra_is_named(tmp_path, monkeypatch):
    for name in ("OCP", "OCP.IFSelect", "OCP.Message", "OCP.STEPControl"):
        monkeypatch.setitem(sys.modules, name, None)
    (tmp_path / "box.step").write_text("")
    with pytest.raises(
        UserError, match=r"box.step: STEP files need cadquery-ocp-novtk; run: pip install 'daidalos\[cad\]'"
    ):
        read_seam(tmp_path / "box.step", [(0, 0, 0), (1, 0, 0)])
