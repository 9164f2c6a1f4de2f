"""`rmw_zenohd`: router that connects nodes of several machines; configured by ``ZENOH_ROUTER_CONFIG_URI``."""

from __future__ import annotations

import signal
import sys
import threading

from daidalos.transport.environment import EnvironmentVariableError
from daidalos.transport.zenoh.router import Router


def main() -> int:
    """Run until the process is asked to end.

    Returns
    -------
    int
        The exit status: 2 when the router cannot start.
    """
    ended = threading.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: ended.set())
    try:
        router = Router()
    except EnvironmentVariableError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    print(f"Started Zenoh router with id {router.identity}", flush=True)
    for endpoint in router.endpoints:
        print(f"listening at {endpoint}", flush=True)
    ended.wait()
    router.close()
    return 0
