"""Paths in programs in RAPID, the language of ABB's robots: reader and writer.

A program is run, without a robot and in no time, so that its calls, loops and offsets count.
"""

from __future__ import annotations

import _thread
import threading
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daidalos.common.errors import UserError
from daidalos.industry.welding.path_runs import PathRuns, arc

TIME_LIMIT = 36_000.0
"""Robot time that a program may take [s]."""
PATIENCE_S = 20.0
"""Seconds of the computer's time after which a program counts as endless."""


def read_rapid(path: Path, procedure: str = "main") -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the positions (n, 3) [m] and orientations (n, 3, 3) of the tool in the base on the longest path.

    A path begins after MoveJ, at its target, or after MoveAbsJ; points on circles are computed every 3 degrees.

    Raises
    ------
    UserError
        Where the program has errors, or does not end.
    """
    from daidalos.industry.rapid.runtime.errors import FatalError
    from daidalos.industry.rapid.runtime.loading import choose_programs, load_modules
    from daidalos.industry.rapid.runtime.pendant import TextPendant
    from daidalos.industry.rapid.runtime.robot import SimpleRobot
    from daidalos.industry.rapid.runtime.task import Task

    modules, checker, blocking = load_modules(next(iter(choose_programs(path).values())))
    if blocking:
        raise UserError(blocking[0].errors[0].text(blocking[0].file))
    robot = SimpleRobot()
    watch = threading.Timer(PATIENCE_S, _thread.interrupt_main)
    watch.daemon = True
    with TemporaryDirectory() as home:
        try:
            pendant = TextPendant(_no_answer, lambda text: None)
            task = Task(modules, checker, robot, pendant=pendant, home=Path(home), limit=TIME_LIMIT)
            watch.start()
            outcome = task.run(procedure)
        except FatalError as error:
            raise UserError(f"{path}: {error}") from None
        finally:
            watch.cancel()
    if outcome.reason in ("error", "interrupted"):
        raise UserError(outcome.message if outcome.message.startswith(str(path)) else f"{path}: {outcome.message}")
    return _path_of(robot.moves)


def write_rapid(
    name: str,
    tool: NDArray[np.float64],
    tool_mass: float,
    poses: NDArray[np.float64],
    configurations: NDArray[np.int64],
    start: NDArray[np.float64],
    speeds: NDArray[np.float64],
) -> str:
    """Return a module whose main procedure moves to the first pose by the axes and then along lines.

    Parameters
    ----------
    name : str
        Of the module, letters, digits and underscores.
    tool : array of shape (4, 4)
        The tool's centre point in tool0.
    tool_mass : float
        [kg]
    poses : array of shape (n, 4, 4)
        Of the tool in the robot's base.
    configurations : array of shape (n, 4)
        confdata of the poses.
    start : array of shape (6,)
        Angles of the axes at the first pose [deg].
    speeds : array of shape (n,)
        [m/s]
    """
    none = "[9E9,9E9,9E9,9E9,9E9,9E9]"
    load = f"[{max(tool_mass, 0.001):.3f},[0,0,{max(1e3 * tool[2, 3] / 3.0, 1.0):.1f}],[1,0,0,0],0,0,0]"
    targets = [
        f"[{_pose(pose)},[{','.join(str(int(one)) for one in conf)}],{none}]"
        for pose, conf in zip(poses, configurations, strict=True)
    ]
    texts = [f"{1e3 * speed:.4f}" for speed in speeds]
    names = {text: f"vWeld{number or ''}" for number, text in enumerate(dict.fromkeys(texts))}
    zones = ["z0"] * (len(targets) - 1) + ["fine"]
    return "\n".join(
        [
            f"MODULE {name}",
            "  ! corrected path, written by daidalos weld plan",
            f"  PERS tooldata tWeld := [TRUE,[{_pose(tool)}],{load}];",
            *(f"  CONST speeddata {name} := [{text},500,5000,1000];" for text, name in names.items()),
            "  PROC main()",
            "    ConfL \\Off;",
            f"    MoveAbsJ [[{','.join(f'{angle:.4f}' for angle in start)}],{none}] \\NoEOffs,v50,fine,tWeld;",
            *(
                f"    MoveL {target},{names[text]},{zone},tWeld;"
                for target, text, zone in zip(targets, texts, zones, strict=True)
            ),
            "  ENDPROC",
            "ENDMODULE",
            "",
        ]
    )


def _pose(pose: NDArray[np.float64]) -> str:
    """Return position and quaternion as RAPID writes the two, without brackets around both."""
    from scipy.spatial.transform import Rotation

    x, y, z, w = Rotation.from_matrix(pose[:3, :3]).as_quat(canonical=True)
    position = ",".join(f"{1e3 * value:.4f}" for value in pose[:3, 3])
    return f"[{position}],[{w:.8f},{x:.8f},{y:.8f},{z:.8f}]"


def _path_of(moves: list[Any]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    from daidalos.industry.rapid.runtime.poses import pose_product
    from daidalos.industry.rapid.runtime.robot import wobj_pose

    runs = PathRuns()
    for move in moves:
        if move.instruction.startswith("MoveAbsJ") or move.instruction.startswith("MoveExtJ"):
            runs.begin(None)
            continue
        goal = _matrix(move.tool_pose())
        if move.instruction.startswith("MoveJ"):
            runs.begin(goal)
        elif move.via is not None and runs.last is not None:
            via = _matrix(pose_product(wobj_pose(move.wobj), [move.via[0], move.via[1]]))
            runs.add(arc(runs.last, via, goal))
        else:
            runs.add([goal])
    return runs.longest()


def _matrix(pose: Any) -> NDArray[np.float64]:
    from scipy.spatial.transform import Rotation

    out = np.eye(4)
    w, x, y, z = pose[1]
    out[:3, :3] = Rotation.from_quat([x, y, z, w]).as_matrix()
    out[:3, 3] = 1e-3 * np.array(pose[0])
    return out


def _no_answer(prompt: str) -> str:
    raise EOFError
