"""Quality of service in bags and override files: YAML with policy names or rmw's numbers."""

from __future__ import annotations

from collections.abc import Iterable
from enum import IntEnum
from typing import Any, TypeVar

from daidalos.common.documents import DocumentError, parse_yaml
from daidalos.transport.qos import INFINITE_NS, Durability, History, Liveliness, Qos, Reliability

_SECOND = 1_000_000_000
_OLD_INFINITE_S = 2**31 - 1
"""Infinite duration in files of ROS 2 before Galactic, in seconds."""

Policy = TypeVar("Policy", bound=IntEnum)


def profiles_text(profiles: Iterable[Qos]) -> str:
    """Return profiles as the text that storages store with a topic; empty without profiles."""
    import yaml

    values = profile_values(profiles)
    return yaml.safe_dump(values, sort_keys=False) if values else ""


def profile_values(profiles: Iterable[Qos]) -> list[dict[str, Any]]:
    """Return profiles as values for YAML."""
    return [
        {
            "history": qos.history.name.lower(),
            "depth": qos.depth,
            "reliability": qos.reliability.name.lower(),
            "durability": qos.durability.name.lower(),
            "deadline": _duration_values(qos.deadline_ns),
            "lifespan": _duration_values(qos.lifespan_ns),
            "liveliness": qos.liveliness.name.lower(),
            "liveliness_lease_duration": _duration_values(qos.liveliness_lease_ns),
            "avoid_ros_namespace_conventions": False,
        }
        for qos in profiles
    ]


def parse_profiles(value: Any) -> tuple[Qos, ...]:
    """Return the profiles that a bag's YAML names: a list, or (before metadata version 9) the text of one.

    Raises
    ------
    ValueError
        When it is something else.
    """
    if isinstance(value, str):
        try:
            value = parse_yaml(value)
        except DocumentError as error:
            raise ValueError(f"not valid YAML: {error.described}") from None
    if value in (None, ""):
        return ()
    if not isinstance(value, list) or not all(isinstance(one, dict) for one in value):
        raise ValueError("expected a list of profiles")
    return tuple(_profile(one) for one in value)


def _profile(values: dict[str, Any]) -> Qos:
    depth = values.get("depth", 0)
    if not isinstance(depth, int) or depth < 0:
        raise ValueError(f"depth: expected a number not below 0, found {depth!r}")
    return Qos(
        reliability=_policy(Reliability, values, "reliability"),
        durability=_policy(Durability, values, "durability"),
        history=_policy(History, values, "history"),
        depth=depth,
        deadline_ns=_nanoseconds(values, "deadline"),
        lifespan_ns=_nanoseconds(values, "lifespan"),
        liveliness=_policy(Liveliness, values, "liveliness"),
        liveliness_lease_ns=_nanoseconds(values, "liveliness_lease_duration"),
    )


def _policy(kind: type[Policy], values: dict[str, Any], name: str) -> Policy:
    value = values.get(name, 0)
    try:
        return kind[value.upper()] if isinstance(value, str) else kind(value)
    except (KeyError, ValueError):
        known = ", ".join(member.name.lower() for member in kind)
        raise ValueError(f"{name}: expected one of {known}, found {value!r}") from None


def _nanoseconds(values: dict[str, Any], name: str) -> int:
    duration = values.get(name) or {}
    try:
        seconds, rest = int(duration.get("sec", 0)), int(duration.get("nsec", 0))
    except (AttributeError, TypeError, ValueError):
        raise ValueError(f"{name}: expected sec and nsec, found {duration!r}") from None
    total = seconds * _SECOND + rest
    endless = total <= 0 or total >= INFINITE_NS or (seconds, rest) == (_OLD_INFINITE_S, 2**32 - 1)
    return INFINITE_NS if endless else total


def _duration_values(nanoseconds: int) -> dict[str, int]:
    seconds, rest = divmod(nanoseconds, _SECOND)
    return {"sec": seconds, "nsec": rest}
