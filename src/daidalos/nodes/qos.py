"""Quality of service that nodes share."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
"""Quality of topics whose last message late subscribers get too."""


def matching_qos(publishers: Sequence[Any], depth: int) -> QoSProfile:
    """Return the quality with which a subscription receives from all of some publishers.

    Parameters
    ----------
    publishers : sequence of TopicEndpointInfo
    depth : int
    """
    profiles = [one.qos_profile for one in publishers]
    reliable = all(profile.reliability == ReliabilityPolicy.RELIABLE for profile in profiles)
    latched = all(profile.durability == DurabilityPolicy.TRANSIENT_LOCAL for profile in profiles)
    return QoSProfile(
        depth=depth,
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE,
    )
