"""`controller_server`: follows paths over the local costmap."""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.lifecycle import LifecycleNode, LifecycleState, TransitionCallbackReturn
from rclpy.time import Time
from tf2_ros import TransformException

from daidalos.navigation.controllers.follow_path import FollowPath
from daidalos.navigation.errors import NavigationError
from daidalos.nodes.action_results import TransformFailed, set_error
from daidalos.nodes.conversions import path_array, path_message, pose2_of_transform, twist_message
from daidalos.nodes.cycles import Cycle
from daidalos.nodes.nav2_controller._plugins import PluginMaker
from daidalos.nodes.nav2_costmap_2d._costmap_node import CostmapNode
from daidalos.nodes.node_thread import NodeThread
from daidalos.nodes.runner import run


class UnknownController(NavigationError):
    """There is no controller or checker of that name."""

    code = "INVALID_CONTROLLER"


class ControllerServer(LifecycleNode):
    """Serves ``follow_path`` and publishes ``cmd_vel``; parameters are Nav2's."""

    def __init__(self, node_name: str = "controller_server", **kwargs: Any) -> None:
        super().__init__(node_name, **kwargs)
        self._frequency = self.declare_parameter("controller_frequency", 20.0).value
        self._tolerance = self.declare_parameter("failure_tolerance", 0.3).value
        self._stamped = self.declare_parameter("enable_stamped_cmd_vel", False).value
        self.declare_parameter("costmap_update_timeout", 0.3)
        self.declare_parameter("controller_plugins", ["FollowPath"])
        self.declare_parameter("goal_checker_plugins", ["goal_checker"])
        self.declare_parameter("progress_checker_plugins", ["progress_checker"])
        self.declare_parameter("odom_topic", "odom")
        self._costmap = CostmapNode("local_costmap", self)
        self._costmap_thread = NodeThread(self._costmap)
        self._plugins: dict[str, dict[str, Any]] = {}
        self._velocity = np.zeros(3)
        self._current: Any = None

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Make controllers and checkers and serve."""
        from geometry_msgs.msg import Twist, TwistStamped
        from nav2_msgs.action import FollowPath as FollowPathAction
        from nav_msgs.msg import Odometry, Path

        self._costmap.trigger_configure()
        maker = PluginMaker(self, self._costmap.footprint, self._frequency)
        for group, default in (
            ("controller_plugins", "nav2_mppi_controller::MPPIController"),
            ("goal_checker_plugins", "nav2_controller::SimpleGoalChecker"),
            ("progress_checker_plugins", "nav2_controller::SimpleProgressChecker"),
        ):
            names = self.get_parameter(group).value
            self._plugins[group] = {name: maker.make(name, default) for name in names}
        self._command = self.create_publisher(TwistStamped if self._stamped else Twist, "cmd_vel", 1)
        self._local_plan = self.create_publisher(Path, "local_plan", 1)
        self.create_subscription(Odometry, self.get_parameter("odom_topic").value, self._on_odometry, 10)
        self._server = ActionServer(
            self,
            FollowPathAction,
            "follow_path",
            self._follow,
            goal_callback=self._on_goal,
            cancel_callback=lambda goal: CancelResponse.ACCEPT,
        )
        return super().on_configure(state)

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Let the costmap be updated."""
        self._costmap.trigger_activate()
        return super().on_activate(state)

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Stand, and let the costmap rest."""
        self._publish_velocity(np.zeros(3))
        self._costmap.trigger_deactivate()
        return super().on_deactivate(state)

    def _on_odometry(self, message: Any) -> None:
        twist = message.twist.twist
        self._velocity = np.array([twist.linear.x, twist.linear.y, twist.angular.z])

    def _on_goal(self, request: Any) -> GoalResponse:
        return GoalResponse.ACCEPT if self.current_state.label == "active" else GoalResponse.REJECT

    async def _follow(self, goal_handle: Any) -> Any:
        from nav2_msgs.action import FollowPath as FollowPathAction

        result = FollowPathAction.Result()
        previous, self._current = self._current, goal_handle
        try:
            await self._costmap.until_current(self, self.get_parameter("costmap_update_timeout").value)
            task = self._task(goal_handle.request, previous)
            with Cycle(self, self._frequency) as cycle:
                while await self._drive(task, goal_handle):
                    await cycle.next()
        except NavigationError as error:
            self._end(goal_handle)
            self.get_logger().warning(f"following the path failed: {error}")
            goal_handle.abort()
            return set_error(result, error)
        if self._current is not goal_handle:
            goal_handle.abort()  # another path took over; the robot does not stop for that
            result.error_msg = "preempted by another path"
            return result
        self._end(goal_handle)
        goal_handle.canceled() if goal_handle.is_cancel_requested else goal_handle.succeed()
        return result

    def _task(self, request: Any, previous: Any) -> FollowPath:
        """Return the task of a goal; it goes on where a running one with the same plugins is."""
        chosen = (request.controller_id, request.goal_checker_id, request.progress_checker_id)
        path = path_array(request.path)
        if previous is not None and self._chosen == chosen:
            self._following.replan(path, new_goal=self._is_new_goal(path))
        else:
            self._following = FollowPath(
                self._named("controller_plugins", chosen[0]),
                self._named("goal_checker_plugins", chosen[1]),
                self._named("progress_checker_plugins", chosen[2]),
                self._tolerance,
            )
            self._following.start(path)
        self._chosen = chosen
        self._plan_frame = request.path.header.frame_id or self._costmap.global_frame
        self._goal = path[-1]
        return self._following

    _chosen: tuple[str, str, str] | None = None
    _following: FollowPath

    def _is_new_goal(self, path: Any) -> bool:
        return not np.allclose(path[-1], self._goal, atol=1e-3)

    def _named(self, group: str, name: str) -> Any:
        plugins = self._plugins[group]
        found = plugins.get(name or next(iter(plugins)))
        if found is None:
            raise UnknownController(f"there is no '{name}' among {group}: {', '.join(plugins)}")
        return found

    async def _drive(self, task: FollowPath, goal_handle: Any) -> bool:
        """Make one cycle; False when the goal is reached, cancelled or replaced."""
        if goal_handle.is_cancel_requested or self._current is not goal_handle:
            return False
        pose = self._costmap.robot_pose()
        if pose is None:
            raise TransformFailed("the robot's pose in the local costmap is not known")
        with self._costmap.lock:
            layered = self._costmap.layered
            assert layered is not None
            step = task.step(
                pose,
                self._velocity,
                layered.costmap,
                self.get_clock().now().nanoseconds * 1e-9,
                plan_frame=self._plan_frame_pose(),
                circumscribed_cost=layered.circumscribed_cost(self._costmap.footprint),
            )
        self._publish_velocity(step.velocity)
        self._tell(goal_handle, step)
        return not step.done

    def _plan_frame_pose(self) -> Any:
        """Return the pose of the path's frame in the costmap's."""
        if self._plan_frame == self._costmap.global_frame:
            return np.zeros(3)
        try:
            found = self._costmap.buffer.lookup_transform(self._costmap.global_frame, self._plan_frame, Time())
        except TransformException as error:
            raise TransformFailed(str(error)) from None
        return pose2_of_transform(found.transform)

    def _tell(self, goal_handle: Any, step: Any) -> None:
        from nav2_msgs.action import FollowPath as FollowPathAction

        speed = float(np.hypot(*self._velocity[:2]))
        goal_handle.publish_feedback(
            FollowPathAction.Feedback(distance_to_goal=float(step.distance_to_goal), speed=speed)
        )
        if self._local_plan.handle.impl.has_subscribers:
            stamp = self.get_clock().now().to_msg()
            self._local_plan.publish(path_message(step.path, self._costmap.global_frame, stamp))

    def _end(self, goal_handle: Any) -> None:
        if self._current is goal_handle:
            self._current = None
            self._publish_velocity(np.zeros(3))

    def _publish_velocity(self, velocity: Any) -> None:
        frame = self._costmap.base_frame if self._stamped else None
        self._command.publish(twist_message(velocity, frame, self.get_clock().now().to_msg()))

    def destroy_node(self) -> None:
        """Stand, and leave the graph with the costmap."""
        if self._current is not None:
            self._publish_velocity(np.zeros(3))
        self._costmap_thread.stop()
        self._costmap.destroy_node()
        super().destroy_node()


def main() -> int:
    """Run the node."""
    return run(ControllerServer)


if __name__ == "__main__":
    sys.exit(main())
