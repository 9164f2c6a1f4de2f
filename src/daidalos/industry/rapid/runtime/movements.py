"""Predefined routines that move the robot, and those that say how."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from daidalos.industry.rapid.runtime.errors import RapidError
from daidalos.industry.rapid.runtime.poses import normalized, pose_inverse, pose_product
from daidalos.industry.rapid.runtime.positions import WOBJ0
from daidalos.industry.rapid.runtime.registry import routine
from daidalos.industry.rapid.runtime.robot import Move

if TYPE_CHECKING:
    from daidalos.industry.rapid.runtime.task import Task

FINE: list[Any] = [True, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]


def _order(
    task: Task,
    instruction: str,
    target: list[Any],
    speed: list[float],
    zone: list[Any] | None,
    tool: list[Any],
    wobj: list[Any] | None,
    via: list[Any] | None = None,
    v: float | None = None,
    t: float | None = None,
    z: float | None = None,
) -> None:
    """Order a movement, and let the time of it pass."""
    if v is not None:
        speed = [v, *speed[1:]]
    zone = FINE if zone is None else zone
    if z is not None:
        zone = [False, z, z, z, *zone[4:]]
    if speed[0] <= 0 and t is None:
        raise RapidError("ERR_SPEEDLIM_VALUE", f"the speed is {speed[0]:g} mm/s")
    is_joint = len(target) == 2
    if not is_joint:
        target = _displaced(task, target)
        via = _displaced(task, via) if via is not None else None
    move = Move(instruction, target, speed, zone, tool, wobj or WOBJ0, via, t, task.line())
    task.settings["tool"], task.settings["wobj"] = tool, wobj or WOBJ0
    robot = task.robot
    if is_joint:
        seconds = robot.move_abs_j(move)
    elif via is not None:
        seconds = robot.move_c(move)
    else:
        seconds = robot.move_l(move) if "L" in instruction[4:] else robot.move_j(move)
    if zone[0]:
        seconds += robot.wait_in_position()
    task.pass_time(seconds / task.settings.get("override", 1.0))


def _displaced(task: Task, target: list[Any]) -> list[Any]:
    oriented = [target[0], normalized(target[1]), target[2], target[3]]
    frame = task.settings.get("displacement")
    if frame is None:
        return oriented
    moved = pose_product(frame, [oriented[0], oriented[1]])
    return [moved[0], moved[1], target[2], target[3]]


@routine("MoveL")
def move_l(
    task: Task,
    topoint_: list[Any],
    speed_: list[float],
    tool_: list[Any],
    zone_: Any = None,
    wobj_: Any = None,
    v_: float | None = None,
    t_: float | None = None,
    z_: float | None = None,
    **rest: Any,
) -> None:
    """Move along a line."""
    _order(task, "MoveL", topoint_, speed_, zone_, tool_, wobj_, None, v_, t_, z_)


@routine("MoveJ")
def move_j(
    task: Task,
    topoint_: list[Any],
    speed_: list[float],
    tool_: list[Any],
    zone_: Any = None,
    wobj_: Any = None,
    v_: float | None = None,
    t_: float | None = None,
    z_: float | None = None,
    **rest: Any,
) -> None:
    """Move by the joints."""
    _order(task, "MoveJ", topoint_, speed_, zone_, tool_, wobj_, None, v_, t_, z_)


@routine("MoveC")
def move_c(
    task: Task,
    cirpoint_: list[Any],
    topoint_: list[Any],
    speed_: list[float],
    tool_: list[Any],
    zone_: Any = None,
    wobj_: Any = None,
    v_: float | None = None,
    t_: float | None = None,
    z_: float | None = None,
    **rest: Any,
) -> None:
    """Move along a circle."""
    _order(task, "MoveC", topoint_, speed_, zone_, tool_, wobj_, cirpoint_, v_, t_, z_)


@routine("MoveAbsJ")
def move_abs_j(
    task: Task,
    tojointpos_: list[Any],
    speed_: list[float],
    tool_: list[Any],
    zone_: Any = None,
    wobj_: Any = None,
    v_: float | None = None,
    t_: float | None = None,
    z_: float | None = None,
    **rest: Any,
) -> None:
    """Move to joint positions."""
    _order(task, "MoveAbsJ", tojointpos_, speed_, zone_, tool_, wobj_, None, v_, t_, z_)


@routine("MoveLDO", "MoveLAO", "MoveLGO")
def move_l_signal(
    task: Task, topoint_: Any, speed_: Any, zone_: Any, tool_: Any, signal_: str, value_: Any = None, **rest: Any
) -> None:
    """Move along a line, and set a signal at its end."""
    _order(task, "MoveL", topoint_, speed_, zone_, tool_, rest.get("wobj_"), None, None, rest.get("t_"))
    task.signals.set(signal_, float(value_ if value_ is not None else rest.get("dvalue_") or 0.0))
    task.pass_time(0.0)


@routine("MoveJDO", "MoveJAO", "MoveJGO")
def move_j_signal(
    task: Task, topoint_: Any, speed_: Any, zone_: Any, tool_: Any, signal_: str, value_: Any = None, **rest: Any
) -> None:
    """Move by the joints, and set a signal at the end."""
    _order(task, "MoveJ", topoint_, speed_, zone_, tool_, rest.get("wobj_"), None, None, rest.get("t_"))
    task.signals.set(signal_, float(value_ if value_ is not None else rest.get("dvalue_") or 0.0))
    task.pass_time(0.0)


@routine("VelSet")
def vel_set(task: Task, override_: float, max_: float) -> None:
    """Scale all programmed speeds, in percent."""
    if not 0 < override_ <= 100:
        raise RapidError("ERR_SPEEDLIM_VALUE", f"VelSet takes 0 to 100 percent, not {override_:g}")
    task.settings["override"] = override_ / 100.0


@routine("PDispSet")
def displacement_set(task: Task, dispframe_: list[Any]) -> None:
    """Displace all targets that follow."""
    task.settings["displacement"] = dispframe_


@routine("PDispOff")
def displacement_off(task: Task) -> None:
    """End the displacement."""
    task.settings.pop("displacement", None)


@routine(
    "AccSet", "ConfJ", "ConfL", "SingArea", "CirPathMode", "GripLoad", "MotionSup", "PathResol", "PathAccLim",
    "WorldAccLim", "SoftAct", "SoftDeact", "CornerPathWarning", "ActUnit", "DeactUnit", "EOffsOff", "EOffsSet",
    "SpeedRefresh",
)  # fmt: skip
def set_motion(task: Task, **values: Any) -> None:
    """Take a setting of how the robot moves; one without joints moves the same."""


@routine("StopMove", "StartMove", "StopMoveReset", "StorePath", "RestoPath", "ClearPath")
def set_path(task: Task, **values: Any) -> None:
    """Stop or resume movement; between instructions this robot stands."""


@routine("ORobT")
def original_target(task: Task, orgpoint_: list[Any], inpdisp_: Any = None, ineoffs_: Any = None) -> list[Any]:
    """Return a target without the displacement that is in force."""
    frame = task.settings.get("displacement")
    if frame is None or inpdisp_:
        return orgpoint_
    back = pose_product(pose_inverse(frame), [orgpoint_[0], orgpoint_[1]])
    return [back[0], back[1], orgpoint_[2], orgpoint_[3]]
