"""A process that does nothing but to be there."""

from __future__ import annotations

import sys

from launch.actions import ExecuteProcess

_SCRIPT = """
import threading
try:
    threading.Event().wait()
except KeyboardInterrupt:
    pass
"""


def KeepAliveProc() -> ExecuteProcess:
    """Return an action whose process runs until the launch ends, so that the launch does not end before."""
    return ExecuteProcess(cmd=[sys.executable, "-c", _SCRIPT], name="keep_alive")
