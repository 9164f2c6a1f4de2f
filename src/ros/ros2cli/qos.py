"""Quality of service on the command line."""

from __future__ import annotations

from argparse import ArgumentParser
from enum import Enum
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rclpy.qos import QoSProfile

_PRESETS = (
    "unknown", "default", "system_default", "sensor_data", "services_default", "parameters", "parameter_events",
    "action_status_default", "best_available",
)  # fmt: skip


def qos_profile_from_short_keys(
    preset_profile: str,
    reliability: str | None = None,
    durability: str | None = None,
    depth: int | None = None,
    history: str | None = None,
    liveliness: str | None = None,
    liveliness_lease_duration_s: float | None = None,
) -> QoSProfile:
    """Return a preset profile, such as ``sensor_data``, with some policies replaced, such as ``reliable``."""
    import copy

    from rclpy.qos import QoSPresetProfiles

    profile: QoSProfile = copy.copy(QoSPresetProfiles.get_from_short_key(preset_profile))
    profile_configure_short_keys(
        profile, reliability, durability, depth, history, liveliness, liveliness_lease_duration_s
    )
    return profile


def profile_configure_short_keys(
    profile: QoSProfile,
    reliability: str | None = None,
    durability: str | None = None,
    depth: int | None = None,
    history: str | None = None,
    liveliness: str | None = None,
    liveliness_lease_duration_s: float | None = None,
) -> QoSProfile:
    """Replace some policies of a profile, named as in `qos_profile_from_short_keys`, and return it."""
    from rclpy.duration import Duration
    from rclpy.qos import DurabilityPolicy, HistoryPolicy, LivelinessPolicy, ReliabilityPolicy

    if history is not None:
        profile.history = HistoryPolicy.get_from_short_key(history)
    if reliability is not None:
        profile.reliability = ReliabilityPolicy.get_from_short_key(reliability)
    if durability is not None:
        profile.durability = DurabilityPolicy.get_from_short_key(durability)
    if liveliness is not None:
        profile.liveliness = LivelinessPolicy.get_from_short_key(liveliness)
    if depth is not None:
        profile.depth = depth
    elif profile.durability == DurabilityPolicy.TRANSIENT_LOCAL and profile.depth == 0:
        profile.depth = 1
    if liveliness_lease_duration_s is not None:
        profile.liveliness_lease_duration = Duration(seconds=liveliness_lease_duration_s)
    return profile


def add_qos_arguments(parser: ArgumentParser, subscribe_or_publish: str, default_profile_str: str) -> None:
    """Declare the options for a quality of service.

    Parameters
    ----------
    parser
        The parser that gets the options.
    subscribe_or_publish
        What the quality of service is for: ``subscribe`` or ``publish``.
    default_profile_str
        The preset profile whose policies the options replace.
    """
    from daidalos.transport.qos import Durability, History, Liveliness, Reliability

    purpose, preset = f"{subscribe_or_publish} with", default_profile_str
    parser.set_defaults(_qos_preset=preset)
    parser.add_argument(
        "--qos-profile",
        choices=_PRESETS,
        help=f"Quality of service preset profile to {purpose} (default: {preset})",
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
    """Return the name that the help shows for a preset's value of a policy."""
    best_effort = preset == "sensor_data"
    return {
        "depth": "5" if best_effort else "10",
        "history": "keep_last",
        "reliability": "best_effort" if best_effort else "reliable",
        "durability": "volatile",
        "liveliness": "system_default",
    }[policy]
