"""Compiling a library's kernels beside a node that is already up, and saying so when it takes long."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable

from rclpy.impl.rcutils_logger import RcutilsLogger

_SILENT_S = 1.0
"""Time after which the user is told; what was compiled before is ready sooner."""

WarmUp = Callable[[Callable[[float, str], None]], None]


def warm_up_in_background(warm_up: WarmUp, logger: RcutilsLogger, then: Callable[[], None]) -> threading.Thread:
    """Compile in a thread, then call `then` there.

    Parameters
    ----------
    warm_up : callable
        Takes what to call with the share done, from 0 to 1, and the next step.
    logger
        Told of the progress when it takes longer than a moment.
    then : callable
        What becomes possible.
    """

    def work() -> None:
        begun = time.monotonic()
        said = -1

        def progress(share: float, step: str) -> None:
            nonlocal said
            if time.monotonic() - begun < _SILENT_S or int(10 * share) == said:
                return
            if said < 0:
                logger.info("the first start on this machine compiles the algorithms; the next ones will not")
            said = int(10 * share)
            logger.info(f"compiling: {100 * share:.0f} % ({step})")

        warm_up(progress)
        if said >= 0:
            logger.info(f"compiled in {time.monotonic() - begun:.0f} s")
        then()

    thread = threading.Thread(target=work, name="compiler", daemon=True)
    thread.start()
    return thread
