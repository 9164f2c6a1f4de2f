"""Task that waits at each waypoint."""

from dataclasses import dataclass

from daidalos.common.arrays import Array
from daidalos.common.parameters import Parameters, parameter
from daidalos.navigation.contracts import WaypointTask


@dataclass(frozen=True)
class WaitAtWaypointParameters(Parameters):
    """Parameters of the task, by their Nav2 names."""

    enabled: bool = parameter(True, "Whether the robot waits.")
    waypoint_pause_duration: int = parameter(0, "How long it waits.", unit="ms", minimum=0)


class WaitAtWaypoint(WaypointTask):
    """Task that waits for a time."""

    names = ("nav2_waypoint_follower::WaitAtWaypoint",)
    Parameters = WaitAtWaypointParameters
    parameters: WaitAtWaypointParameters
    _until = 0.0

    def start(self, index: int, pose: Array, now: float) -> None:
        """Implement `WaypointTask.start`."""
        p = self.parameters
        self._until = now + (1e-3 * p.waypoint_pause_duration if p.enabled else 0.0)

    def step(self, now: float) -> bool:
        """Implement `WaypointTask.step`."""
        return now >= self._until
