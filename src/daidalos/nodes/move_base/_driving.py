"""The way of `move_base` to a goal: plan, drive, and recover when neither goes on."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from action_msgs.msg import GoalStatus
from rclpy.action import ActionClient
from rclpy.node import Node

from daidalos.navigation.errors import NavigationError
from daidalos.nodes.cycles import Cycle
from daidalos.nodes.move_base._parameters import CLEAR, SLOW, MoveBaseParameters, Recovery
from daidalos.nodes.move_base._slow_motion import SlowMotion

_COSTMAPS = ("global_costmap", "local_costmap")
_PLAN_HZ = 5.0


class Interrupted(Exception):
    """The goal is no longer wanted."""


class GoalFailed(NavigationError):
    """No plan, or no way along it, in spite of all recoveries."""


class Driver:
    """Clients of the servers below a node.

    Parameters
    ----------
    node : Node
    behaviours : list of Recovery
    locate : callable
        Returns the robot's pose (x, y, yaw) in the global frame, None while it is not known.
    """

    def __init__(self, node: Node, behaviours: list[Recovery], locate: Callable[[], Any]) -> None:
        from nav2_msgs.action import ComputePathToPose, FollowPath, Spin
        from nav2_msgs.srv import ClearCostmapAroundRobot, ClearCostmapExceptRegion, ClearEntireCostmap

        below = node.get_fully_qualified_name()
        self._node, self._behaviours, self._locate = node, behaviours, locate
        self._plan_client = ActionClient(node, ComputePathToPose, f"{below}/compute_path_to_pose")
        self._drive_client = ActionClient(node, FollowPath, f"{below}/follow_path")
        self._spin_client = ActionClient(node, Spin, f"{below}/spin")
        self._clear = [
            node.create_client(ClearCostmapExceptRegion, f"{below}/{name}/clear_except_{name}") for name in _COSTMAPS
        ]
        self._clear_around = [
            node.create_client(ClearCostmapAroundRobot, f"{below}/{name}/clear_around_{name}") for name in _COSTMAPS
        ]
        self._slow_motion = SlowMotion(node, f"{below}/speed_limit", locate)
        self._clear_all = [
            node.create_client(ClearEntireCostmap, f"{below}/{name}/clear_entirely_{name}") for name in _COSTMAPS
        ]
        self.recoveries = 0
        self.distance_left = 0.0

    def _now(self) -> float:
        return 1e-9 * self._node.get_clock().now().nanoseconds

    async def go(
        self, goal: Any, p: MoveBaseParameters, is_wanted: Callable[[], bool], tell: Callable[[], None]
    ) -> None:
        """Drive to a stamped pose.

        Raises
        ------
        Interrupted
            It is no longer wanted.
        GoalFailed
            It cannot be reached.
        """
        self.recoveries, self.distance_left = 0, 0.0
        left = list(self._behaviours)
        failing_since: float | None = None
        while True:
            reason = ""
            path = await self._plan_patiently(goal, p, is_wanted)
            if isinstance(path, str):
                reason = f"no plan: {path}"
            else:
                begun, place = self._now(), self._place()
                problem = await self._follow(path, goal, p, is_wanted, tell)
                if problem is None:
                    return
                if self._has_left(place, p) or self._now() - begun > 2.0 * p.controller_patience:
                    left, failing_since = list(self._behaviours), None
                failing_since = begun if failing_since is None else failing_since
                if problem.startswith("oscillation") or self._now() - failing_since >= p.controller_patience:
                    reason = problem
            if reason:
                if not left:
                    raise GoalFailed(f"{reason}; {self.recoveries} recoveries were tried")
                self._node.get_logger().warning(f"{reason}; recovery '{left[0].name}'")
                self.recoveries += 1
                await self._recover(left.pop(0), is_wanted)
                failing_since = None

    def _place(self) -> Any:
        pose = self._locate()
        return None if pose is None else pose[:2]

    def _has_left(self, place: Any, p: MoveBaseParameters) -> bool:
        """Return whether the robot is farther from a place than `oscillation_distance`."""
        here = self._place()
        return place is not None and here is not None and math.hypot(*(here - place)) > p.oscillation_distance

    async def _plan_patiently(self, goal: Any, p: MoveBaseParameters, is_wanted: Callable[[], bool]) -> Any:
        """Return a path, or why there is none after `planner_patience` or `max_planning_retries`."""
        begun, tries = self._now(), 0
        with Cycle(self._node, _PLAN_HZ) as cycle:
            while True:
                path = await self.plan(goal, is_wanted=is_wanted)
                if not isinstance(path, str):
                    return path
                tries += 1
                if self._now() - begun >= p.planner_patience or 0 <= p.max_planning_retries < tries:
                    return path
                await cycle.next()

    async def plan(self, goal: Any, start: Any = None, *, is_wanted: Callable[[], bool] = lambda: True) -> Any:
        """Return a path, from a stamped pose or from where the robot is, or a text that says why there is none."""
        from nav2_msgs.action import ComputePathToPose

        request = ComputePathToPose.Goal(goal=goal, use_start=start is not None)
        if start is not None:
            request.start = start
        answer = await self._ended(self._plan_client, request, is_wanted)
        if answer.status == GoalStatus.STATUS_SUCCEEDED:
            return answer.result.path
        return answer.result.error_msg or "the planner stopped"

    async def _follow(
        self, path: Any, goal: Any, p: MoveBaseParameters, is_wanted: Callable[[], bool], tell: Callable[[], None]
    ) -> str | None:
        """Follow a path, with new plans at `planner_frequency`; return why it ended, None at the goal."""
        from nav2_msgs.action import FollowPath

        controlled = await self._sent(self._drive_client, FollowPath.Goal(path=path), self._on_feedback)
        result = controlled.get_result_async()
        replanned = resting_since = self._now()
        place = self._place()
        try:
            with Cycle(self._node, p.controller_frequency) as cycle:
                while not result.done():
                    await cycle.next()
                    if not is_wanted():
                        raise Interrupted
                    tell()
                    now = self._now()
                    if self._has_left(place, p) or place is None:
                        place, resting_since = self._place(), now
                    if 0.0 < p.oscillation_timeout < now - resting_since:
                        return f"oscillation: less than {p.oscillation_distance:g} m in {p.oscillation_timeout:g} s"
                    if p.planner_frequency > 0.0 and now - replanned >= 1.0 / p.planner_frequency:
                        replanned = now
                        newer = await self.plan(goal, is_wanted=is_wanted)
                        if not isinstance(newer, str) and not result.done():
                            controlled = await self._sent(
                                self._drive_client, FollowPath.Goal(path=newer), self._on_feedback
                            )
                            result = controlled.get_result_async()
        finally:
            if not result.done():
                controlled.cancel_goal_async()
        answer = result.result()
        if answer.status == GoalStatus.STATUS_SUCCEEDED:
            return None
        return answer.result.error_msg or "the controller stopped"

    def _on_feedback(self, message: Any) -> None:
        self.distance_left = float(message.feedback.distance_to_goal)

    async def _recover(self, recovery: Recovery, is_wanted: Callable[[], bool]) -> None:
        from nav2_msgs.action import Spin
        from nav2_msgs.srv import ClearCostmapAroundRobot, ClearCostmapExceptRegion

        if recovery.type == CLEAR:
            for client in self._clear:
                await client.call_async(ClearCostmapExceptRegion.Request(reset_distance=recovery.reset_distance))
            return
        if recovery.type == SLOW:
            self._slow_motion.begin(recovery.limited_trans_speed, recovery.limited_distance)
            edge = 2.0 * recovery.clearing_distance
            for client in self._clear_around:
                await client.call_async(ClearCostmapAroundRobot.Request(reset_distance=edge))
            return
        request = Spin.Goal(target_yaw=2.0 * math.pi)
        request.time_allowance.sec = 30
        await self._ended(self._spin_client, request, is_wanted)

    async def clear_costmaps(self) -> None:
        """Clear both costmaps."""
        from nav2_msgs.srv import ClearEntireCostmap

        for client in self._clear_all:
            await client.call_async(ClearEntireCostmap.Request())

    async def _sent(self, client: Any, request: Any, feedback: Any = None) -> Any:
        handle = await client.send_goal_async(request, feedback)
        if not handle.accepted:
            raise GoalFailed(f"a server rejected the goal of '{client.action_name}'")
        return handle

    async def _ended(self, client: Any, request: Any, is_wanted: Callable[[], bool]) -> Any:
        """Return the result of a goal; it is cancelled when it is no longer wanted."""
        handle = await self._sent(client, request)
        result = handle.get_result_async()
        with Cycle(self._node, 20.0) as cycle:
            while not result.done():
                if not is_wanted():
                    handle.cancel_goal_async()
                    raise Interrupted
                await cycle.next()
        if not is_wanted():
            raise Interrupted
        return result.result()
