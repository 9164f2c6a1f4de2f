"""Configuration of a zenoh session from the environment variables of rmw_zenoh."""

from __future__ import annotations

import json
import os
import shutil
import socket
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import zenoh

from daidalos.transport.environment import DiscoveryRange, Environment, EnvironmentVariableError

ROUTER_PORT = 7447
_SHM_FOLDER = Path("/dev/shm")
_SHM_NEEDED = 256 * 2**20
"""Free shared memory, in bytes, below which it is left alone: a full /dev/shm kills who writes to it."""
_MINUTE_MS = 60_000


def session_config(environment: Environment, session: str, listen: Iterable[str], peers: Iterable[str]) -> zenoh.Config:
    """Return the configuration of a session.

    Parameters
    ----------
    environment
        Discovery range and static peers.
    session
        Its zenoh id, 32 hexadecimal digits.
    listen
        Where it listens.
    peers
        The endpoints of live sessions on this machine.

    Raises
    ------
    EnvironmentVariableError
        When ``ZENOH_SESSION_CONFIG_URI`` or ``ZENOH_CONFIG_OVERRIDE`` cannot be used.
    """
    file = os.environ.get("ZENOH_SESSION_CONFIG_URI")
    if file:
        config = _from_file("ZENOH_SESSION_CONFIG_URI", file)
        # What the graph cannot do without; all else is the file's, as in ROS 2.
        settings: dict[str, Any] = {"timestamping/enabled": True}
        if config.get_json("id") == "null":
            settings["id"] = session
    else:
        config = zenoh.Config()
        settings = {"id": session, **_transport_settings(), **_network_settings(environment, list(listen), list(peers))}
    for key, value in settings.items():
        config.insert_json5(key, json.dumps(value))
    _override(config, os.environ.get("ZENOH_CONFIG_OVERRIDE", ""))
    return config


def router_config() -> zenoh.Config:
    """Return the configuration of a router: it listens for sessions of this machine and of others.

    Raises
    ------
    EnvironmentVariableError
        When ``ZENOH_ROUTER_CONFIG_URI`` or ``ZENOH_CONFIG_OVERRIDE`` cannot be used.
    """
    file = os.environ.get("ZENOH_ROUTER_CONFIG_URI")
    if file:
        config = _from_file("ZENOH_ROUTER_CONFIG_URI", file)
    else:
        config = zenoh.Config()
        settings = {
            "mode": "router",
            "listen/endpoints": [f"tcp/{_any_address()}:{ROUTER_PORT}"],
            "scouting/multicast/enabled": False,
            "scouting/gossip/enabled": True,
            **_transport_settings(),
        }
        for key, value in settings.items():
            config.insert_json5(key, json.dumps(value))
    _override(config, os.environ.get("ZENOH_CONFIG_OVERRIDE", ""))
    return config


def meets_all(config: zenoh.Config, listen: Iterable[str]) -> bool:
    """Return whether a session listens where all others on this machine look for it."""
    return config.get_json("mode") == '"peer"' and all(
        endpoint in config.get_json("listen/endpoints") for endpoint in listen
    )


def _from_file(variable: str, uri: str) -> zenoh.Config:
    try:
        return zenoh.Config.from_file(uri.removeprefix("file://"))
    except zenoh.ZError as error:
        raise EnvironmentVariableError(f"{variable} is '{uri}': {reason_of(error)}") from None


def reason_of(error: Exception) -> str:
    """Return the reason of a zenoh error as one line, without the location in zenoh's code."""
    return " ".join(str(error).partition(" at /")[0].split())


def _network_settings(environment: Environment, listen: list[str], peers: list[str]) -> dict[str, Any]:
    reach = environment.discovery
    statics = [_peer_endpoint(peer) for peer in environment.static_peers]
    connect = [] if reach is DiscoveryRange.OFF else [*peers, f"tcp/localhost:{ROUTER_PORT}", *statics]
    open_to_all = reach is DiscoveryRange.SUBNET or (reach is DiscoveryRange.LOCALHOST and statics)
    return {
        "mode": "peer",
        # On one machine nothing but a socket file listens, which other users cannot open; those who come by way of a
        # router listen themselves, or the router passes on what is sent.
        "listen/endpoints": [*listen, f"tcp/{_any_address()}:0"] if open_to_all else listen,
        "listen/exit_on_failure": False,
        "connect/endpoints": connect,
        "connect/exit_on_failure": False,
        # Opening never waits for peers: they are connected to in the background, again and again.
        "connect/timeout_ms": -1,
        "connect/retry": {"period_init_ms": 100, "period_max_ms": 4000, "period_increase_factor": 2},
        "scouting/delay": 0,
        "scouting/multicast/enabled": reach is DiscoveryRange.SUBNET,
        "scouting/gossip/enabled": reach is not DiscoveryRange.OFF,
    }


def _any_address() -> str:
    """Return the wildcard address of this machine: IPv6's covers both families where IPv6 is available."""
    try:
        with socket.socket(socket.AF_INET6, socket.SOCK_STREAM) as probe:
            probe.bind(("::", 0))
    except OSError:
        return "0.0.0.0"
    return "[::]"


def _peer_endpoint(peer: str) -> str:
    """Return the endpoint of a static peer: ``host``, ``host:port``, IPv6 in brackets, or an endpoint."""
    if "/" in peer:
        return peer
    has_port = peer.rpartition(":")[2].isdigit() and (peer.count(":") == 1 or "]:" in peer)
    return f"tcp/{peer}" if has_port else f"tcp/{peer}:{ROUTER_PORT}"


def _transport_settings() -> dict[str, Any]:
    return {
        "timestamping/enabled": True,
        "queries_default_timeout": 10 * _MINUTE_MS,
        "transport/link/tx/lease": _MINUTE_MS,
        "transport/link/tx/keep_alive": 2,
        # A peer that is stopped (Ctrl-Z, a debugger) must not stop those who publish to it for long: its link
        # is closed, and made again when it goes on. One that gets no processor for a second must not lose messages.
        "transport/link/tx/queue/congestion_control/block/wait_before_close": 3_000_000,
        # Nor must it block peers that connect, or the shutdown: it retries.
        "transport/unicast/open_timeout": 2_000,
        # A new peer is told of all our endpoints at once. What does not fit into the queue makes zenoh give the
        # peer up; this much, the most it takes, holds some six thousand.
        "transport/link/tx/queue/size/control": 16,
        "transport/shared_memory/enabled": shared_memory_usable(),
    }


def shared_memory_usable() -> bool:
    """Return whether large messages can use shared memory on this machine."""
    if sys.platform == "win32":
        return False
    if not _SHM_FOLDER.is_dir():
        return sys.platform == "darwin"
    return shutil.disk_usage(_SHM_FOLDER).free >= _SHM_NEEDED


def _override(config: zenoh.Config, text: str) -> None:
    """Apply ``key=value;key=value``, where a value is JSON5."""
    for item in filter(None, (part.strip() for part in text.split(";"))):
        key, separator, value = item.partition("=")
        try:
            if not separator:
                raise ValueError("no '='")
            config.insert_json5(key.strip(), value.strip())
        except (ValueError, zenoh.ZError) as error:
            raise EnvironmentVariableError(
                f"ZENOH_CONFIG_OVERRIDE: '{item}' cannot be applied ({reason_of(error)}), expected key=value"
            ) from None
