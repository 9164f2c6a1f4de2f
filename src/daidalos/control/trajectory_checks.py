"""Checks of commanded trajectories before any joint moves."""

from __future__ import annotations

import itertools
from typing import Protocol

import numpy as np

from daidalos.samples.controllers import TrajectoryCommand, TrajectoryPoint

_AT_REST = 1e-9


class Rules(Protocol):
    """Requirements of a controller on trajectories."""

    @property
    def joints(self) -> tuple[str, ...]:
        """All joints of the controller."""

    @property
    def allow_partial_joints_goal(self) -> bool:
        """Return whether joints may be left out."""

    @property
    def allow_integration_in_goal_trajectories(self) -> bool:
        """Return whether waypoints may give velocities alone."""

    @property
    def allow_nonzero_velocity_at_trajectory_end(self) -> bool:
        """Return whether a trajectory may end in motion."""


def problem_with(command: TrajectoryCommand, rules: Rules, now_ns: int) -> str:
    """Return why a trajectory cannot be followed, or an empty string.

    Parameters
    ----------
    command : TrajectoryCommand
    rules : Rules
    now_ns : int
        Time at which it arrives.
    """
    return (
        _problem_with_joints(command, rules)
        or _problem_with_times(command, now_ns)
        or next((text for point in command.points if (text := _problem_with_point(point, command, rules))), "")
        or _problem_with_end(command, rules)
    )


def _problem_with_joints(command: TrajectoryCommand, rules: Rules) -> str:
    known = rules.joints
    if not command.joints:
        return "it has no joint names"
    for name in command.joints:
        if name not in known:
            return f"joint '{name}' is not one of the controller's: {', '.join(known)}"
        if command.joints.count(name) > 1:
            return f"joint '{name}' is there twice"
    missing = [name for name in known if name not in command.joints]
    if missing and not rules.allow_partial_joints_goal:
        return f"joints are missing and partial goals are not allowed: {', '.join(missing)}"
    return ""


def _problem_with_times(command: TrajectoryCommand, now_ns: int) -> str:
    if not command.points:
        return "it has no points"
    times = [point.time for point in command.points]
    if times[0] < 0.0:
        return f"time_from_start of the first point is negative: {times[0]:g} s"
    for number, (before, after) in enumerate(itertools.pairwise(times), 2):
        if after <= before:
            return f"time_from_start of point {number} is not after the one before: {after:g} s, {before:g} s"
    if command.start_ns and command.start_ns + round(times[-1] * 1e9) < now_ns:
        late = (now_ns - command.start_ns) * 1e-9 - times[-1]
        return f"it ended {late:.3f} s ago"
    return ""


def _problem_with_point(point: TrajectoryPoint, command: TrajectoryCommand, rules: Rules) -> str:
    count = len(command.joints)
    at = f"the point at {point.time:g} s"
    for name in ("positions", "velocities", "accelerations", "efforts"):
        values = getattr(point, name)
        if values is None:
            continue
        if len(values) != count:
            return f"{at} has {len(values)} {name} for {count} joints"
        if not np.all(np.isfinite(values)):
            return f"{at} has {name} that are not numbers"
    if point.efforts is not None:
        return f"{at} has efforts, which a trajectory cannot be followed by"
    integrates = rules.allow_integration_in_goal_trajectories and point.velocities is not None
    return "" if point.positions is not None or integrates else f"{at} has no positions"


def _problem_with_end(command: TrajectoryCommand, rules: Rules) -> str:
    velocities = command.points[-1].velocities
    if velocities is None or rules.allow_nonzero_velocity_at_trajectory_end:
        return ""
    for name, velocity in zip(command.joints, velocities, strict=True):
        if abs(velocity) > _AT_REST:
            return f"the last point has a velocity for joint '{name}': {velocity:g}"
    return ""
