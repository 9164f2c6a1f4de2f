"""Zenoh router, which connects sessions that cannot discover each other."""

from __future__ import annotations

import contextlib
import json
from typing import Any

import zenoh

from daidalos.transport.environment import EnvironmentVariableError
from daidalos.transport.zenoh.config import reason_of, router_config


class Router:
    """Router that runs from construction until `close`.

    Attributes
    ----------
    identity
        Its zenoh id.
    endpoints
        Where it listens, such as ``tcp/[::]:7447``.

    Raises
    ------
    EnvironmentVariableError
        When the configuration cannot be used, such as a port that is taken.
    """

    def __init__(self) -> None:
        config = router_config()
        listen = json.loads(config.get_json("listen/endpoints"))
        self.endpoints = tuple(listen["router"] if isinstance(listen, dict) else listen)
        try:
            self._session: Any = zenoh.open(config)
        except zenoh.ZError as error:
            raise EnvironmentVariableError(f"the router cannot start: {reason_of(error)}") from None
        self.identity = str(self._session.zid())

    def close(self) -> None:
        """Stop the router; direct connections between sessions remain."""
        with contextlib.suppress(zenoh.ZError):  # a peer that is stopped does not acknowledge the close in time
            self._session.close()
