"""Parameters of AMCL's nodes by their Nav2 names."""

from __future__ import annotations

from dataclasses import dataclass

from daidalos.common.parameters import ParameterError, Parameters, group, parameter
from daidalos.localization.config import AmclConfig

_FRAME_OR_TOPIC_FIELDS = ("base_frame_id", "odom_frame_id", "scan_topic", "map_topic")


@dataclass(frozen=True)
class InitialPoseParameters(Parameters):
    """Pose at which the robot is taken to start."""

    x: float = parameter(0.0, "Position in the map.", unit="m")
    y: float = parameter(0.0, "Position in the map.", unit="m")
    z: float = parameter(0.0, "Height in the map; published with the pose.", unit="m")
    yaw: float = parameter(0.0, "Heading in the map.", unit="rad")


@dataclass(frozen=True)
class AmclParameters(AmclConfig):
    """Parameters of the node: those of the filter, and what it listens to and publishes."""

    base_frame_id: str = parameter("base_footprint", "Frame of the robot's base.", not_empty=True)
    odom_frame_id: str = parameter("odom", "Frame of the odometry.", not_empty=True)
    global_frame_id: str = parameter("map", "Frame of the map.", not_empty=True)
    scan_topic: str = parameter("scan", "Topic of the scans.", not_empty=True)
    map_topic: str = parameter("map", "Topic of the map.", not_empty=True)
    first_map_only: bool = parameter(False, "Whether maps after the first are ignored.")
    tf_broadcast: bool = parameter(True, "Whether the transform from the map to the odometry is published.")
    transform_tolerance: float = parameter(
        1.0, "How far ahead of the scan the transform is stamped.", unit="s", minimum=0.0
    )
    set_initial_pose: bool = parameter(False, "Whether the initial pose is taken from the parameters.")
    initial_pose: InitialPoseParameters = group(InitialPoseParameters)
    always_reset_initial_pose: bool = parameter(
        False, "Whether the last pose is forgotten when the node is configured again."
    )
    initialize_at_saved_pose: bool = parameter(
        False, "Whether the pose is saved to a file, and the initial pose taken from there.", read_only=True
    )
    saved_pose_filepath: str = parameter(
        "", "That file; amcl_saved_pose in the folder of logs where empty.", read_only=True
    )
    save_pose_rate: float = parameter(
        0.5, "How often the pose is saved; 0 or less for never.", unit="Hz", read_only=True
    )

    def check(self) -> None:
        """Refuse frames that are one and the same."""
        super().check()
        if self.odom_frame_id == self.global_frame_id:
            raise ParameterError("odom_frame_id", f"must differ from global_frame_id, got '{self.odom_frame_id}' twice")


def listens_elsewhere(before: AmclParameters, after: AmclParameters) -> bool:
    """Return whether a change of parameters asks for other topics or frames."""
    return any(getattr(before, name) != getattr(after, name) for name in _FRAME_OR_TOPIC_FIELDS)


WITHOUT_EFFECT = {
    "allow_parameter_qos_overrides": "qualities of service follow qos_overrides wherever these are given",
    "introspection_mode": "services are not introspected",
    "service_introspection_mode": "services are not introspected",
    "bond_heartbeat_period": "there are no bonds; the lifecycle manager asks for states",
}
"""Parameters of some of Nav2's releases that do nothing here, with the reason."""
