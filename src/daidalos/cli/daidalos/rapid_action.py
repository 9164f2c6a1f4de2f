"""`daidalos rapid run --sim`: the arm's plan, sent to a controller of joint trajectories while the program runs."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from types import TracebackType
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from daidalos.common.errors import UserError

if TYPE_CHECKING:
    from rclpy.node import Node

    from daidalos.industry.rapid.runtime.arm_robot import ArmRobot

ACTION = "/joint_trajectory_controller/follow_joint_trajectory"
JOINTS = tuple(f"joint_{number}" for number in range(1, 7))
PERIOD_S = 0.01
"""Seconds between two points of a trajectory."""

DELAY_S = 0.15
"""Seconds by which the controller is behind the program: time for a changed plan to arrive."""

WAIT_S = 20.0
_START_SPEED = 0.3
_NEAR = 1e-3
_AT_REST = 1e-6
"""Speed up to which an arm stands [rad/s]."""


class Follower:
    """Client of a FollowJointTrajectory action that follows a plan; also the pace of the program.

    Parameters
    ----------
    action
        Name of the action.
    use_sim_time
        Whether the program runs at the pace of /clock.
    """

    def __init__(self, action: str, use_sim_time: bool) -> None:
        import rclpy
        from control_msgs.action import FollowJointTrajectory
        from rclpy.action import ActionClient
        from rclpy.executors import SingleThreadedExecutor
        from rclpy.parameter import Parameter
        from sensor_msgs.msg import JointState

        rclpy.init(args=[])
        parameters: list[Parameter[Any]] = [Parameter("use_sim_time", value=use_sim_time)]
        self._node = rclpy.create_node("rapid_program", parameter_overrides=parameters)
        self._client = ActionClient(self._node, FollowJointTrajectory, action)
        self._action = action
        self._joints: dict[str, float] = {}
        self.listeners: list[Callable[[np.ndarray], None]] = []
        """Called with the angles (6,) [rad] of each state of the joints, in another thread."""
        self._node.create_subscription(JointState, "/joint_states", self._on_joints, 1000)
        self._executor = SingleThreadedExecutor()
        self._executor.add_node(self._node)
        self._thread = threading.Thread(target=self._spin, daemon=True)
        self._thread.start()
        self._robot: ArmRobot | None = None
        self._start_ns = 0
        self._robot_time = 0.0
        self._seen = -1
        self._failure = ""
        self._result: Any = None

    def __enter__(self) -> Self:
        """Return the follower."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        """End the node."""
        import rclpy

        rclpy.try_shutdown()
        self._thread.join(5.0)

    def _spin(self) -> None:
        from rclpy.executors import ExternalShutdownException

        try:
            self._executor.spin()
        except ExternalShutdownException:
            return

    def _on_joints(self, message: Any) -> None:
        self._joints = dict(zip(message.name, message.position, strict=False))
        if self.listeners and all(name in self._joints for name in JOINTS):
            angles = np.array([self._joints[name] for name in JOINTS])
            for listener in self.listeners:
                listener(angles)

    @property
    def node(self) -> Node:
        """Return the node, which another thread spins."""
        return self._node

    def positions(self) -> np.ndarray:
        """Return the present angles (6,) [rad].

        Raises
        ------
        UserError
            Where there is no such action, or nobody publishes the joints.
        """
        if not self._client.wait_for_server(timeout_sec=WAIT_S):
            raise UserError(
                f"there is no action {self._action}; start an arm: ros2 launch irb120_description bringup.launch.py"
            )
        self._wait(lambda: all(name in self._joints for name in JOINTS), "/joint_states with joint_1 to joint_6")
        self._wait(lambda: self._now_ns() > 0, "/clock")
        return np.array([self._joints[name] for name in JOINTS])

    def _wait(self, holds: Callable[[], bool], what: str) -> None:
        end = time.monotonic() + WAIT_S
        while not holds():
            if time.monotonic() > end:
                raise UserError(f"waited {WAIT_S:g} s for {what}")
            time.sleep(0.02)

    def _now_ns(self) -> int:
        return int(self._node.get_clock().now().nanoseconds)

    def start(self, robot: ArmRobot, present: np.ndarray) -> None:
        """Bring the arm to where the program begins, and let the program's time begin."""
        goal = robot.planner.joints
        way = float(np.abs(goal - present).max())
        if way > _NEAR:
            duration = max(2.0 * way / _START_SPEED, 1.0)
            self._send([0.0, duration], np.stack([present, goal]), np.zeros((2, 6)), self._now_ns())
            self._wait_until(self._now_ns() + int(duration * 1e9))
        self._robot = robot
        self._start_ns = self._now_ns() + int(DELAY_S * 1e9)

    def __call__(self, seconds: float) -> None:
        """Send the plan where it has changed, and return when the program's time has passed."""
        robot = self._robot
        assert robot is not None
        remaining = robot.planner.braking()
        if robot.planner.version != self._seen:
            self._seen = robot.planner.version
            self._send_plan(robot, remaining)
        self._robot_time += seconds
        self._wait_until(self._due_ns())
        if self._failure:
            raise UserError(self._failure)

    def _due_ns(self) -> int:
        """Return the time at which the program has come as far as it has."""
        return self._start_ns - int(DELAY_S * 1e9) + int(self._robot_time * 1e9)

    def finish(self) -> None:
        """Wait until the controller has come to the end of the plan."""
        self._wait_until(self._start_ns + int(self._robot_time * 1e9))
        if self._result is not None:
            end = time.monotonic() + WAIT_S
            while not self._result.done() and time.monotonic() < end:
                time.sleep(0.02)
        if self._failure:
            raise UserError(self._failure)

    def _wait_until(self, time_ns: int) -> None:
        import rclpy

        while self._now_ns() < time_ns and rclpy.ok():
            time.sleep(min(max((time_ns - self._now_ns()) * 1e-9, 0.001), 0.02))

    def _send_plan(self, robot: ArmRobot, remaining: float) -> None:
        """Send what the arm does from shortly before now to the end of the plan."""
        now = robot.planner.now
        ahead = now + np.linspace(0.0, remaining, max(2, int(np.ceil(remaining / PERIOD_S)) + 1))
        joints, speeds, _ = robot.planner.motion_at(ahead)
        late = self._now_ns() - self._due_ns()
        if late > 0 and not np.abs(speeds[0]).max() > _AT_REST:
            self._start_ns += late  # planning took that long while the arm stood
        past = [one for one in robot.samples if one.times[-1] > now - 2.0 * DELAY_S]
        times = np.concatenate([*(one.times for one in past), ahead])
        joints = np.concatenate([*(one.joints for one in past), joints])
        speeds = np.concatenate([*(one.speeds for one in past), speeds])
        robot.samples[:] = past
        keep = np.concatenate([[True], np.diff(np.maximum.accumulate(times)) > 1e-4])
        start = float(times[0])
        self._send(times[keep] - start, joints[keep], speeds[keep], self._start_ns + int(start * 1e9))

    def _send(self, times: Any, joints: np.ndarray, speeds: np.ndarray, start_ns: int) -> None:
        from control_msgs.action import FollowJointTrajectory
        from rclpy.duration import Duration
        from rclpy.time import Time
        from trajectory_msgs.msg import JointTrajectoryPoint

        goal = FollowJointTrajectory.Goal()
        goal.trajectory.header.stamp = Time(nanoseconds=start_ns).to_msg()
        goal.trajectory.joint_names = list(JOINTS)
        goal.trajectory.points = [
            JointTrajectoryPoint(
                positions=position.tolist(),
                velocities=speed.tolist(),
                time_from_start=Duration(nanoseconds=int(one * 1e9)).to_msg(),
            )
            for one, position, speed in zip(times, joints, speeds, strict=True)
        ]
        self._client.send_goal_async(goal).add_done_callback(self._on_answer)

    def _on_answer(self, future: Any) -> None:
        handle = future.result()
        if not handle.accepted:
            self._failure = f"{self._action} refuses the trajectory"
            return
        self._result = handle.get_result_async()
        self._result.add_done_callback(self._on_result)

    def _on_result(self, future: Any) -> None:
        result = future.result().result
        if result.error_code in (result.PATH_TOLERANCE_VIOLATED, result.GOAL_TOLERANCE_VIOLATED):
            self._failure = f"{self._action} has stopped: {result.error_string or result.error_code}"
