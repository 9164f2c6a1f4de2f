"""Tasks that run at the same time: meeting, moving together, shared data and signals, and what ends them."""

import numpy as np
import pytest

from daidalos.industry.rapid.checking import Checker
from daidalos.industry.rapid.parsing import parse
from daidalos.industry.rapid.runtime.arm_robot import ArmRobot
from daidalos.industry.rapid.runtime.board import Board
from daidalos.industry.rapid.runtime.cell import STOPPED, Cell
from daidalos.industry.rapid.runtime.errors import FatalError
from daidalos.industry.rapid.runtime.pendant import TextPendant
from daidalos.industry.rapid.runtime.task import Outcome, Task
from daidalos.industry.rapid.sources import Source
from daidalos.industry.robots import arm_named

BOTH = 'PERS tasks both{2} := [["T_ROB1"],["T_ROB2"]];'
IDENTS = "VAR syncident s1; VAR syncident s2; VAR syncident s3;"
AT = "[[350,{},300],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]"


def task_of(lines: str, declarations: str, board: Board, arm: bool, lines_out: list[str]) -> Task:
    """Return the task of a module with these lines in main."""
    text = f"MODULE one\n{BOTH}\n{IDENTS}\n{declarations}\nPROC main()\n{lines}\nENDPROC\nENDMODULE\n"
    parsed = parse(Source("test.mod", text))
    checker = Checker([parsed])
    assert [one for one in checker.check()["test.mod"] if not one.runs] == []
    robot = ArmRobot(arm_named("irb120"), sampling=0.01) if arm else None
    return Task([parsed], checker, robot, board, TextPendant(lambda _: "", lines_out.append))


def cell_of(*programs: tuple[str, str], arm: bool = False) -> tuple[Cell, list[str]]:
    """Return a cell of tasks T_ROB1, T_ROB2 ... with lines and declarations, and what they write."""
    board, written = Board(), []
    tasks = {f"T_ROB{i}": task_of(*one, board, arm, written) for i, one in enumerate(programs, 1)}
    return Cell(tasks), written


def run(*programs: tuple[str, str], arm: bool = False) -> tuple[dict[str, Outcome], list[str]]:
    """Run tasks to their end."""
    cell, written = cell_of(*programs, arm=arm)
    return cell.run(), written


def test_the_first_waits_for_the_last() -> None:
    outcomes, _ = run(("WaitTime 1; WaitSyncTask s1, both;", ""), ("WaitTime 3.25; WaitSyncTask s1, both;", ""))
    assert [(one.reason, one.time) for one in outcomes.values()] == [("end", 3.25), ("end", 3.25)]


def test_points_are_met_by_name_again_and_again() -> None:
    lines = "FOR i FROM 1 TO 3 DO WaitTime {}; WaitSyncTask s1, both; TPWrite GetTaskName() \\Num:=i; ENDFOR"
    outcomes, written = run((lines.format(0.1), ""), (lines.format(0.7), ""))
    assert [one.time for one in outcomes.values()] == pytest.approx([2.1, 2.1])
    assert sorted(written[:2]) == ["T_ROB11", "T_ROB21"]
    assert sorted(written[4:]) == ["T_ROB13", "T_ROB23"]


def test_persistents_of_one_name_are_one() -> None:
    shared = "PERS num n := 1; PERS pos p := [1,2,3]; TASK PERS num own := {};"
    first = ('n := n + 1; p.x := 9; WaitSyncTask s1, both; TPWrite "" \\Num:=own;', shared.format(5))
    second = (
        'WaitSyncTask s1, both; TPWrite "" \\Num:=n; TPWrite "" \\Pos:=p; TPWrite "" \\Num:=own;',
        shared.format(6),
    )
    _, written = run(first, second)
    assert sorted(written) == ["2", "5", "6", "[9,2,3]"]


def test_persistents_of_different_types_are_refused() -> None:
    with pytest.raises(FatalError, match="'n' is num in T_ROB1, and bool in T_ROB2"):
        cell_of(("", "PERS num n := 1;"), ("", "PERS bool n := TRUE;"))


def test_a_condition_is_seen_when_another_task_makes_it_true() -> None:
    lines = 'WaitTime 1.5; flag := TRUE; WaitUntil answer; TPWrite "answered";'
    data = "PERS bool flag := FALSE; PERS bool answer := FALSE;"
    outcomes, written = run((lines, data), ("WaitUntil flag; answer := TRUE;", data))
    assert [one.reason for one in outcomes.values()] == ["end", "end"], outcomes
    assert written == ["answered"]


def test_a_signal_reaches_waits_and_traps_of_another_task_at_once() -> None:
    declarations = 'VAR intnum i; VAR clock c; TRAP seen TPWrite "trap " \\Num:=ClkRead(c); ENDTRAP'
    waits = 'ClkStart c; WaitDI diGo, 1; TPWrite "wait " \\Num:=ClkRead(c);'
    traps = f"CONNECT i WITH seen; ISignalDI diGo, 1, i; ClkStart c; WaitTime 10; {waits}"
    _, written = run(("WaitTime 1.23456; SetDO diGo, 1;", ""), (traps, declarations), (waits, "VAR clock c;"))
    assert written[:2] == ["trap 1.23456", "wait 1.23456"]


@pytest.mark.parametrize("arm", [False, True])
def test_movements_begin_and_end_together(arm: bool) -> None:
    moves = """ConfL \\Off; ConfJ \\Off; MoveJ {0}, v1000, fine, tool0; SyncMoveOn s2, both; ClkStart c;
    MoveL {1}\\ID:=10, {3}, z20, tool0; TPWrite "" \\Num:=Round(ClkRead(c) \\Dec:=3);
    MoveL {2}\\ID:=20, v100, fine, tool0; TPWrite "" \\Num:=Round(ClkRead(c) \\Dec:=3);
    SyncMoveOff s3; TPWrite "" \\Bool:=IsSyncMoveOn();"""
    far = moves.format(AT.format(-100), AT.format(100), AT.format(0), "v100")
    near = moves.format(AT.format(50), AT.format(60), AT.format(55), "v1000")
    outcomes, written = run((far, "VAR clock c;"), (near, "VAR clock c;"), arm=arm)
    assert [one.reason for one in outcomes.values()] == ["end", "end"], outcomes
    times = [float(one) for one in written if one != "FALSE"]
    assert times[0] == times[1] >= 2.0
    assert times[2] == times[3] >= times[0] + 1.0
    assert written[4:] == ["FALSE", "FALSE"]


def test_the_faster_arm_is_slowed_all_the_way() -> None:
    cell, _ = cell_of(
        (f"ConfL \\Off; ConfJ \\Off; MoveJ {AT.format(-100)}, v1000, fine, tool0; SyncMoveOn s2, both;"
         f"MoveL {AT.format(100)}\\ID:=1, v100, fine, tool0; SyncMoveOff s3;", ""),
        (f"ConfL \\Off; ConfJ \\Off; MoveJ {AT.format(50)}, v1000, fine, tool0; SyncMoveOn s2, both;"
         f"MoveL {AT.format(70)}\\ID:=1, v1000, fine, tool0; SyncMoveOff s3;", ""),
        arm=True,
    )  # fmt: skip
    cell.run()
    ways = []
    for task in cell.tasks.values():
        assert isinstance(task.robot, ArmRobot)
        y = np.concatenate([one.positions[:, 1] for one in task.robot.samples])
        ways.append((y[-200:] - y[-200]) / (y[-1] - y[-200]))
    assert np.abs(ways[0] - ways[1]).max() < 1e-3


def test_runs_repeat_bit_for_bit() -> None:
    lines = f"""ConfL \\Off; ConfJ \\Off; FOR i FROM 1 TO 3 DO MoveJ {AT.format(-50)}, v500, z10, tool0;
    MoveL {AT.format(50)}, v200, z10, tool0; WaitSyncTask s1, both; ENDFOR"""
    found = []
    for _ in range(2):
        cell, _ = cell_of((lines, ""), (f"WaitTime 0.1; {lines}", ""), arm=True)
        cell.run()
        found.append([one.joints.tobytes() for task in cell.tasks.values() for one in task.robot.samples])
    assert found[0] == found[1]


@pytest.mark.parametrize(
    ("first", "second", "message"),
    [
        ("WaitSyncTask s1, both;", "WaitTime 1;", "test.mod:6: waits for all of T_ROB1, T_ROB2 to be at s1 for ever"),
        ("WaitSyncTask s1, both;", "WaitSyncTask s2, both;", "for ever: nothing else is left"),
        ("WaitSyncTask s1, both \\TimeOut:=2;", "WaitTime 5;", "ERR_WAITSYNCTASK: waited 2 s"),
        ("WaitTime 1; n := 1 / n;", "WHILE TRUE DO WaitTime 1; ENDWHILE", "test.mod:6: ERR_DIVZERO"),
        (
            f"SyncMoveOn s1, both; MoveL {AT.format(1)}\\ID:=1, v10, fine, tool0;",
            f"SyncMoveOn s1, both; MoveL {AT.format(1)}\\ID:=2, v10, fine, tool0;",
            "tasks that move together need the same movements",
        ),
        (f"SyncMoveOn s1, both; MoveL {AT.format(1)}, v10, fine, tool0;", "SyncMoveOn s1, both;", "needs \\ID"),
        ("SyncMoveOff s1;", "", "ERR_SYNCMOVEOFF"),
        ('VAR tasks three{1} := [["T_ROB3"]]; WaitSyncTask s1, all;', "", "there is no task 'T_ROB3'"),
    ],
)  # fmt: skip
def test_what_ends_all_tasks(first: str, second: str, message: str) -> None:
    data = 'PERS num n := 0; PERS tasks all{2} := [["T_ROB1"],["T_ROB3"]];'
    outcomes, _ = run((first.replace('VAR tasks three{1} := [["T_ROB3"]]; ', ""), data), (second, ""))
    errors = [one for one in outcomes.values() if one.reason == "error"]
    assert len(errors) == 1, outcomes
    assert message in errors[0].message
    assert all(one.reason in ("error", STOPPED, "end") for one in outcomes.values())


def test_one_task_alone_says_whom_it_waits_for() -> None:
    task = task_of("WaitSyncTask s1, both;", "", Board(), False, [])
    assert "waits for T_ROB2, and this task runs alone" in task.run().message


def test_an_error_handler_recovers_from_a_timeout() -> None:
    lines = 'WaitSyncTask s1, both \\TimeOut:=1; TPWrite "on"; ERROR IF ERRNO = ERR_WAITSYNCTASK TRYNEXT;'
    outcomes, written = run((lines, ""), ("WaitTime 5;", ""))
    assert written == ["on"], outcomes
