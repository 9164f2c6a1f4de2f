"""Programs that move an arm: positions at each instant, triggers, searches, stops and faults."""

from typing import Any

import numpy as np
import pytest

from daidalos.industry.motion.kinematics import forward
from daidalos.industry.rapid.runtime.arm_robot import ArmRobot
from daidalos.industry.rapid.runtime.board import Board
from daidalos.industry.rapid.runtime.sensors import parse_sensor
from daidalos.industry.rapid.runtime.task import Outcome
from daidalos.industry.robots import ARMS

from .running import run

DATA = """PERS tooldata tPen := [TRUE,[[0,0,120],[1,0,0,0]],[0.5,[0,0,60],[1,0,0,0],0,0,0]];
CONST robtarget pA := [[350,-100,200],[0,0,1,0],[-1,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
CONST robtarget pB := [[350,100,200],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
CONST robtarget pC := [[450,100,200],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
VAR triggdata edge; VAR triggdata timed; VAR intnum number; VAR robtarget here; VAR clock watch;
"""


def drive(lines: str, more: str = "", *sensors: str, sampling: float = 0.0) -> tuple[Outcome, list[str], ArmRobot]:
    """Run lines on an arm at pA."""
    signals = Board()
    conditions = dict(parse_sensor(one) for one in sensors)
    robot = ArmRobot(ARMS["irb120"], sensors=conditions, set_signal=signals.set, sampling=sampling)
    text = f"ConfL \\Off; MoveJ pA, v1000, fine, tPen; {lines}"
    outcome, written = run(text, DATA + more, board=signals, robot=robot)
    return outcome, written, robot


def written(lines: str, more: str = "", *sensors: str) -> list[str]:
    outcome, found, _ = drive(lines, more, *sensors)
    assert outcome.reason == "end", outcome.message
    return found


def tool_positions(robot: ArmRobot) -> Any:
    return np.concatenate([one.positions for one in robot.samples])


def test_position_is_true_at_each_instant() -> None:
    lines = """ITimer \\Single, 0.5, number; MoveL pB, v200, fine, tPen; TPWrite "end " \\Pos:=CPos(\\Tool:=tPen);"""
    trap = 'TRAP seen\nTPWrite "trap " \\Pos:=CPos(\\Tool:=tPen);\nENDTRAP\n'
    found = written("CONNECT number WITH seen;" + lines, trap)
    assert found[1] == "end [350,100,200]"
    y = float(found[0].split(",")[1])
    assert found[0].startswith("trap [350,")
    assert y == pytest.approx(-100.0 + 200.0 * 0.475, abs=2.0)


def test_instructions_behind_a_corner_path_run_where_it_begins() -> None:
    lines = """MoveL pB, v200, z20, tPen; here := CRobT(\\Tool:=tPen); SetDO doPen, 1; MoveL pC, v200, fine, tPen;
    TPWrite "" \\Num:=here.trans.y;"""
    assert 60.0 < float(written(lines)[0]) <= 80.0


def test_corner_path_keeps_the_speed() -> None:
    timed = 'ClkStart watch; MoveL pB, v200, {}, tPen; MoveL pC, v200, fine, tPen; TPWrite ""\\Num:=ClkRead(watch);'
    through, stopping = (float(written(timed.format(zone))[0]) for zone in ("z20", "fine"))
    assert through < stopping - 0.05
    assert 1.4 < through < 1.6


def test_zone_of_a_closed_loop_without_logic_is_planned_in_windows() -> None:
    lines = "FOR i FROM 1 TO 25 DO MoveL pB, v200, z5, tPen; MoveL pA, v200, z5, tPen; ENDFOR"
    outcome, _, robot = drive(lines)
    assert outcome.reason == "end", outcome.message
    assert robot.count == 51
    assert not robot.planner.warnings
    assert outcome.time > 50.0


def test_triggers() -> None:
    lines = """TriggIO edge, 50 \\DOp:=doPen, 1; TriggIO timed, 0.1 \\Time \\DOp:=doEnd, 1;
    CONNECT number WITH seen; ISignalDO doPen, 1, number; CONNECT other WITH ended; ISignalDO doEnd, 1, other;
    ClkStart watch; TriggL pB, v200, edge \\T2:=timed, fine, tPen; TPWrite "time " \\Num:=ClkRead(watch);"""
    traps = """VAR intnum other;
    TRAP seen\nTPWrite "at " \\Pos:=CPos(\\Tool:=tPen);\nENDTRAP
    TRAP ended\nTPWrite "end " \\Num:=ClkRead(watch);\nENDTRAP\n"""
    at, end, time = written(lines, traps)
    assert at == "at [350,50,200]"
    assert float(time.split()[1]) - float(end.split()[1]) == pytest.approx(0.1, abs=2e-3)


@pytest.mark.parametrize(("stop", "arrival"), [("\\Stop,", "at"), ("", "through")])
def test_search(stop: str, arrival: str) -> None:
    lines = f"""SearchL {stop} diTouch, here, pB, v50, tPen; TPWrite "found " \\Num:=here.trans.y;
    TPWrite "stands " \\Num:=CPos(\\Tool:=tPen) .y;"""
    lines = lines.replace("CPos(\\Tool:=tPen) .y", "tip()")
    tip = "FUNC num tip()\nVAR pos p;\np := CPos(\\Tool:=tPen);\nRETURN p.y;\nENDFUNC\n"
    found, stands = (float(one.split()[1]) for one in written(lines, tip, "diTouch=y>20"))
    assert found == pytest.approx(20.0, abs=0.06)
    assert (found < stands < 25.0) if arrival == "at" else stands == pytest.approx(100.0)


def test_search_without_a_touch_can_be_handled() -> None:
    more = """PROC seek()\nSearchL \\Stop, diTouch, here, pB, v100, tPen;\nERROR
    IF ERRNO = ERR_WHLSEARCH THEN\nTPWrite "none";\nTRYNEXT;\nENDIF\nENDPROC\n"""
    assert written("seek;", more, "diTouch=y>500") == ["none"]


def test_stop_and_start_on_the_path() -> None:
    lines = """CONNECT number WITH pause; ITimer \\Single, 0.5, number; ClkStart watch; MoveL pB, v200, fine, tPen;
    TPWrite "" \\Num:=ClkRead(watch);"""
    trap = "TRAP pause\nStopMove;\nWaitTime 2;\nStartMove;\nENDTRAP\n"
    assert 3.0 < float(written(lines, trap)[0]) < 3.4


def test_velset_and_accset_slow_down() -> None:
    lines = 'ClkStart watch; MoveL pB, v200, fine, tPen; TPWrite ""\\Num:=ClkRead(watch);'
    plain, slow, soft = (float(written(one + lines)[0]) for one in ("", "VelSet 50, 5000;", "AccSet 20, 20;"))
    assert slow == pytest.approx(2.0 * plain, rel=0.05)
    assert plain < soft < slow


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        ("MoveL Offs(pB,600,0,0), v100, fine, tPen;", "50050 Position outside reach"),
        ("ConfL \\On; MoveL [pB.trans,pB.rot,[1,0,0,0],pB.extax], v100, fine, tPen;", "50080 Position not compatible"),
        ("MoveJ [pB.trans,pB.rot,[2,0,0,0],pB.extax], v100, fine, tPen;", "50080 Position not compatible"),
        ("MoveAbsJ [[0,0,90,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]], v100, fine, tPen;", "50027 Joint out of range: axis 3"),
        (
            "MoveAbsJ [[0,0,0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]], v100, fine, tool0; MoveL pB, v100, fine, tool0;",
            "50026",
        ),
        ("MoveC pA, pB, v100, fine, tPen;", "50063 Circle uncertain"),
        ("StopMove; MoveL pB, v100, fine, tPen;", "nothing is left that could start it"),
    ],
)
def test_faults_name_the_line(lines: str, message: str) -> None:
    outcome, _, robot = drive(lines)
    assert outcome.reason == "error"
    assert outcome.message.startswith("test.mod:")
    assert message in outcome.message
    assert robot.planner.braking() == 0.0


def test_a_range_that_is_almost_left_is_a_warning() -> None:
    outcome, _, robot = drive("MoveAbsJ [[0,0,69.4,0,30,0],pA.extax], v1000, fine, tPen;")
    assert outcome.reason == "end", outcome.message
    (warning,) = robot.planner.warnings
    assert warning.startswith("test.mod:")
    assert warning.endswith("axis 3 comes within 0.6 deg of its range's end")


def test_same_program_gives_the_same_bits() -> None:
    lines = "MoveL pB, v500, z10, tPen; MoveC Offs(pB,50,50,0), pC, v500, z5, tPen; MoveJ pA, v1000, fine, tPen;"
    first, second = (drive(lines, sampling=0.004)[2] for _ in range(2))
    joints = [np.concatenate([one.joints for one in robot.samples]).tobytes() for robot in (first, second)]
    assert joints[0] == joints[1]
    positions = tool_positions(first)
    assert np.linalg.norm(np.diff(positions, axis=0), axis=1).max() < 1.02 * 0.004
    last = first.samples[-1].joints[-1]
    assert (forward(ARMS["irb120"], last)[:3, 3] * 1e3)[1] == pytest.approx(-100.0, abs=0.02)
