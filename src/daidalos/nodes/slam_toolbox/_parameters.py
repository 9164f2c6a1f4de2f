"""Parameters of slam_toolbox's nodes: those that act, and those without effect, each with its reason."""

from __future__ import annotations

from dataclasses import dataclass

from daidalos.common.parameters import ParameterError, parameter
from daidalos.mapping.config import SlamConfig

_SOLVER = "poses are solved by a sparse Levenberg-Marquardt of its own, with a Cauchy kernel on loop closures"
_SEARCH = "the search is exact and its result refined to lines, so no grid limits it"

WITHOUT_EFFECT = {
    "solver_plugin": _SOLVER,
    "ceres_linear_solver": _SOLVER,
    "ceres_preconditioner": _SOLVER,
    "ceres_trust_strategy": _SOLVER,
    "ceres_dogleg_type": _SOLVER,
    "ceres_loss_function": _SOLVER,
    "correlation_search_space_resolution": _SEARCH,
    "correlation_search_space_smear_deviation": _SEARCH,
    "loop_search_space_resolution": _SEARCH,
    "loop_search_space_smear_deviation": _SEARCH,
    "fine_search_angle_offset": _SEARCH,
    "coarse_angle_resolution": _SEARCH,
    "minimum_angle_penalty": _SEARCH,
    "minimum_distance_penalty": _SEARCH,
    "loop_match_maximum_variance_coarse": "loop closures are checked by the lines that their points lie on",
    "link_scan_maximum_distance": "a scan is linked to the last one and to the places that it recognizes",
    "stack_size_to_use": "files are written without recursion",
    "mode": "the executable decides whether the node maps or localizes",
}
"""Parameters of slam_toolbox that nothing here needs, and why."""


@dataclass(frozen=True)
class SlamToolboxParameters(SlamConfig):
    """Parameters of the nodes: slam_toolbox's, and those of `SlamConfig`."""

    match_every_scan: bool = parameter(
        True, "Whether the scans in between correct the pose as well, without being added to the map."
    )
    map_frame: str = parameter("map", "Frame of the map.", not_empty=True, read_only=True)
    odom_frame: str = parameter("odom", "Frame of the odometry.", not_empty=True, read_only=True)
    base_frame: str = parameter("base_footprint", "Frame of the robot's base.", not_empty=True, read_only=True)
    scan_topic: str = parameter("/scan", "Topic of the scans.", not_empty=True, read_only=True)
    map_name: str = parameter("map", "Topic of the map.", not_empty=True, read_only=True)
    scan_queue_size: int = parameter(5, "Number of scans that wait.", minimum=1, read_only=True)
    throttle_scans: int = parameter(1, "Of so many scans one is used.", minimum=1)
    map_update_interval: float = parameter(1.0, "How often the map is published.", unit="s", above=0.0, read_only=True)
    transform_publish_period: float = parameter(
        0.02, "How often the transform is published; 0 for never.", unit="s", minimum=0.0, read_only=True
    )
    transform_timeout: float = parameter(0.2, "How far ahead the transform is stamped.", unit="s", minimum=0.0)
    tf_buffer_duration: float = parameter(
        30.0, "How long transforms are kept to look scans up in.", unit="s", above=0.0, read_only=True
    )
    map_file_name: str = parameter("", "Saved pose graph to go on from, without suffix; empty for none.")
    map_start_pose: tuple[float, ...] = parameter(
        (), "Pose (x, y, yaw) of the robot in the saved map.", unit="m, rad", takes_integer=True
    )
    map_start_at_dock: bool = parameter(
        False, "Whether the robot starts where the first scan of the saved map was taken; a start pose goes first."
    )
    use_map_saver: bool = parameter(True, "Whether slam_toolbox/save_map is served.", read_only=True)
    use_lifecycle_manager: bool = parameter(
        False, "Whether a lifecycle manager starts the node; where it is not given the node starts itself.",
        read_only=True,
    )  # fmt: skip
    enable_interactive_mode: bool = parameter(True, "Whether key scans can be moved by hand.", read_only=True)
    position_covariance_scale: float = parameter(
        1.0, "Factor on the covariance of the published position.", minimum=0.0
    )
    yaw_covariance_scale: float = parameter(1.0, "Factor on the covariance of the published heading.", minimum=0.0)
    debug_logging: bool = parameter(False, "Whether messages for debugging are logged.")

    def check(self) -> None:
        """Refuse a start pose that is none."""
        if len(self.map_start_pose) not in (0, 3):
            raise ParameterError("map_start_pose", f"must be [x, y, yaw], got {list(self.map_start_pose)}")


@dataclass(frozen=True)
class MapAndLocalizationParameters(SlamToolboxParameters):
    """Parameters of the node that both maps and localizes."""

    localization_on_configure: bool = parameter(False, "Whether it begins with localization.", read_only=True)
