"""A robot that drives to goals in lock-step."""

from __future__ import annotations

import math
import threading
from typing import Any

from geometry_msgs.msg import PoseStamped
from nav2_msgs.action import NavigateToPose

from daidalos.testing.scenario import Scenario, ScenarioFailure
from daidalos.testing.worlds import Robot

BLIND_M = 0.3
"""Largest distance [m] that is driven after the last good data."""


class Drive:
    """A robot that drives to a goal.

    Parameters
    ----------
    robot : Robot
    navigate : object
        The action.
    clock : Scenario
    """

    def __init__(self, robot: Robot, navigate: Any, clock: Scenario) -> None:
        self.robot = robot
        self.failure = ""
        self._navigate = navigate
        self._clock = clock

    def start(self, x: float = 2.0, y: float = 0.0, tree: str = "") -> None:
        """Send it to a goal [m], with the file of a behaviour tree or the default one; return when it is on its way."""
        self.send(x, y, tree)
        self.robot.speed.eventually(above=0.3, within=30.0)
        self._clock.sleep(0.5)

    def send(self, x: float, y: float, tree: str = "") -> None:
        """Send it to a goal [m], and return at once."""
        pose = PoseStamped()
        pose.header.frame_id = "map"
        pose.pose.position.x, pose.pose.position.y, pose.pose.orientation.w = x, y, 1.0
        goal = NavigateToPose.Goal(pose=pose, behavior_tree=tree)
        self.failure = ""
        self._thread = threading.Thread(target=self._go, args=(goal,))
        self._thread.start()

    def _go(self, goal: NavigateToPose.Goal) -> None:
        try:
            self._navigate.send_goal(goal, within=90.0)
        except ScenarioFailure as failure:
            self.failure = str(failure)

    def distance_in(self, seconds: float) -> float:
        """Return how far [m] it gets in some time [s]."""
        x, y = self.robot.position.x, self.robot.position.y
        self._clock.sleep(seconds)
        return math.dist((x, y), (self.robot.position.x, self.robot.position.y))

    def end(self) -> str:
        """Return how the goal failed; empty where it was reached."""
        self._thread.join()
        return self.failure
