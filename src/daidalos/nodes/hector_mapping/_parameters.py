"""Parameters of `hector_mapping`: those that act, and those without effect, each with its reason."""

from __future__ import annotations

from dataclasses import dataclass

from daidalos.common.parameters import ParameterError, parameter
from daidalos.mapping.hector.config import HectorConfig

_DEBUGGING = "there are no drawings and messages of the single iterations"

WITHOUT_EFFECT = {
    "pub_drawings": _DEBUGGING,
    "pub_debug_output": _DEBUGGING,
}
"""Parameters that do nothing here, with the reason."""


@dataclass(frozen=True)
class HectorMappingParameters(HectorConfig):
    """Parameters of the node, with ROS 1's names and defaults."""

    base_frame: str = parameter("base_link", "Frame of the robot's base.", not_empty=True, read_only=True)
    map_frame: str = parameter("map", "Frame of the map.", not_empty=True, read_only=True)
    odom_frame: str = parameter("odom", "Frame of the odometry.", not_empty=True, read_only=True)
    map_pub_period: float = parameter(
        2.0, "How often the map is published.", unit="s", above=0.0, takes_integer=True, read_only=True
    )
    laser_min_dist: float = parameter(
        0.4, "Least distance at which a beam is used.", unit="m", minimum=0.0, takes_integer=True
    )
    laser_max_dist: float = parameter(
        30.0, "Largest distance at which a beam is used.", unit="m", above=0.0, takes_integer=True
    )
    laser_z_min_value: float = parameter(
        -1.0, "Least height over the sensor at which a beam's end is used.", unit="m", takes_integer=True
    )
    laser_z_max_value: float = parameter(
        1.0, "Largest height over the sensor at which a beam's end is used.", unit="m", takes_integer=True
    )
    pub_map_odom_transform: bool = parameter(
        True, "Whether the transform from the map to the odometry is published.", read_only=True
    )
    pub_map_scanmatch_transform: bool = parameter(
        True, "Whether the transform from the map to the matched pose is published.", read_only=True
    )
    tf_map_scanmatch_transform_frame_name: str = parameter(
        "scanmatcher_frame", "Frame of the matched pose.", not_empty=True, read_only=True
    )
    scan_topic: str = parameter("scan", "Topic of the scans.", not_empty=True, read_only=True)
    sys_msg_topic: str = parameter("syscommand", "Topic of commands such as reset.", not_empty=True, read_only=True)
    pose_update_topic: str = parameter(
        "poseupdate", "Topic of the pose with its covariance.", not_empty=True, read_only=True
    )
    scan_subscriber_queue_size: int = parameter(5, "Number of scans that wait.", minimum=1, read_only=True)
    use_tf_scan_transformation: bool = parameter(
        True, "Whether the mounting of the sensor is looked up; else its frame is taken for that of the base.",
        read_only=True,
    )  # fmt: skip
    use_tf_pose_start_estimate: bool = parameter(
        False, "Whether the search begins where the transforms put the robot; else at the pose of the scan before.",
        read_only=True,
    )  # fmt: skip
    map_with_known_poses: bool = parameter(
        False, "Whether scans are drawn where the transforms put the robot, without being matched.", read_only=True
    )
    pub_odometry: bool = parameter(False, "Whether the pose is published on scanmatch_odom.", read_only=True)
    advertise_map_service: bool = parameter(True, "Whether dynamic_map is served.", read_only=True)
    output_timing: bool = parameter(False, "Whether the computing time of each scan is logged.")

    def check(self) -> None:
        """Refuse limits that leave no beam."""
        super().check()
        for low, high in (("laser_min_dist", "laser_max_dist"), ("laser_z_min_value", "laser_z_max_value")):
            if not getattr(self, low) < getattr(self, high):
                raise ParameterError(low, f"must be below {high} ({getattr(self, high):g}), got {getattr(self, low):g}")
