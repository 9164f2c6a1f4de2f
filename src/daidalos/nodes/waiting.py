"""Waits that last as long as what is waited for may still come: a program of the launch, or a server's answer."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable
from concurrent.futures import Future
from typing import TYPE_CHECKING, Any

from daidalos.common.errors import UserError

if TYPE_CHECKING:
    from rclpy.client import Client

REPORT_S = 10.0
"""Time between two reports of what is waited for [s]."""


def launch_is_running() -> bool:
    """Return whether a launch started this process and is still running."""
    import psutil

    number = os.environ.get("DAIDALOS_LAUNCH_PID", "")
    return number.isdecimal() and psutil.pid_exists(int(number))


def wait_in_launch(ready: Callable[[float], bool], limit_s: float, report: Callable[[], object]) -> bool:
    """Return whether something becomes ready within a limit, or, in a launch, as long as the launch is running.

    Parameters
    ----------
    ready
        Waits for so many seconds at most and returns whether it is ready.
    limit_s
        The limit outside of a launch, and the time between two reports in one [s].
    report
        Called whenever the limit has passed in a launch.
    """
    while not ready(limit_s):
        if not launch_is_running():
            return False
        report()
    return True


def answer(client: Client, request: Any, report: Callable[[str], object], limit_s: float | None = None) -> Any:
    """Call a service that is there, and return its response.

    Parameters
    ----------
    client
        The client.
    request
        The request.
    report
        Called every `REPORT_S` with what is waited for.
    limit_s
        How long the response may take [s]. None: as long as the server is there.

    Raises
    ------
    UserError
        When no response comes.
    """
    name = client.service_name
    response: Future[Any] = Future()

    def call() -> None:
        try:
            response.set_result(client.call(request))
        except BaseException as error:
            response.set_exception(error)

    threading.Thread(target=call, name=f"call of {name}", daemon=True).start()
    while True:
        try:
            return response.result(REPORT_S if limit_s is None else limit_s)
        except TimeoutError:
            if limit_s is not None:
                raise UserError(f"{name} did not answer within {limit_s:g} s") from None
        if not client.service_is_ready():
            raise UserError(f"{name} went away before it answered")
        report(f"waiting for the answer of '{name}'; a simulator that still loads answers later")
