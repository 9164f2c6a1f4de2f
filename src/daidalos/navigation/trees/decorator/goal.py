"""Decorators that look at the goal."""

from collections.abc import Iterator
from typing import Any, ClassVar

from py_trees.common import Status

from daidalos.navigation.trees.condition.goal_updated import GOALS, GoalWatch
from daidalos.navigation.trees.node import Decorator, Port, Ports, TreeContext, entry


class GoalUpdatedController(Decorator):
    """Decorator that ticks its child at first, when the goal is another, and while the child runs."""

    names = ("GoalUpdatedController",)
    PORTS: ClassVar[dict[str, Port]] = GOALS

    def __init__(self, ports: Ports, context: TreeContext) -> None:
        super().__init__(ports, context)
        self._goals = GoalWatch(ports)

    def tick(self) -> Iterator[Any]:
        """Tick the child if it is due."""
        if self.status == Status.INVALID:
            self._goals.reset()
        if self._goals.has_changed(first=True) or self.decorated.status == Status.RUNNING:
            yield from self.decorated.tick()
            self.status = self.decorated.status
        else:
            self.status = Status.RUNNING
        yield self


class GoalUpdater(Decorator):
    """Decorator that replaces the goal by newer ones that come on ``goal_update``, then ticks its child."""

    names = ("GoalUpdater",)
    PORTS: ClassVar[dict[str, Port]] = {
        "input_goal": Port(entry, None),
        "input_goals": Port(entry, None),
        "goal_updater_topic": Port(str, "goal_update"),
        "output_goal": Port(entry, output=True),
        "output_goals": Port(entry, output=True),
    }

    def tick(self) -> Iterator[Any]:
        """Output the newest goal, and tick the child."""
        goal = self.ports.get("input_goal")
        newer = self.services.latest(self.ports.get("goal_updater_topic"), "geometry_msgs/msg/PoseStamped")
        if newer is not None and (goal is None or _time(newer) >= _time(goal)):
            goal = newer
        if goal is not None:
            self.ports.set("output_goal", goal)
        goals = self.ports.get("input_goals")
        if goals is not None:
            self.ports.set("output_goals", goals)
        yield from self.decorated.tick()
        self.status = self.decorated.status
        yield self


def _time(pose: Any) -> tuple[int, int]:
    return pose.header.stamp.sec, pose.header.stamp.nanosec
