"""The states of a goal and what leads from one to another (ROS 2 design article "Actions")."""

from __future__ import annotations

from enum import IntEnum

from rclpy.impl.errors import RCLError


class GoalState(IntEnum):
    """States, with the values of ``action_msgs/msg/GoalStatus``."""

    UNKNOWN = 0
    ACCEPTED = 1
    EXECUTING = 2
    CANCELING = 3
    SUCCEEDED = 4
    CANCELED = 5
    ABORTED = 6

    @property
    def is_active(self) -> bool:
        """Whether the goal is not yet over."""
        return self in (GoalState.ACCEPTED, GoalState.EXECUTING, GoalState.CANCELING)


class GoalEvent(IntEnum):
    """Event of a goal."""

    EXECUTE = 0
    CANCEL_GOAL = 1
    SUCCEED = 2
    ABORT = 3
    CANCELED = 4


_TRANSITIONS = {
    (GoalState.ACCEPTED, GoalEvent.EXECUTE): GoalState.EXECUTING,
    (GoalState.ACCEPTED, GoalEvent.CANCEL_GOAL): GoalState.CANCELING,
    (GoalState.EXECUTING, GoalEvent.CANCEL_GOAL): GoalState.CANCELING,
    (GoalState.EXECUTING, GoalEvent.SUCCEED): GoalState.SUCCEEDED,
    (GoalState.EXECUTING, GoalEvent.ABORT): GoalState.ABORTED,
    (GoalState.CANCELING, GoalEvent.SUCCEED): GoalState.SUCCEEDED,
    (GoalState.CANCELING, GoalEvent.ABORT): GoalState.ABORTED,
    (GoalState.CANCELING, GoalEvent.CANCELED): GoalState.CANCELED,
}


def next_state(state: GoalState, event: GoalEvent) -> GoalState:
    """Return the state after an event.

    Raises
    ------
    RCLError
        When the event cannot happen in the state.
    """
    try:
        return _TRANSITIONS[state, event]
    except KeyError:
        raise RCLError(
            f"goal_handle attempted invalid transition from state {state.name} with event {event.name}"
        ) from None
