"""Waiting for servers without a thread that waits."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

from daidalos.transport.steady_timers import STEADY_TIMERS

_PERIOD_NS = 10_000_000


def when(ready: Callable[[], bool], timeout_s: float, then: Callable[[], Any], late: Callable[[], Any]) -> None:
    """Call `then` once `ready` is true, at once where it is; call `late` when it is not after `timeout_s` seconds."""
    until = time.monotonic_ns() + int(timeout_s * 1e9)

    def check() -> None:
        if ready():
            then()
        elif time.monotonic_ns() >= until:
            late()
        else:
            STEADY_TIMERS.at(time.monotonic_ns() + _PERIOD_NS, check)

    check()


def named_values(fields: Any, args: Any) -> dict[str, Any]:
    """Return the arguments of a request by field: of a list in their order, of anything but a mapping none."""
    if isinstance(args, list):
        return dict(zip(fields, args, strict=False))
    return args if isinstance(args, dict) else {}
