"""Compilation of a package's kernels in the background of a running node, with its progress in the log."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterable

from rclpy.impl.rcutils_logger import RcutilsLogger
from rclpy.task import Future

from daidalos.common.kernels import warm_up

_NOTICE_AFTER_S = 3.0
"""Time after which progress is logged [s]; kernels from the cache on disk are ready sooner."""

_lock = threading.Lock()
_compiled: dict[tuple[str, frozenset[type] | None], Future] = {}


def warm_up_in_background(package: str, logger: RcutilsLogger, users: Iterable[type] | None = None) -> Future:
    """Compile kernels of a package in a thread, once per process; the future is done when they are compiled.

    Parameters
    ----------
    package : str
        As for `daidalos.common.kernels.warm_up`.
    logger
        Logs the progress when compilation takes longer than `_NOTICE_AFTER_S`.
    users
        As for `daidalos.common.kernels.warm_up`.
    """
    asked = package, None if users is None else frozenset(users)
    with _lock:
        if asked not in _compiled:
            compiled = _compiled[asked] = Future()
            threading.Thread(target=_compile, args=(*asked, logger, compiled), name="compiler", daemon=True).start()
        return _compiled[asked]


def _compile(package: str, users: frozenset[type] | None, logger: RcutilsLogger, compiled: Future) -> None:
    start = time.monotonic()
    logged_tenth = -1

    def progress(share: float, step: str) -> None:
        nonlocal logged_tenth
        if share == 1.0 or time.monotonic() - start < _NOTICE_AFTER_S or int(10 * share) == logged_tenth:
            return
        if logged_tenth < 0:
            logger.info("preparing the algorithms; the first start on a machine compiles them")
        logged_tenth = int(10 * share)
        logger.info(f"compiling: {100 * share:.0f} % ({step})")

    try:
        warm_up(package, progress, users)
    except Exception as error:
        compiled.set_exception(error)
        return
    if logged_tenth >= 0:
        logger.info(f"compiled in {time.monotonic() - start:.0f} s")
    compiled.set_result(None)
