"""Task that waits for a message at each waypoint."""

from dataclasses import dataclass

from daidalos.common.arrays import Array
from daidalos.common.parameters import Parameters, parameter
from daidalos.navigation.contracts import Input, WaypointTask
from daidalos.navigation.errors import TaskFailed


@dataclass(frozen=True)
class InputAtWaypointParameters(Parameters):
    """Parameters of the task, by their Nav2 names."""

    enabled: bool = parameter(True, "Whether the robot waits for a message.")
    timeout: float = parameter(10.0, "How long it waits.", unit="s", minimum=0.0)
    input_topic: str = parameter("input_at_waypoint/input", "Topic of the message.", not_empty=True, read_only=True)


class InputAtWaypoint(WaypointTask):
    """Task that is done when an empty message comes, and fails when none has come in time."""

    names = ("nav2_waypoint_follower::InputAtWaypoint",)
    Parameters = InputAtWaypointParameters
    parameters: InputAtWaypointParameters
    _deadline = 0.0
    _has_come = False

    @property
    def inputs(self) -> tuple[Input, ...]:
        """Implement `WaypointTask.inputs`."""
        return (Input(self.parameters.input_topic, type(None), self.take),)

    def take(self) -> None:
        """Take a message."""
        self._has_come = True

    def start(self, index: int, pose: Array, now: float) -> None:
        """Implement `WaypointTask.start`."""
        self._has_come = False
        self._deadline = now + self.parameters.timeout

    def step(self, now: float) -> bool:
        """Implement `WaypointTask.step`."""
        if self._has_come or not self.parameters.enabled:
            return True
        if now > self._deadline:
            raise TaskFailed(f"nothing came on '{self.parameters.input_topic}' within {self.parameters.timeout:g} s")
        return False
