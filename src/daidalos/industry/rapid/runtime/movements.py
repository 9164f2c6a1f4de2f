"""Predefined routines that move the robot, and those that say how."""

from __future__ import annotations

import functools
import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from daidalos.industry.rapid.runtime.errors import FatalError, RapidError
from daidalos.industry.rapid.runtime.poses import normalized, pose_inverse, pose_product
from daidalos.industry.rapid.runtime.positions import WOBJ0
from daidalos.industry.rapid.runtime.registry import routine
from daidalos.industry.rapid.runtime.robot import Event, MotionSettings, Move
from daidalos.industry.rapid.runtime.synchronising import order_together, together

if TYPE_CHECKING:
    from daidalos.industry.rapid.runtime.task import Task

MIN_SPEED = 1e-3
"""Least speed of the tool [mm/s]."""

MANUAL_SPEED = 250.0
"""Greatest speed of the tool in manual mode [mm/s]."""

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
    number: float | None = None,
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
    if together(task) is not None:
        order_together(task, replace(move, zone=FINE), number)
        return
    while not _is_taken(task, move):
        task.wait_for_robot(task.robot.remaining)
    if waits:
        task.wait_for_robot(task.robot.remaining if zone[0] else task.robot.room)


def _is_taken(task: Task, move: Move) -> bool:
    with task.waiting():
        return task.robot.order(move)


def _scaled(task: Task, speed: list[float]) -> list[float]:
    """Return speeddata as VelSet leaves it."""
    share, greatest = task.settings.get("speeds", (1.0, math.inf))
    greatest = min(greatest, motion_settings(task).greatest_speed)
    return [min(speed[0] * share, greatest), *(one * share for one in speed[1:])]


def set_manual(task: Task, is_manual: bool = True) -> None:
    """Put a task into manual mode, in which the tool is no faster than 250 mm/s, or into automatic mode."""
    task.settings["is_manual"] = is_manual
    _set_motion(task, greatest_speed=MANUAL_SPEED if is_manual else math.inf)


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


def _movement(name: str, instruction: str) -> None:
    """Register an instruction that moves; with a signal or a procedure, it is set or called at the movement's end."""

    @routine(name)
    def move(
        task: Task,
        speed_: list[float],
        tool_: list[Any],
        topoint_: list[Any] | None = None,
        tojointpos_: list[Any] | None = None,
        cirpoint_: list[Any] | None = None,
        zone_: list[Any] | None = None,
        wobj_: list[Any] | None = None,
        v_: float | None = None,
        t_: float | None = None,
        z_: float | None = None,
        id_: float | None = None,
        **rest: Any,
    ) -> None:
        target = topoint_ if topoint_ is not None else tojointpos_
        assert target is not None
        events = _at_end(task, **rest)
        order(task, instruction, target, speed_, zone_, tool_, wobj_, cirpoint_, v_, t_, z_, events, number=id_)

    move.__doc__ = f"Carry out {name}."


def _at_end(
    task: Task,
    signal_: Any = None,
    value_: float | None = None,
    dvalue_: float | None = None,
    procname_: str | None = None,
    **rest: Any,
) -> tuple[Event, ...]:
    """Return what MoveLDO, MoveLSync and the like do at the end of a movement, or in the middle of its corner path."""
    if procname_ is not None:
        return (Event(functools.partial(task.call_late, procname_, [])),)
    if signal_ is None:
        return ()
    value = value_ if value_ is not None else dvalue_ if dvalue_ is not None else 0.0
    task.signals.value(signal_)
    return (Event(functools.partial(task.signals.set, signal_, float(value))),)


for _instruction in ("MoveL", "MoveJ", "MoveC"):
    for _what in ("", "DO", "AO", "GO", "Sync"):
        _movement(f"{_instruction}{_what}", _instruction)
_movement("MoveAbsJ", "MoveAbsJ")


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
