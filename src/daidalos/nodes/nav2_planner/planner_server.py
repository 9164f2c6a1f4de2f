"""`planner_server`: plans paths over the global costmap."""

from __future__ import annotations

import sys
import time
from typing import Any

from rclpy.action import ActionServer, CancelResponse
from rclpy.lifecycle import LifecycleNode, LifecycleState, TransitionCallbackReturn
from rclpy.time import Time
from tf2_ros import TransformException

from daidalos.common.pose2 import compose
from daidalos.navigation.errors import NavigationError
from daidalos.navigation.planners.planner import GlobalPlanner
from daidalos.navigation.plugins import find_plugin
from daidalos.nodes.action_results import TransformFailed, set_error
from daidalos.nodes.conversions import path_message, pose2_of, pose2_of_transform, time_message
from daidalos.nodes.nav2_costmap_2d._costmap_node import CostmapNode
from daidalos.nodes.node_thread import NodeThread
from daidalos.nodes.parameters import declare_plugin
from daidalos.nodes.runner import run


class UnknownPlanner(NavigationError):
    """There is no planner of that name."""

    code = "INVALID_PLANNER"


class PlannerServer(LifecycleNode):
    """Serves ``compute_path_to_pose``; parameters are Nav2's."""

    def __init__(self, node_name: str = "planner_server", **kwargs: Any) -> None:
        super().__init__(node_name, **kwargs)
        self.declare_parameter("planner_plugins", ["GridBased"])
        self.declare_parameter("expected_planner_frequency", 1.0)
        self.declare_parameter("costmap_update_timeout", 1.0)
        self._costmap = CostmapNode("global_costmap", self)
        self._costmap_thread = NodeThread(self._costmap)
        self._planners: dict[str, GlobalPlanner] = {}

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Make the planners and serve."""
        from nav2_msgs.action import ComputePathToPose
        from nav_msgs.msg import Path

        self._costmap.trigger_configure()
        for name in self.get_parameter("planner_plugins").value:
            kind = self.declare_parameter(f"{name}.plugin", "nav2_navfn_planner::NavfnPlanner").value
            plugin = find_plugin(kind)
            self._planners[name] = plugin.made_by(declare_plugin(self, plugin, name))
        self._plan_publisher = self.create_publisher(Path, "plan", 1)
        self._server = ActionServer(
            self,
            ComputePathToPose,
            "compute_path_to_pose",
            self._compute_path,
            cancel_callback=lambda goal: CancelResponse.ACCEPT,
        )
        return super().on_configure(state)

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Let the costmap be updated."""
        self._costmap.trigger_activate()
        return super().on_activate(state)

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Let the costmap rest."""
        self._costmap.trigger_deactivate()
        return super().on_deactivate(state)

    async def _compute_path(self, goal_handle: Any) -> Any:
        from nav2_msgs.action import ComputePathToPose

        result = ComputePathToPose.Result()
        begun = time.monotonic_ns()
        request = goal_handle.request
        try:
            path = await self._plan(request)
        except NavigationError as error:
            self.get_logger().warning(f"no path: {error}")
            goal_handle.abort()
            return set_error(result, error)
        result.path = path_message(path, self._costmap.global_frame, self.get_clock().now().to_msg())
        took = time_message(time.monotonic_ns() - begun)
        result.planning_time.sec, result.planning_time.nanosec = took.sec, took.nanosec
        self._plan_publisher.publish(result.path)
        goal_handle.succeed()
        return result

    async def _plan(self, request: Any) -> Any:
        name = request.planner_id or next(iter(self._planners))
        planner = self._planners.get(name)
        if planner is None:
            raise UnknownPlanner(f"there is no planner '{name}'; there are: {', '.join(self._planners)}")
        await self._costmap.until_current(self, self.get_parameter("costmap_update_timeout").value)
        start = self._in_global_frame(request.start) if request.use_start else self._costmap.robot_pose()
        if start is None:
            raise TransformFailed("the robot's place on the map is not known")
        goal = self._in_global_frame(request.goal)
        return planner.create_plan(self._costmap.snapshot(), start, goal)

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
        """Leave the graph with the costmap."""
        self._costmap_thread.stop()
        self._costmap.destroy_node()
        super().destroy_node()


def main() -> int:
    """Run the node."""
    return run(PlannerServer)


if __name__ == "__main__":
    sys.exit(main())
