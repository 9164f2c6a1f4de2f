"""Navigation: one run of a behavior tree with its successive goals."""

from __future__ import annotations

from typing import Any

from py_trees.common import Status
from rclpy.task import Future
from rclpy.time import Time

from daidalos.navigation.trees.action.poses import goals_of
from daidalos.navigation.trees.action_node import RECOVERIES
from daidalos.navigation.trees.behavior_tree import BehaviorTree
from daidalos.navigation.trees.blackboard import Blackboard


class Navigation:
    """Run of a behavior tree until it has ended for the latest of its goals.

    It begins with a goal, `replace_goal` gives it another any number of times, and `end` ends it once.

    Parameters
    ----------
    goal_handle
        Handle of the first goal of ``navigate_to_pose`` or ``navigate_through_poses``.
    tree
        Ticked for it; its blackboard gets the entry ``goal``, and ``goals`` where there are several.
    begun
        Time of the start.

    Attributes
    ----------
    goal_handle
        Handle of the latest goal.
    ended : Future
        Done when the navigation is; the result is that of the latest goal.
    fault : str
        Error that ended the tree; empty where there was none.
    """

    def __init__(self, goal_handle: Any, tree: BehaviorTree, begun: Time) -> None:
        self.goal_handle = goal_handle
        self.begun = begun
        self.ended = Future()
        self.fault = ""
        self._tree = tree
        self._set_goals(goal_handle.request)

    def _set_goals(self, request: Any) -> None:
        """Set the pose or the poses of a goal on the blackboard."""
        if hasattr(request, "poses"):
            self.blackboard.set("goals", list(request.poses))
            self.blackboard.set("goal", request.poses[-1])
        else:
            self.blackboard.set("goal", request.pose)

    @property
    def poses_remaining(self) -> int:
        """Number of the poses that the tree has not passed yet."""
        return len(goals_of(self.blackboard.get("goals")))

    @property
    def blackboard(self) -> Blackboard:
        """Blackboard of the tree."""
        return self._tree.blackboard

    def tick(self) -> Status:
        """Tick the tree; return its status, INVALID once the goal was cancelled or aborted and the tree halted."""
        if self.goal_handle.is_active and not self.goal_handle.is_cancel_requested:
            return self._tree.tick()
        self.halt()
        return Status.INVALID

    def halt(self) -> None:
        """Halt the tree."""
        self._tree.halt()

    def replace_goal(self, goal_handle: Any, result: Any) -> None:
        """Continue the tree with another goal.

        Parameters
        ----------
        goal_handle
            Handle of the goal from now on.
        result
            With which the previous goal is aborted.
        """
        previous, self.goal_handle = self.goal_handle, goal_handle
        self._set_goals(goal_handle.request)
        self.blackboard.set(RECOVERIES, 0)
        if previous.is_active:
            previous.abort(result)

    def end(self, status: Status, result: Any) -> None:
        """End the latest goal as the tree has ended; see `tick`."""
        if status == Status.SUCCESS:
            self.goal_handle.succeed()
        elif status == Status.FAILURE:
            self.goal_handle.abort()
        elif self.goal_handle.is_active:
            self.goal_handle.canceled()
        self.ended.set_result(result)
