"""Scorers of the headings at the start and at the goal."""

import math
from dataclasses import dataclass

from daidalos.common.arrays import Array
from daidalos.common.parameters import Parameters, parameter
from daidalos.common.pose2 import wrap
from daidalos.navigation.errors import InvalidScorerUse
from daidalos.navigation.routes.contracts import EdgeScorer, RouteRequest
from daidalos.navigation.routes.graph import GraphEdge


@dataclass(frozen=True)
class OrientationScorerParameters(Parameters):
    """Parameters of the scorers, by their Nav2 names."""

    orientation_weight: float = parameter(1.0, "Cost of a radian.", minimum=0.0)
    use_orientation_threshold: bool = parameter(False, "Whether edges that differ by more are closed.")
    orientation_tolerance: float = parameter(math.pi / 2, "Largest allowed difference.", unit="rad", minimum=0.0)


class StartPoseOrientationScorer(EdgeScorer):
    """Scorer of the angle between the first edge and the heading of the start."""

    names = ("nav2_route::StartPoseOrientationScorer",)
    Parameters = OrientationScorerParameters
    parameters: OrientationScorerParameters

    def score(self, edge: GraphEdge, request: RouteRequest) -> float | None:
        """Implement `EdgeScorer.score`."""
        return _score(self.parameters, edge, request.start_pose, edge.start is request.start, "start")


class GoalOrientationScorer(EdgeScorer):
    """Scorer of the angle between the last edge and the heading of the goal."""

    names = ("nav2_route::GoalOrientationScorer", "nav2_route::GoalPoseOrientationScorer")
    Parameters = OrientationScorerParameters
    parameters: OrientationScorerParameters

    def score(self, edge: GraphEdge, request: RouteRequest) -> float | None:
        """Implement `EdgeScorer.score`."""
        return _score(self.parameters, edge, request.goal_pose, edge.end is request.goal, "goal")


def _score(
    p: OrientationScorerParameters, edge: GraphEdge, pose: Array | None, is_concerned: bool, what: str
) -> float | None:
    if pose is None:
        raise InvalidScorerUse(f"the orientation of the {what} is scored, but the request has nodes, not poses")
    if not is_concerned:
        return 0.0
    angle = abs(float(wrap(edge.heading - pose[2])))
    if p.use_orientation_threshold and angle > p.orientation_tolerance:
        return None
    return p.orientation_weight * angle
