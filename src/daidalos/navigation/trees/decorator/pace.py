"""Decorators that tick their child now and then: once, by distance, by speed."""

from collections.abc import Iterator
from math import hypot
from typing import Any, ClassVar

from py_trees.common import Status

from daidalos.navigation.trees.condition.goal_updated import GOALS, GoalWatch
from daidalos.navigation.trees.errors import TreeError
from daidalos.navigation.trees.node import Decorator, Port, Ports, TreeContext


class _Paced(Decorator):
    """Decorator that ticks its child while it runs, else when it is due; it runs in between."""

    def tick(self) -> Iterator[Any]:
        """Tick the child if it runs or is due."""
        if self.status == Status.INVALID:
            self._begin()
        if self.decorated.status == Status.RUNNING or self._is_due():
            yield from self.decorated.tick()
            self.status = self.decorated.status
            if self.status == Status.SUCCESS:
                self._done()
        else:
            self.status = Status.RUNNING
        yield self

    def _begin(self) -> None:
        """Start again after a halt."""

    def _is_due(self) -> bool:
        raise NotImplementedError

    def _done(self) -> None:
        """Record that the child has succeeded."""


class SingleTrigger(_Paced):
    """Decorator that ticks its child until it has ended once, and fails afterwards."""

    names = ("SingleTrigger",)

    def _begin(self) -> None:
        self._is_open = True

    def tick(self) -> Iterator[Any]:
        """Tick the child, or fail."""
        if self.status == Status.INVALID:
            self._begin()
        if self._is_open:
            yield from self.decorated.tick()
            self.status = self.decorated.status
            self._is_open = self.status == Status.RUNNING
        else:
            self.status = Status.FAILURE
        yield self


class DistanceController(_Paced):
    """Decorator that ticks its child at first, and after each `distance` [m] that the robot has moved."""

    names = ("DistanceController",)
    PORTS: ClassVar[dict[str, Port]] = {
        "distance": Port(float, 1.0),
        "global_frame": Port(str, ""),
        "robot_base_frame": Port(str, ""),
    }

    def _begin(self) -> None:
        self._from: Any = None

    def _is_due(self) -> bool:
        robot = self._robot()
        if self._from is None or robot is None:
            return self._from is None
        return bool(hypot(*(robot - self._from)[:2]) >= self.ports.get("distance"))

    def _done(self) -> None:
        self._from = self._robot()

    def _robot(self) -> Any:
        return self.services.robot_pose(self.ports.get("global_frame"), self.ports.get("robot_base_frame"))


class SpeedController(_Paced):
    """Decorator that ticks its child at a rate that grows with the robot's speed, and at once for a new goal.

    The rate goes from `min_rate` to `max_rate` [Hz] as the speed does from `min_speed` to `max_speed` [m/s].
    """

    names = ("SpeedController",)
    PORTS: ClassVar[dict[str, Port]] = {
        "min_rate": Port(float, 0.1),
        "max_rate": Port(float, 1.0),
        "min_speed": Port(float, 0.0),
        "max_speed": Port(float, 0.5),
        **GOALS,
    }

    def __init__(self, ports: Ports, context: TreeContext) -> None:
        super().__init__(ports, context)
        rates, speeds = ([ports.get(f"{end}_{kind}") for end in ("min", "max")] for kind in ("rate", "speed"))
        if not 0.0 < rates[0] <= rates[1] or not speeds[0] < speeds[1]:
            raise TreeError(f"{ports.where}: rates must be above 0, and each maximum above its minimum")
        self._goals = GoalWatch(ports)

    def _begin(self) -> None:
        self._last: float | None = None
        self._goals.reset()

    def _is_due(self) -> bool:
        if self._goals.has_changed(first=True) or self._last is None:
            return True
        return not 0.0 <= self.services.now() - self._last < 1.0 / self._rate()

    def _rate(self) -> float:
        get = self.ports.get
        velocity = self.services.velocity()
        speed = 0.0 if velocity is None else hypot(velocity[0], velocity[1])
        share = min(max((speed - get("min_speed")) / (get("max_speed") - get("min_speed")), 0.0), 1.0)
        return float(get("min_rate") + share * (get("max_rate") - get("min_rate")))

    def _done(self) -> None:
        self._last = self.services.now()
