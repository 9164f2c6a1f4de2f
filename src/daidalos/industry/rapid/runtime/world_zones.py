"""Predefined routines of world zones: shapes that set an output, or stop the robot, when it is inside."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from daidalos.industry.rapid.runtime.errors import FatalError, RapidError
from daidalos.industry.rapid.runtime.positions import TOOL0, WOBJ0
from daidalos.industry.rapid.runtime.registry import routine

if TYPE_CHECKING:
    from daidalos.industry.rapid.runtime.task import Task
    from daidalos.industry.rapid.runtime.values import Handle

_UNUSED = 9e8


@dataclass
class Zone:
    """A world zone: where it is, what it does, and whether it is in force.

    Attributes
    ----------
    contains
        Whether the robot is inside, from the tool's position [mm] and the angles [deg].
    act
        Called with that whenever the robot has moved.
    """

    contains: Callable[[list[float], list[float]], bool]
    act: Callable[[bool], None]
    is_enabled: bool = True


def _shape(shape: Handle, outside: Any, inside: Callable[[list[float], list[float]], bool]) -> None:
    shape.state = (lambda position, joints: not inside(position, joints)) if outside else inside


@routine("WZBoxDef")
def define_box(
    task: Task,
    shape_: Handle,
    lowpoint_: list[float],
    highpoint_: list[float],
    inside_: Any = None,
    outside_: Any = None,
) -> None:
    """Define a box in the world frame by two corners."""
    pairs = [sorted(one) for one in zip(lowpoint_, highpoint_, strict=True)]
    if any(high - low < 1.0 for low, high in pairs):
        raise RapidError("ERR_ARGVALERR", "a box is at least 1 mm in each direction")
    _shape(shape_, outside_, lambda at, _: all(low <= one <= high for one, (low, high) in zip(at, pairs, strict=True)))


@routine("WZSphDef")
def define_sphere(
    task: Task, shape_: Handle, centrepoint_: list[float], radius_: float, inside_: Any = None, outside_: Any = None
) -> None:
    """Define a sphere in the world frame."""
    centre = list(centrepoint_)
    _shape(shape_, outside_, lambda at, _: math.dist(at, centre) <= radius_)


@routine("WZCylDef")
def define_cylinder(
    task: Task,
    shape_: Handle,
    centrepoint_: list[float],
    radius_: float,
    height_: float,
    inside_: Any = None,
    outside_: Any = None,
) -> None:
    """Define an upright cylinder by the centre of its bottom; a negative height goes down."""
    x, y, z = centrepoint_
    low, high = sorted((z, z + height_))
    _shape(shape_, outside_, lambda at, _: math.dist(at[:2], (x, y)) <= radius_ and low <= at[2] <= high)


def _joint_shape(shape: Handle, outside: Any, low: list[float], high: list[float]) -> None:
    _shape(shape, outside, lambda _, joints: all(a <= one <= b for a, one, b in zip(low, joints, high, strict=True)))


@routine("WZHomeJointDef")
def define_home(
    task: Task,
    shape_: Handle,
    middlejointval_: list[Any],
    deltajointval_: list[Any],
    inside_: Any = None,
    outside_: Any = None,
) -> None:
    """Define a range of angles about a position; an axis with 9E9 is left out."""
    low, high = [], []
    for middle, delta in zip(middlejointval_[0], deltajointval_[0], strict=True):
        is_used = abs(middle) < _UNUSED and abs(delta) < _UNUSED
        low.append(middle - delta if is_used else -math.inf)
        high.append(middle + delta if is_used else math.inf)
    _joint_shape(shape_, outside_, low, high)


@routine("WZLimJointDef")
def define_limits(
    task: Task,
    shape_: Handle,
    lowjointval_: list[Any],
    highjointval_: list[Any],
    inside_: Any = None,
    outside_: Any = None,
) -> None:
    """Define a range of angles by its ends; an end with 9E9 is left out."""
    low = [one if abs(one) < _UNUSED else -math.inf for one in lowjointval_[0]]
    high = [one if abs(one) < _UNUSED else math.inf for one in highjointval_[0]]
    _joint_shape(shape_, outside_, low, high)


def _add(task: Task, world_zone: list[Any], shape: Handle, act: Callable[[bool], None]) -> None:
    if shape.state is None:
        raise RapidError("ERR_ARGVALERR", "the shape is not defined; WZBoxDef or the like comes first")
    zones: dict[float, Zone] = task.settings.setdefault("zones", {})
    number = max(zones, default=0.0) + 1.0
    zones[number] = Zone(shape.state, act)
    world_zone[0] = number
    if len(zones) == 1:
        task.robot.watch(lambda: _look(task))
    _look(task)


def _look(task: Task) -> None:
    zones: dict[float, Zone] = task.settings.get("zones", {})
    if not any(one.is_enabled for one in zones.values()):
        return
    position = task.robot.robtarget(task.settings.get("tool", TOOL0), WOBJ0)[0]
    joints = task.robot.jointtarget()[0]
    for one in list(zones.values()):
        if one.is_enabled:
            one.act(one.contains(position, joints))


@routine("WZDOSet")
def set_in_zone(
    task: Task,
    worldzone_: list[Any],
    shape_: Handle,
    signal_: str,
    setvalue_: float,
    temp_: Any = None,
    stat_: Any = None,
    inside_: Any = None,
    before_: Any = None,
) -> None:
    r"""Set an output while the robot is in a shape; with \Before too, since no path is looked at ahead."""
    task.signals.value(signal_)
    _add(task, worldzone_, shape_, lambda is_in: task.signals.set(signal_, setvalue_ if is_in else 1.0 - setvalue_))


@routine("WZLimSup")
def limit_zone(task: Task, worldzone_: list[Any], shape_: Handle, temp_: Any = None, stat_: Any = None) -> None:
    """Stop the robot, and the program, when it comes into a shape."""

    def act(is_in: bool) -> None:
        if is_in:
            raise FatalError("the robot has come into a world zone that WZLimSup forbids; it stops on its path")

    _add(task, worldzone_, shape_, act)


def _zone(task: Task, world_zone: list[Any]) -> Zone:
    zones: dict[float, Zone] = task.settings.get("zones", {})
    if world_zone[0] not in zones:
        raise RapidError("ERR_ARGVALERR", "the world zone is not defined, or was freed")
    return zones[world_zone[0]]


@routine("WZEnable")
def enable(task: Task, worldzone_: list[Any]) -> None:
    """Put a zone into force again."""
    _zone(task, worldzone_).is_enabled = True
    _look(task)


@routine("WZDisable")
def disable(task: Task, worldzone_: list[Any]) -> None:
    """Suspend a zone."""
    _zone(task, worldzone_).is_enabled = False


@routine("WZFree")
def free(task: Task, worldzone_: list[Any]) -> None:
    """Remove a zone."""
    _zone(task, worldzone_)
    del task.settings["zones"][worldzone_[0]]
    worldzone_[0] = 0.0
