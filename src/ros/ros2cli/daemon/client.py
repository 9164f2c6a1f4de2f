"""Client of the daemon, which also starts and stops it."""

from __future__ import annotations

import subprocess
import sys
import time
from typing import TYPE_CHECKING, Any

from ros2cli.daemon.protocol import Address, AddressFile, ask, graph_from_json

if TYPE_CHECKING:
    from daidalos.transport.graph import Graph

_START_TIMEOUT_S = 10.0
_STATUS_TIMEOUT_S = 5.0
"""A daemon that has ended refuses at once; one on a loaded machine answers late."""
_POLL_S = 0.01


def fetch_graph() -> Graph | None:
    """Return the daemon's graph, None if no daemon runs."""
    response = _ask("graph")
    return None if response is None else graph_from_json(response)


def is_running() -> bool:
    """Return whether the daemon runs; one that this process has started in the background is waited for."""
    if _ask("status", _STATUS_TIMEOUT_S) is not None:
        return True
    global _starting
    process, _starting = _starting, None
    until = time.monotonic() + _START_TIMEOUT_S
    while process is not None and process.poll() is None and time.monotonic() < until:
        if _ask("status", _STATUS_TIMEOUT_S) is not None:
            return True
        time.sleep(_POLL_S)
    return process is not None and _ask("status", _STATUS_TIMEOUT_S) is not None


def start(debug: bool = False) -> bool:
    """Start the daemon, which stays for two hours after its last request; return False on failure.

    With `debug` its messages go to our standard error.
    """
    process = subprocess.Popen(
        [*_COMMAND, "--stay"],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=None if debug else subprocess.DEVNULL,
        start_new_session=True,
    )
    assert process.stdout is not None
    with process.stdout as output:
        # One that was started in the background meanwhile is as good.
        return output.readline().strip() == b"ready" or keep()


def keep() -> bool:
    """Keep an automatically started daemon running as if started explicitly; return False if none runs."""
    return _ask("stay", _STATUS_TIMEOUT_S) is not None


def start_in_background() -> None:
    """Start a daemon that ends with the last node of the domain, without waiting for it."""
    global _starting
    try:
        _starting = subprocess.Popen(
            _COMMAND,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
        )
    except OSError:
        return  # the command has done its work without it, and so will the next


def stop() -> bool:
    """Stop the daemon and wait until it has left; return False if none runs."""
    return _ask("stop", _START_TIMEOUT_S) is not None


_starting: subprocess.Popen[bytes] | None = None
"""Process that was started in the background, until it was seen to answer or to end."""

_COMMAND = [sys.executable, "-m", "ros2cli.daemon.server"]


def _ask(request: str, timeout_s: float = 1.0) -> Any:
    station = AddressFile()
    address: Address | None = station.read()
    if address is None:
        return None
    try:
        return ask(address, request, timeout_s)
    except (OSError, ValueError):
        return None
