"""Parameters of `hector_trajectory_server`."""

from __future__ import annotations

from dataclasses import dataclass

from daidalos.common.parameters import Parameters, parameter


@dataclass(frozen=True)
class TrajectoryServerParameters(Parameters):
    """Parameters of the node, with ROS 1's names and defaults."""

    target_frame_name: str = parameter("map", "Frame in which the way is recorded.", not_empty=True, read_only=True)
    source_frame_name: str = parameter("base_link", "Frame whose way is recorded.", not_empty=True, read_only=True)
    trajectory_update_rate: float = parameter(
        4.0, "How often a pose is recorded.", unit="Hz", above=0.0, takes_integer=True, read_only=True
    )
    trajectory_publish_rate: float = parameter(
        0.25, "How often the path is published.", unit="Hz", above=0.0, takes_integer=True, read_only=True
    )
