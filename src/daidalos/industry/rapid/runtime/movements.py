"""Predefined routines that move the robot, and those that say how."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from daidalos.industry.rapid.runtime.errors import FatalError, RapidError
from daidalos.industry.rapid.runtime.poses import normalized, pose_inverse, pose_product
from daidalos.industry.rapid.runtime.positions import WOBJ0
from daidalos.industry.rapid.runtime.registry import routine
from daidalos.industry.rapid.runtime.robot import Event, MotionSettings, Move

if TYPE_CHECKING:
    from daidalos.industry.rapid.runtime.task import Task

MIN_SPEED = 1e-3
"""Least speed of the tool [mm/s]."""

FINE: list[Any] = [True, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]


def order(
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
    events: tuple[Event, ...] = (),
    waits: bool = True,
) -> None:
    """Order a movement, and let time pass until the program may go on, where it waits for that."""
    zone = FINE if zone is None else zone
    if z is not None:
        zone = [False, z, z, z, *zone[4:]]
    speed = _scaled(task, speed if v is None else [v, *speed[1:]])
    if speed[0] < MIN_SPEED and t is None:
        raise RapidError("ERR_SPEEDLIM_VALUE", f"the speed is {speed[0]:g} mm/s, and at least {MIN_SPEED:g} is needed")
    if len(target) != 2:
        target = _displaced(task, target)
        via = _displaced(task, via) if via is not None else None
    wobj = wobj or WOBJ0
    settings = motion_settings(task)
    move = Move(instruction, target, speed, zone, tool, wobj, via, t, task.line(), settings, events)
    task.settings["tool"], task.settings["wobj"] = tool, wobj
    while not task.robot.order(move):
        task.wait_for_robot(task.robot.remaining)
    if waits:
        task.wait_for_robot(task.robot.remaining if zone[0] else task.robot.room)


def _scaled(task: Task, speed: list[float]) -> list[float]:
    """Return speeddata as VelSet leaves it."""
    share, greatest = task.settings.get("speeds", (1.0, math.inf))
    return [min(speed[0] * share, greatest), *(one * share for one in speed[1:])]


def motion_settings(task: Task) -> MotionSettings:
    """Return what holds for movements."""
    found: MotionSettings = task.settings.get("motion", MotionSettings())
    return found


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
    order(task, "MoveL", topoint_, speed_, zone_, tool_, wobj_, None, v_, t_, z_)


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
    order(task, "MoveJ", topoint_, speed_, zone_, tool_, wobj_, None, v_, t_, z_)


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
    order(task, "MoveC", topoint_, speed_, zone_, tool_, wobj_, cirpoint_, v_, t_, z_)


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
    order(task, "MoveAbsJ", tojointpos_, speed_, zone_, tool_, wobj_, None, v_, t_, z_)


@routine("MoveLDO", "MoveLAO", "MoveLGO")
def move_l_signal(
    task: Task, topoint_: Any, speed_: Any, zone_: Any, tool_: Any, signal_: str, value_: Any = None, **rest: Any
) -> None:
    """Move along a line, and set a signal at its end."""
    order(task, "MoveL", topoint_, speed_, zone_, tool_, rest.get("wobj_"), None, None, rest.get("t_"))
    task.signals.set(signal_, float(value_ if value_ is not None else rest.get("dvalue_") or 0.0))
    task.pass_time(0.0)


@routine("MoveJDO", "MoveJAO", "MoveJGO")
def move_j_signal(
    task: Task, topoint_: Any, speed_: Any, zone_: Any, tool_: Any, signal_: str, value_: Any = None, **rest: Any
) -> None:
    """Move by the joints, and set a signal at the end."""
    order(task, "MoveJ", topoint_, speed_, zone_, tool_, rest.get("wobj_"), None, None, rest.get("t_"))
    task.signals.set(signal_, float(value_ if value_ is not None else rest.get("dvalue_") or 0.0))
    task.pass_time(0.0)


@routine("VelSet")
def vel_set(task: Task, override_: float, max_: float) -> None:
    """Scale all programmed speeds, in percent, and limit that of the tool, in mm/s."""
    if not 0 < override_ <= 100 or not max_ > 0:
        raise RapidError("ERR_SPEEDLIM_VALUE", f"VelSet takes 0 to 100 percent and mm/s, not {override_:g}, {max_:g}")
    task.settings["speeds"] = (override_ / 100.0, max_)


@routine("AccSet")
def acc_set(task: Task, acc_: float, ramp_: float, finepointramp_: float | None = None) -> None:
    """Scale acceleration and its rate of change, in percent; a controller takes 20 and 10 at least."""
    shares = (min(max(acc_, 20.0), 100.0) / 100.0, min(max(ramp_, 10.0), 100.0) / 100.0)
    _set_motion(task, acceleration=shares[0], ramp=shares[1])


@routine("PathAccLim")
def path_acc_lim(
    task: Task, acclim_: bool, decellim_: bool, accmax_: float | None = None, decelmax_: float | None = None
) -> None:
    """Limit acceleration and deceleration along the path, in m/s^2; the smaller holds for both."""
    asked = [one for one, is_on in ((accmax_, acclim_), (decelmax_, decellim_)) if is_on and one is not None]
    if any(one < 0.1 for one in asked):
        raise RapidError("ERR_ACC_TOO_LOW", f"PathAccLim takes 0.1 m/s^2 and more, not {min(asked):g}")
    _set_motion(task, path_acceleration=min(asked, default=math.inf))


@routine("ConfL")
def conf_l(task: Task, on_: Any = None, off_: Any = None) -> None:
    """Set whether linear movements have to arrive with the target's configuration."""
    _set_motion(task, checks_line=not off_)


@routine("ConfJ")
def conf_j(task: Task, on_: Any = None, off_: Any = None) -> None:
    """Set whether joint movements go to the target's configuration, or to the nearest."""
    _set_motion(task, checks_joint=not off_)


@routine("SingArea")
def sing_area(task: Task, wrist_: Any = None, lockaxis4_: Any = None, off_: Any = None) -> None:
    """Set whether the tool may turn to pass a singularity of the wrist."""
    if lockaxis4_:
        raise FatalError("SingArea \\LockAxis4 is for arms with five axes; use \\Wrist")
    _set_motion(task, turns_wrist=bool(wrist_))


@routine("CirPathMode")
def cir_path_mode(
    task: Task,
    pathframe_: Any = None,
    objectframe_: Any = None,
    cirpointori_: Any = None,
    wrist45_: Any = None,
    wrist46_: Any = None,
    wrist56_: Any = None,
) -> None:
    """Set how the tool turns on a circle."""
    if wrist45_ or wrist46_ or wrist56_:
        raise FatalError("CirPathMode with wrist movements is for cutting tools; use \\ObjectFrame")
    _set_motion(task, circle="object" if objectframe_ else "point" if cirpointori_ else "path")


def _set_motion(task: Task, **values: Any) -> None:
    task.settings["motion"] = replace(motion_settings(task), **values)


@routine("PDispSet")
def displacement_set(task: Task, dispframe_: list[Any]) -> None:
    """Displace all targets that follow."""
    task.settings["displacement"] = dispframe_


@routine("PDispOff")
def displacement_off(task: Task) -> None:
    """End the displacement."""
    task.settings.pop("displacement", None)


@routine(
    "GripLoad", "MotionSup", "PathResol", "WorldAccLim", "SoftAct", "SoftDeact", "CornerPathWarning", "ActUnit",
    "DeactUnit", "EOffsOff", "EOffsSet", "SpeedRefresh",
)  # fmt: skip
def set_drives(task: Task, **values: Any) -> None:
    """Take a setting of the drives, of loads or of external axes; a simulated arm moves the same."""


@routine("StopMove")
def stop_move(task: Task, quick_: Any = None, allmotask_: Any = None, **rest: Any) -> None:
    """Stop on the path, and wait until the robot stands."""
    task.pass_time(task.robot.stop())


@routine("StartMove")
def start_move(task: Task, **rest: Any) -> None:
    """Go on along the path."""
    task.robot.resume()


@routine("StopMoveReset")
def stop_move_reset(task: Task, **rest: Any) -> None:
    """Forget that movement was stopped, and the rest of the path with it."""
    task.robot.clear()
    task.robot.resume()


@routine("ClearPath")
def clear_path(task: Task) -> None:
    """Forget the rest of the path."""
    task.robot.clear()


@routine("ORobT")
def original_target(task: Task, orgpoint_: list[Any], inpdisp_: Any = None, ineoffs_: Any = None) -> list[Any]:
    """Return a target without the displacement that is in force."""
    frame = task.settings.get("displacement")
    if frame is None or inpdisp_:
        return orgpoint_
    back = pose_product(pose_inverse(frame), [orgpoint_[0], orgpoint_[1]])
    return [back[0], back[1], orgpoint_[2], orgpoint_[3]]
