"""Transport settings in ROS 2's environment variables."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum

MAX_DOMAIN = 232


class EnvironmentVariableError(RuntimeError):
    """Invalid value of an environment variable."""


class DiscoveryRange(Enum):
    """Range of the discovery of other nodes."""

    SUBNET = "SUBNET"
    LOCALHOST = "LOCALHOST"
    OFF = "OFF"


@dataclass(frozen=True)
class Environment:
    """Domain, discovery and middleware.

    Attributes
    ----------
    domain
        0 to 232 (``ROS_DOMAIN_ID``).
    discovery
        ``ROS_AUTOMATIC_DISCOVERY_RANGE``; this machine where nothing is said, and where Humble's
        ``ROS_LOCALHOST_ONLY`` is 1.
    static_peers
        Hosts to connect to as well (``ROS_STATIC_PEERS``, separated by semicolons).
    middleware
        ``RMW_IMPLEMENTATION``.
    """

    domain: int = 0
    discovery: DiscoveryRange = DiscoveryRange.LOCALHOST
    static_peers: tuple[str, ...] = ()
    middleware: str = "rmw_zenoh_cpp"


def read_environment(variables: Mapping[str, str] | None = None, domain: int | None = None) -> Environment:
    """Read the environment variables; `domain` overrides ``ROS_DOMAIN_ID``.

    Raises
    ------
    EnvironmentVariableError
        Naming the variable, its value and what is expected.
    """
    values = os.environ if variables is None else variables
    local = values.get("ROS_LOCALHOST_ONLY", "") == "1"  # then nothing else is asked, as in ROS 2
    peers = "" if local else values.get("ROS_STATIC_PEERS", "")
    return Environment(
        _domain(values.get("ROS_DOMAIN_ID", "")) if domain is None else _checked(domain, "domain id"),
        DiscoveryRange.LOCALHOST if local else _discovery(values),
        tuple(peer.strip() for peer in peers.split(";") if peer.strip()),
        values.get("RMW_IMPLEMENTATION", "") or "rmw_zenoh_cpp",
    )


def _domain(text: str) -> int:
    if not text:
        return 0
    try:
        number = int(text)
    except ValueError:
        raise EnvironmentVariableError(f"ROS_DOMAIN_ID is '{text}', expected a number from 0 to {MAX_DOMAIN}") from None
    return _checked(number, "ROS_DOMAIN_ID")


def _checked(number: int, name: str) -> int:
    if not 0 <= number <= MAX_DOMAIN:
        raise EnvironmentVariableError(f"{name} is {number}, expected a number from 0 to {MAX_DOMAIN}")
    return number


def _discovery(values: Mapping[str, str]) -> DiscoveryRange:
    text = values.get("ROS_AUTOMATIC_DISCOVERY_RANGE", "").upper()
    if text in ("", "SYSTEM_DEFAULT"):
        return DiscoveryRange.LOCALHOST
    try:
        return DiscoveryRange(text)
    except ValueError:
        raise EnvironmentVariableError(
            f"ROS_AUTOMATIC_DISCOVERY_RANGE is '{text}', expected SUBNET, LOCALHOST, OFF or SYSTEM_DEFAULT"
        ) from None
