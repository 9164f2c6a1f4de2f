"""Quality of service on the command line."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from collections.abc import Sequence
from enum import Enum
from typing import TYPE_CHECKING, Any

from daidalos.transport.qos import Durability, History, Liveliness, Reliability

if TYPE_CHECKING:
    from rclpy.qos import QoSProfile

    from daidalos.transport.graph import EndpointInfo

_PRESETS = (
    "unknown", "default", "system_default", "sensor_data", "services_default", "parameters", "parameter_events",
    "action_status_default", "best_available",
)  # fmt: skip


def add_qos_arguments(parser: ArgumentParser, purpose: str, preset: str, default: str | None = None) -> None:
    """Declare the options.

    Parameters
    ----------
    parser
        What takes them.
    purpose
        Such as "subscribe with".
    preset
        The profile that the others' values are changed in.
    default
        How the help names what holds where no option is given; `preset` where None.
    """
    parser.set_defaults(_qos_preset=preset)
    parser.add_argument(
        "--qos-profile",
        choices=_PRESETS,
        help=f"Quality of service preset profile to {purpose} (default: {default or preset})",
    )
    parser.add_argument(
        "--qos-depth",
        metavar="N",
        type=int,
        help=f"Queue size setting to {purpose} (overrides depth value of --qos-profile option, default: "
        f"{_value(preset, 'depth')})",
    )
    policies: tuple[tuple[str, type[Enum], str], ...] = (
        ("history", History, "History of samples setting"),
        ("reliability", Reliability, "Quality of service reliability setting"),
        ("durability", Durability, "Quality of service durability setting"),
        ("liveliness", Liveliness, "Quality of service liveliness setting"),
    )
    for name, kind, text in policies:
        parser.add_argument(
            f"--qos-{name}",
            choices=[member.name.lower() for member in kind if member.name != "MANUAL_BY_NODE"],
            help=f"{text} to {purpose} (overrides {name} value of --qos-profile option, default: "
            f"{_value(preset, name)})",
        )
    parser.add_argument(
        "--qos-liveliness-lease-duration-seconds",
        type=float,
        help=f"Quality of service liveliness lease duration setting to {purpose} (overrides liveliness lease "
        "duration value of --qos-profile option, default: infinite)",
    )


def _value(preset: str, policy: str) -> str:
    """Return how the help names a preset's value of a policy."""
    best_effort = preset == "sensor_data"
    return {
        "depth": "5" if best_effort else "10",
        "history": "keep_last",
        "reliability": "best_effort" if best_effort else "reliable",
        "durability": "volatile",
        "liveliness": "system_default",
    }[policy]


def requested_qos(args: Namespace) -> QoSProfile | None:
    """Return the profile that the options ask for, None where none is given."""
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
    return profile_of(args.qos_profile or args._qos_preset, overrides, lease)


def profile_of(preset: str, overrides: dict[str, Any] | None = None, lease_s: float | None = None) -> QoSProfile:
    """Return a preset profile with some policies replaced by others, named in lower case."""
    import copy

    from rclpy.qos import QoSPresetProfiles

    profile: QoSProfile = copy.copy(QoSPresetProfiles.get_from_short_key(preset))
    replace_policies(profile, overrides or {}, lease_s)
    return profile


def replace_policies(profile: QoSProfile, overrides: dict[str, Any], lease_s: float | None = None) -> None:
    """Replace some policies of a profile by others, named in lower case; None leaves a policy as it is."""
    from rclpy.duration import Duration
    from rclpy.qos import DurabilityPolicy, HistoryPolicy, LivelinessPolicy, ReliabilityPolicy

    given = {name: value for name, value in overrides.items() if value is not None}
    kinds = {
        "history": HistoryPolicy,
        "reliability": ReliabilityPolicy,
        "durability": DurabilityPolicy,
        "liveliness": LivelinessPolicy,
    }
    for name, kind in kinds.items():
        if name in given:
            setattr(profile, name, kind.get_from_short_key(given[name]))
    if "depth" in given:
        profile.depth = given["depth"]
    elif profile.durability == DurabilityPolicy.TRANSIENT_LOCAL and profile.depth == 0:
        profile.depth = 1
    if lease_s is not None:
        profile.liveliness_lease_duration = Duration(seconds=lease_s)


def qos_for_publishers(publishers: Sequence[EndpointInfo]) -> QoSProfile:
    """Return the strictest profile by which every publisher is heard; say so where some of them offer more."""
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
    return profile_of(
        "sensor_data" if reliable < count else "default",
        {
            "reliability": "reliable" if count and reliable == count else "best_effort",
            "durability": "transient_local" if count and latched == count else "volatile",
            "depth": max(depth, 10),
        },
    )
