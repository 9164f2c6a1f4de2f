"""Seams from files: every kind, and what is wrong with them."""

import contextlib

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from daidalos.common.errors import UserError
from daidalos.industry.welding.planning import Request, plan
from daidalos.industry.welding.reading import read_seam
from daidalos.industry.welding.results import write_plan

from .cells import SPEED, WRENCH, cell, line

CIRCLE = """DEF weld()
$BASE={X 1000,Y 0,Z 500,A 90,B 0,C 0}
PTP {X 0,Y 0,Z 0,A 0,B 0,C 180}
CIRC P1, {X 200,Y 0,Z 0} ; half a circle
SLIN XP2
PTP {A1 0,A2 -90,A3 90,A4 0,A5 0,A6 0}
END
"""
CIRCLE_DATA = """DEFDAT weld
DECL E6POS P1={X 100.0,Y 100.0,Z 0.0,A 0.0,B 0.0,C 180.0,S 2,T 10}
DECL E6POS XP2={X 300.0,Y 0.0,Z 0.0,A 0.0,B 0.0,C 180.0,S 2,T 10}
ENDDAT
"""
MODULE = """MODULE weld
  PERS tooldata t := [TRUE,[[0,0,100],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];
  CONST robtarget p := [[1000,0,500],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    MoveJ p, v100, fine, t;
    FOR i FROM 1 TO 4 DO
      MoveL Offs(p, 0, 100 * i, 0), v5, z1, t;
    ENDFOR
    MoveC Offs(p, 100, 500, 0), Offs(p, 200, 400, 0), v5, z1, t;
    MoveAbsJ [[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]], v100, fine, t;
  ENDPROC
ENDMODULE
"""
ROS = """header: {frame_id: base_link}
poses:
- pose: {position: {x: 1.0, y: 0.0, z: 0.5}, orientation: {x: 1.0, y: 0.0, z: 0.0, w: 0.0}}
- pose: {position: {x: 1.0, y: 0.5, z: 0.5}, orientation: {x: 1.0, y: 0.0, z: 0.0, w: 0.0}}
---
"""


def test_krl(tmp_path):
    (tmp_path / "weld.src").write_text(CIRCLE)
    (tmp_path / "weld.dat").write_text(CIRCLE_DATA)
    seam = read_seam(tmp_path / "weld.src")
    assert seam.distances[-1] == pytest.approx(0.1 * np.pi + 0.1, rel=1e-3)
    np.testing.assert_allclose(seam.positions[0], [1.0, 0.0, 0.5], atol=1e-12)
    np.testing.assert_allclose(seam.positions[-1], [1.0, 0.3, 0.5], atol=1e-12)
    middle = seam.positions[len(seam.positions) // 2 - 1]
    np.testing.assert_allclose(np.hypot(middle[0] - 1.0, middle[1] - 0.1), 0.1, atol=1e-9)
    np.testing.assert_allclose(seam.rotations[:, :, 2], np.tile([0, 0, -1], (len(seam.positions), 1)), atol=1e-12)


def test_rapid_is_run(tmp_path):
    (tmp_path / "weld.mod").write_text(MODULE)
    seam = read_seam(tmp_path / "weld.mod")
    np.testing.assert_allclose(seam.positions[:5, 1], [0, 0.1, 0.2, 0.3, 0.4], atol=1e-9)
    assert seam.distances[-1] == pytest.approx(0.4 + 0.1 * np.pi, rel=1e-3)


def test_a_ros_path(tmp_path):
    (tmp_path / "path.yaml").write_text(ROS)
    seam = read_seam(tmp_path / "path.yaml")
    np.testing.assert_allclose(seam.positions, [[1, 0, 0.5], [1, 0.5, 0.5]])


def test_an_edge_of_a_mesh(tmp_path):
    trimesh.creation.cylinder(0.2, 0.1, sections=64).export(tmp_path / "disc.stl")
    picks = [(0.2, 0.0, 0.05), (0.0, 0.2, 0.05), (-0.2, 0.0, 0.05)]
    seam = read_seam(tmp_path / "disc.stl", picks, 1.0)
    np.testing.assert_allclose(np.hypot(*seam.positions[:, :2].T), 0.2, atol=1e-6)
    assert seam.distances[-1] == pytest.approx(0.2 * np.pi, rel=1e-3)
    np.testing.assert_allclose(seam.normals, np.tile([0, 0, 1], (len(seam.positions), 1)), atol=1e-6)


def test_csv_with_everything(tmp_path):
    (tmp_path / "a.csv").write_text(
        "x_mm,y_mm,z_mm,nx,ny,nz,fx,fy,fz,mx,my,mz,zone\n0,0,0,0,0,1,1,2,3,4,5,6,a\n9,0,0,0,0,1,1,2,3,4,5,6,b\n"
    )
    seam = read_seam(tmp_path / "a.csv")
    np.testing.assert_allclose(seam.positions, [[0, 0, 0], [0.009, 0, 0]])
    np.testing.assert_allclose(seam.wrenches[1], [1, 2, 3, 4, 5, 6])
    assert seam.zones == ("a", "b")


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("a.csv", "", "is empty"),
        ("a.csv", "x,y,z\n", "has 0 points"),
        ("a.csv", "x,y,z\n1,2,3\n", "has 1 points"),
        ("a.csv", "x,y,zz\n1,2,3\n", r"a.csv:1: column 3: there is no column 'zz'"),
        ("a.csv", "x,y\n1,2\n", "of the positions, but not z"),
        ("a.csv", "x,y,z\n1,2,3\n1,2\n", r"a.csv:3: has 2 values, but 3"),
        ("a.csv", "x,y,z\n1,2,3\n1,nan,2\n", r"a.csv:3: column 2: 'nan' is no finite number"),
        ("a.csv", "x,y,z\n1,2,3\n1,2,3\n", "points 1 and 2 are at the same place"),
        ("a.csv", "x,y,z,nx,ny,nz\n1,2,3,0,0,2\n", r"a.csv:2: the normal has the length 2"),
        ("a.csv", "x,y,z,fx\n1,2,3,0\n", "of the wrenches, but not fy"),
        ("a.stl", "solid nothing\nendsolid", "is no mesh|has no faces"),
        ("a.src", "DEF a()\nLIN P7\nEND", r"a.src:2: position 'P7' is not declared here or in a.dat"),
        ("a.src", "DEF a()\nLIN {X 1}\nEND", r"a.src:2: the path begins here"),
        ("a.src", "DEF a()\nEND", "has 0 points"),
        ("a.mod", "MODULE a\n PROC main()\n MoveL p;\n ENDPROC\nENDMODULE", r"a.mod:3"),
        ("a.mod", "MODULE a\n PROC main()\n ENDPROC\nENDMODULE", "has 0 points"),
        ("a.yaml", "poses: 1", "has no list 'poses'"),
        ("a.yaml", "poses: [{pose: {position: {x: 1}}}]", r"poses\[0\].pose.position must have finite x, y, z"),
        ("a.iges", "", "is of no known kind"),
    ],
)
def test_what_is_wrong_is_one_line(name, text, message, tmp_path):
    (tmp_path / name).write_text(text)
    with pytest.raises(UserError, match=message) as caught:
        read_seam(tmp_path / name)
    assert "\n" not in str(caught.value)


def test_an_endless_program_ends(tmp_path, monkeypatch):
    monkeypatch.setattr("daidalos.industry.welding.rapid_paths.PATIENCE_S", 0.3)
    (tmp_path / "a.mod").write_text(
        "MODULE a\n PROC main()\n VAR num i;\n WHILE TRUE DO\n i := i + 1;\n ENDWHILE\n ENDPROC\nENDMODULE"
    )
    with pytest.raises(UserError, match="interrupted"):
        read_seam(tmp_path / "a.mod")


def test_a_mesh_says_where_its_seam_could_run(tmp_path):
    trimesh.creation.box((1, 2, 3)).export(tmp_path / "box.stl")
    with pytest.raises(UserError, match=r"--pick -0.5,-1,-?1.5 --pick|--pick .* --pick"):
        read_seam(tmp_path / "box.stl")


@pytest.mark.parametrize("suffix", ["src", "mod"])
def test_the_written_programs_are_the_corrected_path(suffix, tmp_path):
    planned = plan(cell(), line(), Request(SPEED, WRENCH))
    files = write_plan(planned, tmp_path / "out", "line", 120.0)
    found = read_seam(next(file for file in files if file.suffix == f".{suffix}"))
    np.testing.assert_allclose(found.positions, planned.correction.programmed[:, :3, 3], atol=1e-7)
    np.testing.assert_allclose(found.rotations, planned.correction.programmed[:, :3, :3], atol=1e-5)
    with pytest.raises(UserError, match="is there already"):
        write_plan(planned, tmp_path / "out", "line", 120.0)


@given(st.text(max_size=200))
@settings(max_examples=150, deadline=None)
def test_any_text_is_read_or_refused(tmp_path_factory, text):
    folder = tmp_path_factory.mktemp("any")
    for name in ("a.csv", "a.src"):
        (folder / name).write_bytes(text.encode("utf-8", "surrogatepass"))
        with contextlib.suppress(UserError):
            assert len(read_seam(folder / name).positions) >= 2


@given(
    st.lists(
        st.sampled_from(
            ["LIN ", "CIRC ", "PTP ", "{X 1,Y 2,Z 3,A 4,B 5,C 6}", "{X 9}", ", ", "P1", "\n", "$BASE=", "{A1 0}"]
        ),
        max_size=30,
    )
)
@settings(max_examples=200, deadline=None)
def test_any_program_in_krl_is_read_or_refused(tmp_path_factory, parts):
    file = tmp_path_factory.mktemp("any") / "a.src"
    file.write_text("".join(parts))
    with contextlib.suppress(UserError):
        assert np.isfinite(read_seam(file).positions).all()
