"""Path handler of plans that the robot can drive as they are, with their cusps and turns in place."""

import math
from dataclasses import dataclass

from daidalos.common.arrays import Array
from daidalos.common.parameters import Parameters, parameter
from daidalos.navigation.contracts import PathHandler
from daidalos.navigation.errors import InvalidPath


@dataclass(frozen=True)
class FeasiblePathHandlerParameters(Parameters):
    """Parameters of the path handler, by their Nav2 names."""

    prune_distance: float = parameter(2.0, "Length of path ahead that the controller sees.", unit="m", above=0.0)
    max_robot_pose_search_dist: float = parameter(
        1.5, "How far along the path the robot may have got since the last cycle.", unit="m", above=0.0
    )
    enforce_path_inversion: bool = parameter(False, "Whether the robot drives to the cusps of the path.")
    enforce_path_rotation: bool = parameter(False, "Whether the robot makes the path's turns in place.")
    inversion_xy_tolerance: float = parameter(
        0.2, "Distance of a cusp or turn at which it is reached.", unit="m", minimum=0.0
    )
    inversion_yaw_tolerance: float = parameter(
        0.4, "Angle at which a cusp or turn is reached.", unit="rad", minimum=0.0
    )
    minimum_rotation_angle: float = parameter(
        0.785, "Angle from which on a turn in place is one.", unit="rad", above=0.0
    )
    reject_unit_path: bool = parameter(False, "Whether a path of a single pose is refused.")


class FeasiblePathHandler(PathHandler):
    """Path handler that shows a distance of the path, up to the next cusp or turn in place if they are enforced."""

    names = ("nav2_controller::FeasiblePathHandler",)
    Parameters = FeasiblePathHandlerParameters
    parameters: FeasiblePathHandlerParameters

    @property
    def look_ahead(self) -> float:
        """Implement `PathHandler.look_ahead`."""
        return self.parameters.prune_distance

    @property
    def search_distance(self) -> float:
        """Implement `PathHandler.search_distance`."""
        return self.parameters.max_robot_pose_search_dist

    @property
    def sees_past_cusps(self) -> bool:
        """Implement `PathHandler.sees_past_cusps`."""
        return not self.parameters.enforce_path_inversion

    @property
    def rotation_angle(self) -> float:
        """Implement `PathHandler.rotation_angle`."""
        p = self.parameters
        return p.minimum_rotation_angle if p.enforce_path_rotation else math.inf

    @property
    def tolerances(self) -> tuple[float, float]:
        """Implement `PathHandler.tolerances`."""
        return self.parameters.inversion_xy_tolerance, self.parameters.inversion_yaw_tolerance

    def check(self, plan: Array) -> None:
        """Implement `PathHandler.check`."""
        if self.parameters.reject_unit_path and plan.shape[0] == 1:
            raise InvalidPath("a path of a single pose is refused (reject_unit_path)")
