"""Action node that removes goals that cannot be reached."""

from collections.abc import Mapping
from typing import Any, ClassVar

from daidalos.navigation.trees.action.poses import goals_of
from daidalos.navigation.trees.action_node import ActionNode
from daidalos.navigation.trees.node import Port, entry, flag

_UNKNOWN = 255


class RemoveInCollisionGoals(ActionNode):
    """Action node that removes the goals whose cost is `cost_threshold` or more; it fails where there are no goals."""

    names = ("RemoveInCollisionGoals",)
    INTERFACE = "nav2_msgs/srv/GetCosts"
    SERVER = "/global_costmap/get_cost_global_costmap"
    PORTS: ClassVar[dict[str, Port]] = {
        "input_goals": Port(entry),
        "cost_threshold": Port(float, 254.0),
        "use_footprint": Port(flag, True),
        "consider_unknown_as_obstacle": Port(flag, False),
        "output_goals": Port(entry, output=True),
        "input_waypoint_statuses": Port(entry, None),
        "output_waypoint_statuses": Port(entry, output=True),
        "service_name": Port(str, None),
        "server_timeout": Port(float, None),
    }

    @classmethod
    def goal(cls, inputs: Mapping[str, Any]) -> dict[str, Any]:
        """Implement `ActionNode.goal`."""
        return {"use_footprint": inputs["use_footprint"], "poses": goals_of(inputs.get("input_goals"))}

    @classmethod
    def is_success(cls, response: Any) -> bool:
        """Implement `ActionNode.is_success`."""
        return bool(response.success)

    @classmethod
    def outputs(cls, result: Any) -> dict[str, Any]:
        """Return the costs of the goals."""
        return {"costs": list(result.costs)}

    def initialise(self) -> None:
        """Request the costs of the goals, if there are any."""
        if goals_of(self.ports.get("input_goals")):
            super().initialise()

    def written(self, outputs: Mapping[str, Any]) -> Mapping[str, Any]:
        """Return the goals that stay; the statuses of waypoints are passed on."""
        if "costs" not in outputs:
            return {"output_goals": self.ports.get("input_goals")}
        goals = goals_of(self.ports.get("input_goals"))
        kept = [goal for goal, cost in zip(goals, outputs["costs"], strict=False) if self._is_free(cost)]
        return {"output_goals": kept, "output_waypoint_statuses": self.ports.get("input_waypoint_statuses")}

    def _is_free(self, cost: float) -> bool:
        if cost == _UNKNOWN:
            return not self.ports.get("consider_unknown_as_obstacle")
        return bool(cost < self.ports.get("cost_threshold"))
