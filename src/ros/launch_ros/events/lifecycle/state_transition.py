"""The event of a node that made a transition of its life cycle."""

from __future__ import annotations

from typing import TYPE_CHECKING

from launch.event import Event

if TYPE_CHECKING:
    from lifecycle_msgs.msg import TransitionEvent

    from ...actions import LifecycleNode


class StateTransition(Event):
    """A node made a transition.

    Parameters
    ----------
    action
        The action that runs the node.
    msg
        The message `lifecycle_msgs.msg.TransitionEvent`.
    """

    name = "launch_ros.events.lifecycle.StateTransition"

    def __init__(self, *, action: LifecycleNode, msg: TransitionEvent) -> None:
        self.__action = action
        self.__msg = msg

    @property
    def action(self) -> LifecycleNode:
        """The action that runs the node."""
        return self.__action

    @property
    def msg(self) -> TransitionEvent:
        """The message."""
        return self.__msg

    @property
    def timestamp(self) -> int:
        """When it was made, in nanoseconds."""
        return self.__msg.timestamp

    @property
    def transition(self) -> str:
        """The transition's label."""
        return self.__msg.transition.label

    @property
    def start_state(self) -> str:
        """The label of the state before."""
        return self.__msg.start_state.label

    @property
    def goal_state(self) -> str:
        """The label of the state after."""
        return self.__msg.goal_state.label
