"""End of state machines at shutdown."""

from __future__ import annotations

from typing import Any

import rclpy
from rclpy.logging import get_logger


def set_preempt_handler(sc: Any) -> None:
    """Request that a container ends when the default context is shut down.

    Parameters
    ----------
    sc
        The container, usually the outermost one.
    """

    def preempt() -> None:
        get_logger(__name__).info("Received shutdown request... sent preempt.")
        sc.request_preempt()

    rclpy.get_default_context().on_shutdown(preempt)
