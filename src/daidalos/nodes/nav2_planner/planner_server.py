"""`planner_server`: plans paths over the global costmap."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from rclpy.time import Time
from tf2_ros import TransformException

from daidalos.common.parameters import Parameters, parameter
from daidalos.common.pose2 import compose
from daidalos.navigation.contracts import GlobalPlanner
from daidalos.navigation.costmap.costmap import NO_INFORMATION
from daidalos.navigation.costmap.footprint import FootprintCollisionChecker
from daidalos.navigation.errors import NavigationError, PlanningCancelled
from daidalos.navigation.extensions import PLANNERS
from daidalos.nodes.action_results import TransformFailed
from daidalos.nodes.conversions import path_message, pose2_of, pose2_of_transform
from daidalos.nodes.managed import ContainedNode, ManagedNode
from daidalos.nodes.nav2_costmap_2d._costmap_node import CostmapNode
from daidalos.nodes.navigation_extensions import ExtensionMaker
from daidalos.nodes.parameters import declare
from daidalos.nodes.warming import warm_up_in_background
from daidalos.samples.fields import time_message


class UnknownPlanner(NavigationError):
    """There is no planner of that name."""

    code = "INVALID_PLANNER"


class NoGoals(NavigationError):
    """There are no poses to plan through."""

    code = "NO_VIAPOINTS_GIVEN"


@dataclass(frozen=True)
class PlannerServerParameters(Parameters):
    """Parameters of the node, by their Nav2 names."""

    planner_plugins: tuple[str, ...] = parameter(
        ("GridBased",), "Names of the planners.", not_empty=True, unique=True, read_only=True
    )
    expected_planner_frequency: float = parameter(
        1.0, "Plans per second below which a warning is logged; 0 for none.", unit="Hz", minimum=0.0
    )
    costmap_update_timeout: float = parameter(1.0, "How long to wait for the costmap.", unit="s", minimum=0.0)


class PlannerServer(ManagedNode):
    """Server of ``compute_path_to_pose``, ``compute_path_through_poses`` and ``is_path_valid``."""

    def __init__(self, node_name: str = "planner_server", costmap_arguments: Sequence[str] = (), **kwargs: Any) -> None:
        """Create the server; ``costmap_arguments`` are those of ROS for its costmap's node alone."""
        super().__init__(node_name, **kwargs)
        self._settings = declare(self, PlannerServerParameters, reconfigure=self._reconfigure)
        self._costmap = CostmapNode("global_costmap", self, costmap_arguments)
        self._contained = ContainedNode(self._costmap)
        self.add_managed_entity(self._contained)
        self._planners: dict[str, GlobalPlanner] = {}

    def _reconfigure(self, parameters: PlannerServerParameters) -> None:
        """Use another frequency and timeout from the next goal on."""
        self._settings = parameters

    def configure(self) -> None:
        """Make the planners and serve."""
        from nav2_msgs.action import ComputePathThroughPoses, ComputePathToPose
        from nav2_msgs.srv import IsPathValid
        from nav_msgs.msg import Path

        self._planners = {name: self._make_planner(name) for name in self._settings.planner_plugins}
        kinds = map(type, self._planners.values())
        self._compiled = warm_up_in_background("daidalos.navigation", self.get_logger(), kinds)
        self._plan_publisher = self.create_publisher(Path, "plan", 1)
        self.serve_action(ComputePathToPose, "compute_path_to_pose", partial(self._compute_path, ComputePathToPose))
        self.serve_action(
            ComputePathThroughPoses, "compute_path_through_poses", partial(self._compute_path, ComputePathThroughPoses)
        )
        self.create_service(IsPathValid, "is_path_valid", self._on_is_path_valid)

    def _make_planner(self, name: str) -> GlobalPlanner:
        maker = ExtensionMaker(self, self._costmap.extension_context)
        return maker.make(PLANNERS, name, "nav2_navfn_planner::NavfnPlanner")

    async def _compute_path(self, action: Any, goal_handle: Any) -> Any:
        result = action.Result()
        await self._compiled
        begun = time.monotonic_ns()
        await self._costmap.until_current(self, self._settings.costmap_update_timeout)
        if not goal_handle.is_active:
            return result
        if goal_handle.is_cancel_requested:
            goal_handle.canceled()
            return result
        try:
            path = self._plan(goal_handle.request, lambda: goal_handle.is_cancel_requested)
        except PlanningCancelled:
            goal_handle.canceled()
            return result
        result.path = path_message(path, self._costmap.global_frame, self.get_clock().now().to_msg())
        took_ns = time.monotonic_ns() - begun
        took = time_message(took_ns)
        result.planning_time.sec, result.planning_time.nanosec = took.sec, took.nanosec
        self._warn_if_slow(took_ns * 1e-9)
        self._plan_publisher.publish(result.path)
        goal_handle.succeed()
        return result

    def _warn_if_slow(self, took: float) -> None:
        frequency = self._settings.expected_planner_frequency
        if took * frequency > 1.0:
            self.get_logger().warning(
                f"planning took {took:.3g} s, longer than expected_planner_frequency {frequency:g} Hz allows"
            )

    def _plan(self, request: Any, is_cancelled: Callable[[], bool]) -> Any:
        name = request.planner_id or next(iter(self._planners))
        planner = self._planners.get(name)
        if planner is None:
            raise UnknownPlanner(f"there is no planner '{name}'; there are: {', '.join(self._planners)}")
        planner.is_cancelled = is_cancelled
        start = self._in_global_frame(request.start) if request.use_start else self._costmap.robot_pose()
        if start is None:
            raise TransformFailed(self._costmap.pose_problem)
        if not hasattr(request, "goals"):
            return planner.create_plan(self._costmap.snapshot(), start, self._in_global_frame(request.goal))
        if not request.goals:
            raise NoGoals("there are no poses to plan through")
        costmap = self._costmap.snapshot()
        parts: list[Any] = []
        for goal in map(self._in_global_frame, request.goals):
            parts.append(planner.create_plan(costmap, start, goal)[int(bool(parts)) :])
            start = goal
        return np.concatenate(parts)

    def _on_is_path_valid(self, request: Any, response: Any) -> Any:
        """Answer whether the rest of a path, from where the robot is, has no obstacle; an empty one is not valid."""
        robot = self._costmap.robot_pose()
        poses = [] if robot is None or self._costmap.layered is None else list(request.path.poses)
        response.is_valid = bool(poses)
        if robot is None or not poses:
            return response
        places = np.array([self._in_global_frame(pose) for pose in poses])
        nearest = int(np.argmin(np.hypot(*(places[:, :2] - robot[:2]).T)))
        checker = FootprintCollisionChecker(self._costmap.snapshot(), self._costmap.footprint)
        costs = [checker.footprint_cost_at(place) for place in places[nearest:]]
        blocked = [
            nearest + index
            for index, cost in enumerate(costs)
            if (request.consider_unknown_as_obstacle if cost == NO_INFORMATION else cost >= request.max_cost)
        ]
        response.is_valid, response.invalid_pose_indices = not blocked, blocked
        return response

    def _in_global_frame(self, stamped: Any) -> Any:
        """Return a stamped pose as (x, y, yaw) in the costmap's frame."""
        frame = stamped.header.frame_id or self._costmap.global_frame
        if frame == self._costmap.global_frame:
            return pose2_of(stamped.pose)
        try:
            found = self._costmap.buffer.lookup_transform(self._costmap.global_frame, frame, Time())
        except TransformException as error:
            raise TransformFailed(f"the goal cannot be brought into {self._costmap.global_frame}: {error}") from None
        return compose(pose2_of_transform(found.transform), pose2_of(stamped.pose))

    def destroy_node(self) -> None:
        """Destroy the node with its costmap."""
        self._contained.destroy()
        super().destroy_node()
