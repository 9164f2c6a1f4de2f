"""The event that asks nodes for a transition of their life cycle."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from launch.event import Event

if TYPE_CHECKING:
    from ...actions import LifecycleNode


class ChangeState(Event):
    """Nodes are to make a transition.

    Parameters
    ----------
    lifecycle_node_matcher
        Tells whether the node of an action is meant.
    transition_id
        The transition, a constant of `lifecycle_msgs.msg.Transition`.
    """

    name = "launch_ros.events.lifecycle.ChangeState"

    def __init__(self, *, lifecycle_node_matcher: Callable[[LifecycleNode], bool], transition_id: int) -> None:
        self.__lifecycle_node_matcher = lifecycle_node_matcher
        self.__transition_id = transition_id

    @property
    def lifecycle_node_matcher(self) -> Callable[[LifecycleNode], bool]:
        """Tells whether the node of an action is meant."""
        return self.__lifecycle_node_matcher

    @property
    def transition_id(self) -> int:
        """The transition."""
        return self.__transition_id
