"""Compiling a library's kernels beside a node that is already up, and saying so when it takes long."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable

from rclpy.impl.rcutils_logger import RcutilsLogger
from rclpy.task import Future

_SILENT_S = 3.0
"""Time after which the user is told; what was compiled before is ready sooner."""

WarmUp = Callable[[Callable[[float, str], None]], None]

_lock = threading.Lock()
_compiled: dict[WarmUp, Future] = {}


def warm_up_in_background(warm_up: WarmUp, logger: RcutilsLogger) -> Future:
    """Compile in a thread, once in a process; the result is done when that is.

    Parameters
    ----------
    warm_up : callable
        Takes what to call with the share done, from 0 to 1, and the next step.
    logger
        Told of the progress when it takes longer than a moment.
    """
    with _lock:
        if warm_up not in _compiled:
            compiled = _compiled[warm_up] = Future()
            threading.Thread(target=_compile, args=(warm_up, logger, compiled), name="compiler", daemon=True).start()
        return _compiled[warm_up]


def _compile(warm_up: WarmUp, logger: RcutilsLogger, compiled: Future) -> None:
    begun = time.monotonic()
    said = -1

    def progress(share: float, step: str) -> None:
        nonlocal said
        if time.monotonic() - begun < _SILENT_S or int(10 * share) == said:
            return
        if said < 0:
            logger.info("preparing the algorithms; the first start on a machine compiles them")
        said = int(10 * share)
        logger.info(f"compiling: {100 * share:.0f} % ({step})")

    try:
        warm_up(progress)
    except Exception as error:
        compiled.set_exception(error)
        return
    if said >= 0:
        logger.info(f"compiled in {time.monotonic() - begun:.0f} s")
    compiled.set_result(None)
