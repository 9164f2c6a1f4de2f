"""Parameters of `move_base` by their ROS 1 names, and its recovery behaviours."""

from __future__ import annotations

import ast
import math
from dataclasses import dataclass, replace
from typing import Any

from daidalos.common.errors import UserError
from daidalos.common.parameters import Parameters, parameter
from daidalos.common.suggestions import hint

CLEAR, ROTATE = "clear_costmap_recovery/ClearCostmapRecovery", "rotate_recovery/RotateRecovery"
SLOW = "move_slow_and_clear/MoveSlowAndClear"
AGGRESSIVE_RADII = 4.0
"""Edge of the square that the last reset leaves, in radii of the robot, as in ROS 1."""


@dataclass(frozen=True)
class MoveBaseParameters(Parameters):
    """Parameters of the node, by their ROS 1 names."""

    base_global_planner: str = parameter("navfn/NavfnROS", "The planner.", not_empty=True, read_only=True)
    base_local_planner: str = parameter(
        "base_local_planner/TrajectoryPlannerROS", "The controller.", not_empty=True, read_only=True
    )
    controller_frequency: float = parameter(
        20.0, "Velocity commands per second.", unit="Hz", above=0.0, takes_integer=True, read_only=True
    )
    planner_frequency: float = parameter(
        0.0, "Plans per second while the robot drives; 0 to plan when the controller fails.", unit="Hz", minimum=0.0,
        takes_integer=True,
    )  # fmt: skip
    planner_patience: float = parameter(
        5.0, "How long planning may fail before a recovery.", unit="s", minimum=0.0, takes_integer=True
    )
    controller_patience: float = parameter(
        15.0, "How long the controller may fail before a recovery.", unit="s", minimum=0.0, takes_integer=True
    )
    max_planning_retries: int = parameter(-1, "Failed plans before a recovery; negative for any number.")
    conservative_reset_dist: float = parameter(
        3.0, "Edge of the square around the robot that the first reset leaves.", unit="m", minimum=0.0,
        takes_integer=True,
    )  # fmt: skip
    recovery_behavior_enabled: bool = parameter(True, "Whether there are recoveries.")
    clearing_rotation_allowed: bool = parameter(True, "Whether the robot may turn on the spot to recover.")
    recovery_behaviors: str = parameter(
        "", "Recoveries as [{name: ..., type: ...}, ...]; those of ROS 1 where empty.", read_only=True
    )
    oscillation_timeout: float = parameter(
        0.0, "How long the robot may stay in one place before a recovery; 0 for any time.", unit="s", minimum=0.0,
        takes_integer=True,
    )  # fmt: skip
    oscillation_distance: float = parameter(
        0.5, "Distance that counts as having left it.", unit="m", minimum=0.0, takes_integer=True
    )


@dataclass(frozen=True)
class Recovery:
    """What the robot does when it cannot plan or drive.

    Attributes
    ----------
    name, type : str
        As in ROS 1; the type is `CLEAR`, `ROTATE` or `SLOW`.
    reset_distance : float
        Edge [m] of the square around the robot that a reset leaves.
    clearing_distance, limited_trans_speed, limited_distance : float
        For slow motion: distance [m] from the robot up to which costmaps are cleared, speed [m/s], and distance [m]
        after which the speed is not limited any more.
    """

    name: str
    type: str
    reset_distance: float = 0.0
    clearing_distance: float = 0.5
    limited_trans_speed: float = 0.25
    limited_distance: float = 0.3

    @property
    def parameters(self) -> set[str]:
        """Names of its parameters."""
        names = {
            CLEAR: ("reset_distance",),
            SLOW: ("clearing_distance", "limited_trans_speed", "limited_distance"),
        }.get(self.type, ())
        return {f"{self.name}.{one}" for one in names}


def recoveries(parameters: MoveBaseParameters, given: dict[str, Any], robot_radius: float) -> list[Recovery]:
    """Return the recoveries in their order.

    Parameters
    ----------
    parameters : MoveBaseParameters
    given : dict
        All given parameters; those of each recovery stand below its name.
    robot_radius : float
        Of the circle around the robot [m].

    Raises
    ------
    UserError
        A recovery has a type that is not known.
    """
    p = parameters
    if not p.recovery_behavior_enabled:
        return []
    if p.recovery_behaviors:
        return [_listed(one, given) for one in _entries(p.recovery_behaviors)]
    turn = [Recovery("rotate_recovery", ROTATE)] if p.clearing_rotation_allowed else []
    return [
        Recovery("conservative_reset", CLEAR, p.conservative_reset_dist),
        *turn,
        Recovery("aggressive_reset", CLEAR, AGGRESSIVE_RADII * robot_radius),
        *turn,
    ]


def plugin_list(text: str, name: str) -> list[tuple[str, str]]:
    """Return names and types of a list ``[{name: ..., type: ...}, ...]``, which ROS 2 keeps as text.

    Raises
    ------
    UserError
        It is no such list.
    """
    try:
        return [(str(one["name"]), str(one["type"])) for one in ast.literal_eval(text)]
    except (ValueError, SyntaxError, TypeError, KeyError, MemoryError, RecursionError):
        raise UserError(f"'{name}' must be a list of {{name: ..., type: ...}}, got {text[:60]!r}") from None


def _entries(text: str) -> list[tuple[str, str]]:
    return plugin_list(text, "recovery_behaviors")


def _listed(entry: tuple[str, str], given: dict[str, Any]) -> Recovery:
    name, kind = entry
    kind = kind.replace("::", "/")
    known = [CLEAR, ROTATE, SLOW]
    if kind not in known:
        raise UserError(f"'recovery_behaviors': there is no recovery '{kind}'{hint(kind, known)}")
    if kind != SLOW:
        return Recovery(name, kind, float(given.get(f"{name}.reset_distance", 3.0)))
    found = Recovery(name, kind)
    values: dict[str, Any] = {
        path.rpartition(".")[2]: _positive(path, given[path]) for path in found.parameters if path in given
    }
    return replace(found, **values)


def _positive(name: str, value: Any) -> float:
    """Return the value of a parameter that is a positive number.

    Raises
    ------
    UserError
        It is not.
    """
    if isinstance(value, bool) or not isinstance(value, int | float) or not 0.0 < value < math.inf:
        raise UserError(f"'{name}' must be a positive number, got {value!r}")
    return float(value)
