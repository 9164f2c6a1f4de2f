"""Client of YuMi's two trajectory controllers and two gripper controllers, which plans and carries out movements."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import rclpy
from control_msgs.action import FollowJointTrajectory, GripperCommand
from numpy.typing import NDArray
from rclpy.action import ActionClient
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.time import Time
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectoryPoint

from daidalos.common.errors import UserError
from daidalos.industry.motion.two_arms import TimedPath, TwoArmFault, TwoArms
from daidalos.industry.robots.yumi import GRIPPER_LENGTH, YUMI

Array = NDArray[np.float64]

SIDES = tuple(YUMI.bases)
OPEN = 0.022
"""Position of a finger with the gripper open [m]."""

_WAIT_S = 30.0
_LEAD_S = 0.1
"""Time from sending a trajectory to its beginning [s], so that both controllers begin at the same instant."""

_LATE_S = 10.0
_HELD = 0.003
"""Position of a finger [m] below which the gripper has closed on nothing."""

_FORCE = 20.0


def joint_names(side: str) -> list[str]:
    """Return the names of an arm's joints from the base on."""
    return [f"yumi_joint_{number}_{side[0]}" for number in YUMI.arm.numbers]


def pose_above(x: float, y: float, z: float, yaw: float) -> Array:
    """Return a pose (4, 4) of a gripper that points down, with its fingers along y turned by a yaw [rad]."""
    cosine, sine = np.cos(yaw), np.sin(yaw)
    return np.array([[cosine, sine, 0.0, x], [sine, -cosine, 0.0, y], [0.0, 0.0, -1.0, z], [0.0, 0.0, 0.0, 1.0]])


class TwoArmClient(Node):
    """Node that moves YuMi's arms and grippers, one movement after the other.

    A movement returns once the controllers have reported success. Whatever fails raises a `UserError`.
    """

    def __init__(self, speed: float = 0.3) -> None:
        super().__init__("two_arms", automatically_declare_parameters_from_overrides=True)
        tool = np.eye(4)
        tool[2, 3] = GRIPPER_LENGTH
        self.planner = TwoArms(YUMI, dict.fromkeys(SIDES, tool))
        self._speed = speed
        self._states: dict[str, float] = {}
        self.create_subscription(JointState, "/joint_states", self._on_states, 10)
        self._arms = {side: ActionClient(self, FollowJointTrajectory, _arm_action(side)) for side in SIDES}
        self._grippers = {side: ActionClient(self, GripperCommand, _gripper_action(side)) for side in SIDES}

    def _on_states(self, message: JointState) -> None:
        self._states.update(zip(message.name, message.position, strict=False))

    def connect(self) -> None:
        """Wait for the controllers and the joint states."""
        for side in SIDES:
            for client, name in ((self._arms[side], _arm_action(side)), (self._grippers[side], _gripper_action(side))):
                if not client.wait_for_server(timeout_sec=_WAIT_S):
                    start = "ros2 launch irb14000_description bringup.launch.py"
                    raise UserError(f"there is no action {name}; start the robot: {start}")
        names = [name for side in SIDES for name in joint_names(side)]
        end = self._now() + _WAIT_S
        while not all(name in self._states for name in names):
            if self._now() > end:
                raise UserError("/joint_states has not named all joints of both arms")
            rclpy.spin_once(self, timeout_sec=0.1)

    def _now(self) -> float:
        return float(self.get_clock().now().nanoseconds) * 1e-9

    @property
    def joints(self) -> Array:
        """Return the latest angles (2, 7) [rad]."""
        return np.array([[self._states[name] for name in joint_names(side)] for side in SIDES])

    def go(self, targets: Mapping[str, Array], then: Mapping[str, Array] | None = None) -> None:
        """Move grippers to poses in the body by any way that keeps the links apart; `then` is where they go next."""
        start = self._present()
        self._follow(self._plan(lambda: self.planner.free(start, self.planner.position_at(start, targets, then))))

    def go_home(self, side: str, home: Array) -> None:
        """Move one arm to angles (7,) [rad]."""
        start = self._present()
        goal = start.copy()
        goal[SIDES.index(side)] = home
        self._follow(self._plan(lambda: self.planner.free(start, goal)))

    def go_straight(self, targets: Mapping[str, Array]) -> None:
        """Move grippers straight to poses in the body, in step with each other."""
        start = self._present()
        self._follow(self._plan(lambda: self.planner.straight(start, targets)))

    def grip(self, *sides: str) -> None:
        """Close grippers on an object; fail where there is none."""
        for side, position in self._move_grippers(sides, 0.0).items():
            if position < _HELD:
                raise UserError(f"the {side} gripper has closed on nothing")

    def release(self, *sides: str) -> None:
        """Open grippers."""
        self._move_grippers(sides, OPEN)

    def _present(self) -> Array:
        """Return the present angles, from a state that is newer than the last movement."""
        self._states.clear()
        names = [name for side in SIDES for name in joint_names(side)]
        end = self._now() + _LATE_S
        while not all(name in self._states for name in names):
            if self._now() > end:
                raise UserError(f"no /joint_states for {_LATE_S:g} s")
            rclpy.spin_once(self, timeout_sec=0.1)
        return self.joints

    def _plan(self, path: Any) -> TimedPath:
        try:
            return self.planner.timed(path(), self._speed)
        except TwoArmFault as fault:
            raise UserError(str(fault)) from None

    def _follow(self, path: TimedPath) -> None:
        """Send a path to both controllers with the same beginning, and wait until both have reached its end."""
        start = Time(nanoseconds=self.get_clock().now().nanoseconds + int(_LEAD_S * 1e9)).to_msg()
        results = []
        for number, side in enumerate(SIDES):
            goal = FollowJointTrajectory.Goal()
            goal.trajectory.header.stamp = start
            goal.trajectory.joint_names = joint_names(side)
            goal.trajectory.points = [
                JointTrajectoryPoint(
                    positions=position.tolist(),
                    velocities=velocity.tolist(),
                    time_from_start=Duration(nanoseconds=int(time * 1e9)).to_msg(),
                )
                for time, position, velocity in zip(
                    path.times, path.positions[:, number], path.velocities[:, number], strict=True
                )
            ]
            results.append((side, self._result(self._arms[side], goal, f"the {side} arm's controller")))
        for side, future in results:
            answer = self._wait(future, float(path.times[-1]) + _LATE_S, f"the {side} arm").result
            if answer.error_code != answer.SUCCESSFUL:
                raise UserError(f"the {side} arm has stopped: {answer.error_string or answer.error_code}")

    def _move_grippers(self, sides: tuple[str, ...], position: float) -> dict[str, float]:
        """Move grippers, and return where their fingers are."""
        goal = GripperCommand.Goal()
        goal.command.position, goal.command.max_effort = position, _FORCE
        futures = {side: self._result(self._grippers[side], goal, f"the {side} gripper") for side in sides}
        found = {}
        for side, future in futures.items():
            answer = self._wait(future, _LATE_S, f"the {side} gripper").result
            if not (answer.reached_goal or answer.stalled):
                raise UserError(f"the {side} gripper has not moved to {1e3 * position:g} mm")
            found[side] = float(answer.position)
        return found

    def _result(self, client: Any, goal: Any, who: str) -> Any:
        handle = self._wait(client.send_goal_async(goal), _LATE_S, who)
        if not handle.accepted:
            raise UserError(f"{who} refuses the goal")
        return handle.get_result_async()

    def _wait(self, future: Any, seconds: float, who: str) -> Any:
        rclpy.spin_until_future_complete(self, future, timeout_sec=seconds)
        if not future.done():
            raise UserError(f"{who} does not answer")
        return future.result()


def _arm_action(side: str) -> str:
    return f"/{side}_arm_controller/follow_joint_trajectory"


def _gripper_action(side: str) -> str:
    return f"/{side}_gripper_controller/gripper_cmd"
