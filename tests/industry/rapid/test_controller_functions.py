"""Predefined routines about the controller, the arm, world zones, welding and interrupts of values."""

import math
from pathlib import Path

import numpy as np
import pytest

from daidalos.industry.rapid.runtime.arm_robot import ArmRobot
from daidalos.industry.rapid.runtime.movements import set_manual
from daidalos.industry.robots import arm_named

from .programs import module
from .running import board, load, run, written

AT = "[[{},{},{}],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]"
WELD = """PERS seamdata seam := [0.5,0.5,[0],0]; PERS welddata weld := [10,0,[5,0,0]];"""


def arm() -> ArmRobot:
    """Return an arm."""
    return ArmRobot(arm_named("irb120"))


def on_arm(lines: str, declarations: str = "", **more: object) -> list[str]:
    """Return what lines write that move an arm; they have to come to their end."""
    outcome, found = run(f"ConfL \\Off; ConfJ \\Off; {lines}", declarations, robot=arm(), **more)
    assert outcome.reason == "end", outcome.message
    return found


def test_joints_of_a_target_and_back() -> None:
    lines = """p := CalcRobT([[10,20,-30,40,50,60],[9E9,9E9,9E9,9E9,9E9,9E9]], tool0);
    j := CalcJointT(p, tool0); TPWrite "" \\Num:=Round(j.robax.rax_4 \\Dec:=6); TPWrite ValToStr(p.robconf);"""
    assert on_arm(lines, "VAR robtarget p; VAR jointtarget j;") == ["40", "[0,0,0,0]"]


def test_a_target_out_of_reach_has_a_number_or_is_an_error() -> None:
    lines = f"j := CalcJointT({AT.format(9000, 0, 0)}, tool0 \\ErrorNumber:=e);"
    assert on_arm(f'{lines} TPWrite "" \\Bool:=e = ERR_ROBLIMIT;', "VAR errnum e; VAR jointtarget j;") == ["TRUE"]
    outcome, _ = run(f"VAR jointtarget j; j := CalcJointT({AT.format(9000, 0, 0)}, tool0);", robot=arm())
    assert "ERR_ROBLIMIT: 50050" in outcome.message


@pytest.mark.parametrize(
    ("define", "inside"),
    [
        ("WZBoxDef \\Inside, s, [300,-20,0], [400,20,900];", 40.0),
        ("WZSphDef \\Inside, s, [350,0,300], 30;", 60.0),
        ("WZCylDef \\Inside, s, [350,0,200], 25, 200;", 50.0),
        ("WZBoxDef \\Outside, s, [300,-20,0], [400,20,900];", 160.0),
    ],
)
def test_world_zones_set_outputs_while_the_tool_is_inside(define: str, inside: float) -> None:
    lines = f"""MoveJ {AT.format(350, -100, 300)}, v1000, fine, tool0; {define}
    WZDOSet \\Stat, z \\Inside, s, doIn, 1; CONNECT i WITH seen; ISignalDO doIn, 2, i; ClkStart c;
    first := doIn = 1; MoveL {AT.format(350, 100, 300)}, v100, fine, tool0;
    TPWrite "" \\Num:=on; TPWrite "" \\Bool:=first;"""
    declarations = """VAR shapedata s; VAR wzstationary z; VAR intnum i; VAR clock c; VAR num on; VAR bool first;
    VAR num since; TRAP seen IF doIn = 1 since := ClkRead(c); IF doIn = 0 on := on + ClkRead(c) - since;
    ENDTRAP"""
    found = on_arm(lines, declarations)
    is_outside = "Outside" in define
    assert found[1] == ("TRUE" if is_outside else "FALSE")
    expected = 80.0 if is_outside else inside  # the second part, outside, does not end before the movement does
    assert 100.0 * float(found[0]) == pytest.approx(expected, abs=5.0 if is_outside else 2.1)


def test_a_forbidden_zone_stops_the_arm_at_its_border() -> None:
    lines = f"""MoveJ {AT.format(350, -100, 300)}, v1000, fine, tool0; WZBoxDef \\Inside, s, [300,0,0], [400,50,900];
    WZLimSup \\Stat, z, s; MoveL {AT.format(350, 100, 300)}, v100, fine, tool0;"""
    robot = arm()
    outcome, _ = run(f"ConfL \\Off; ConfJ \\Off; {lines}", "VAR shapedata s; VAR wzstationary z;", robot=robot)
    assert "test.mod" in outcome.message
    assert "world zone" in outcome.message
    assert (
        -1.0
        < robot.robtarget([True, [[0, 0, 0], [1, 0, 0, 0]]], [0, 0, 0, *[[[0, 0, 0], [1, 0, 0, 0]]] * 2])[0][1]
        < 10
    )


def test_home_zones_see_angles() -> None:
    lines = """WZHomeJointDef \\Inside, s, [[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]],
    [[2,2,2,2,2,2],[9E9,9E9,9E9,9E9,9E9,9E9]];
    WZDOSet \\Stat, z \\Inside, s, doHome, 1; TPWrite "" \\Num:=doHome;
    MoveAbsJ [[5,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]], v100, fine, tool0; TPWrite "" \\Num:=doHome;"""
    assert on_arm(lines, "VAR shapedata s; VAR wzstationary z;") == ["1", "0"]


def test_welds_move_at_their_own_speed() -> None:
    lines = """ArcLStart [[0,0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]], v1000, seam, weld, fine, tool0;
    ClkStart c; ArcLEnd [[100,0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]], v1000, seam, weld, fine, tool0;
    TPWrite "" \\Num:=ClkRead(c);"""
    assert written(lines, f"{WELD} VAR clock c;") == ["10"]
    outcome, _ = run("ArcL [[1,0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]], v10, seam, weld, z1, tool0;", WELD)
    assert "comes behind ArcLStart" in outcome.message


def test_the_path_is_kept_and_taken_up_again() -> None:
    trap = """TRAP away VAR robtarget p; StopMove; StorePath; p := CRobT(\\Tool:=tool0);
    MoveL Offs(p, 0, 0, 20), v200, fine, tool0; TPWrite "away at " \\Num:=Round(p.trans.y \\Dec:=1);
    MoveL p, v200, fine, tool0; RestoPath; StartMove; ENDTRAP"""
    lines = f"""MoveJ {AT.format(350, -100, 300)}, v1000, fine, tool0; CONNECT i WITH away; ITimer \\Single, 1, i;
    MoveL {AT.format(350, 100, 300)}, v100, fine, tool0; TPWrite "" \\Pos:=CPos(\\Tool:=tool0);"""
    away, end = on_arm(lines, f"VAR intnum i; {trap}")
    assert -10.0 < float(away.removeprefix("away at ")) < 10.0
    assert end == "[350,100,300]"


def test_a_path_that_was_left_is_not_taken_up_from_elsewhere() -> None:
    trap = f"TRAP away StopMove; StorePath; MoveL {AT.format(350, 0, 350)}, v200, fine, tool0; RestoPath; ENDTRAP"
    lines = f"""ConfL \\Off; ConfJ \\Off; MoveJ {AT.format(350, -100, 300)}, v1000, fine, tool0; CONNECT i WITH away;
    ITimer \\Single, 1, i; MoveL {AT.format(350, 100, 300)}, v100, fine, tool0;"""
    outcome, _ = run(lines, f"VAR intnum i; {trap}", robot=arm())
    assert "deg from where the path was left" in outcome.message


def test_a_circle_through_points() -> None:
    points = [[10 + 5 * math.cos(a), 20 + 5 * math.sin(a), 3.0] for a in (0.0, 1.0, 2.5, 4.0)]
    lines = f"""VAR pos p{{4}} := {points}; VAR pos c; VAR num r; VAR pos n; FitCircle p, c, r, n;
    TPWrite "" \\Num:=Round(r \\Dec:=6); TPWrite "" \\Num:=Round(c.x \\Dec:=6);
    TPWrite "" \\Num:=Abs(Round(n.z \\Dec:=6));"""
    assert written(lines) == ["5", "10", "1"]


def test_interrupts_of_persistents_and_analog_signals() -> None:
    declarations = """VAR intnum a; VAR intnum b; PERS num mode := 0;
    TRAP changed TPWrite "mode " \\Num:=mode; ENDTRAP
    TRAP high TPWrite "high " \\Num:=aiForce; ENDTRAP"""
    lines = """CONNECT a WITH changed; IPers mode, a; mode := 3; WaitTime 0.1; WaitTime 0.1; mode := 4; WaitTime 0.1;
    CONNECT b WITH high; ISignalAO aiForce, AIO_ABOVE_HIGH, 5, 0, 1, b;
    SetAO aiForce, 4; SetAO aiForce, 6; SetAO aiForce, 6.5; SetAO aiForce, 8;"""
    assert written(lines, declarations) == ["mode 3", "mode 4", "high 6", "high 8"]


def test_names_of_data_are_found() -> None:
    lines = """VAR datapos block; VAR string name; SetDataSearch "num" \\Object:="part.*" \\PersSym;
    WHILE GetNextSym(name, block) DO TPWrite name; ENDWHILE"""
    assert written(lines, "PERS num part1 := 1; PERS num part2 := 2; VAR num part3; PERS bool part4 := TRUE;") == [
        "part1",
        "part2",
    ]


def test_a_module_is_saved_below_the_folder(tmp_path: Path) -> None:
    lines = 'n := 5; Save "m" \\FilePath:="HOME:/saved.mod";'
    outcome, _ = run(lines, "PERS num n := 1;", home=tmp_path)
    assert outcome.reason == "end", outcome.message
    assert "PERS num n := 5" in (tmp_path / "saved.mod").read_text()


def test_retries_are_counted_and_reset() -> None:
    text = """PROC again() VAR num m; m := 1 / zero(); ERROR TPWrite "" \\Num:=RemainingRetries(); Incr tries;
    IF tries = 3 ResetRetryCount; IF tries = 6 TRYNEXT; RETRY; ENDPROC
    FUNC num zero() RETURN 0; ENDFUNC"""
    assert written("again;", f"VAR num tries; {text}") == ["4", "3", "2", "4", "3", "2"]


def test_units_of_signals_and_configuration() -> None:
    lines = """VAR string s; VAR num n; IODisable "d652", 1; TPWrite "" \\Num:=IOUnitState("D652"); IOEnable "d652", 1;
    TPWrite "" \\Num:=IOUnitState("d652"); WriteCfgData "/a/b", "c", 5; ReadCfgData "/A/b", "C", n; TPWrite "" \\Num:=n;
    TPWrite "" \\Bool:=ModExist("none"); ErrLog 4800, "a", "b", "c", "d", "e";"""
    assert written(lines) == ["3", "1", "5", "FALSE", "error 4800: a b c d e"]
    outcome, _ = run('VAR num n; ReadCfgData "/x", "y", n;')
    assert "ERR_CFG_NOTFND: '/x' has no 'y'" in outcome.message


def test_signals_know_their_origin() -> None:
    lines = """VAR string s; AliasIO doReal, doOwn; TPWrite "" \\Num:=GetSignalOrigin(doOwn, s); TPWrite s;
    AliasIOReset doOwn;"""
    outcome, found = run(lines, "VAR signaldo doOwn;", board=board(doReal=1.0))
    assert outcome.reason == "end", outcome.message
    assert found[0] == "2"


@pytest.mark.parametrize("instruction", ["MoveL {}, v1000, fine, tool0;", "MoveL {}, v100\\T:=0.2, fine, tool0;"])
def test_the_tool_is_no_faster_than_250_mm_per_s_in_manual_mode(instruction: str) -> None:
    lines = f"""ConfL \\Off; ConfJ \\Off; MoveJ {AT.format(350, -100, 300)}, v1000, fine, tool0;
    {instruction.format(AT.format(350, 100, 300))}"""
    robot = ArmRobot(arm_named("irb120"), sampling=0.002)
    task = load(module(lines), robot=robot)
    set_manual(task)
    assert task.run().reason == "end"
    positions = np.concatenate([one.positions for one in robot.samples])
    speeds = np.linalg.norm(np.diff(positions, axis=0), axis=1) / 0.002
    assert 0.24 < speeds.max() < 0.2501
