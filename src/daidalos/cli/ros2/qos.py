"""Quality of service of subscriptions and publishers of verbs."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Sequence
from typing import TYPE_CHECKING

from ros2cli.qos import qos_profile_from_short_keys

if TYPE_CHECKING:
    from rclpy.qos import QoSProfile

    from daidalos.transport.graph import EndpointInfo


def requested_qos(args: Namespace) -> QoSProfile | None:
    """Return the profile of the options, None without options."""
    overrides = {
        "depth": args.qos_depth,
        "history": args.qos_history,
        "reliability": args.qos_reliability,
        "durability": args.qos_durability,
        "liveliness": args.qos_liveliness,
    }
    lease = args.qos_liveliness_lease_duration_seconds
    if args.qos_profile is None and lease is None and all(value is None for value in overrides.values()):
        return None
    return qos_profile_from_short_keys(
        args.qos_profile or args._qos_preset, **overrides, liveliness_lease_duration_s=lease
    )


def qos_for_publishers(publishers: Sequence[EndpointInfo]) -> QoSProfile:
    """Return the strictest profile compatible with all publishers; print a hint if some offer more."""
    reliable = sum(one.qos.reliable for one in publishers)
    latched = sum(one.qos.transient_local for one in publishers)
    count = len(publishers)
    if 0 < reliable < count:
        print(
            "Some, but not all, publishers are offering QoSReliabilityPolicy.RELIABLE. Falling back to "
            "QoSReliabilityPolicy.BEST_EFFORT as it will connect to all publishers"
        )
    if 0 < latched < count:
        print(
            "Some, but not all, publishers are offering QoSDurabilityPolicy.TRANSIENT_LOCAL. Falling back to "
            "QoSDurabilityPolicy.VOLATILE as it will connect to all publishers"
        )
    depth = max((one.qos.depth for one in publishers if one.qos.transient_local), default=1)
    return qos_profile_from_short_keys(
        "sensor_data" if reliable < count else "default",
        reliability="reliable" if count and reliable == count else "best_effort",
        durability="transient_local" if count and latched == count else "volatile",
        depth=max(depth, 10),
    )
