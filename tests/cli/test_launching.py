"""Launches in the foreground and their exit status."""

import os
import signal
import subprocess
import sys

import pytest

SCRIPT = """
import sys
from launch.actions import ExecuteProcess, OpaqueFunction
from daidalos.cli.daidalos.launching import run_launch

waiting = ExecuteProcess(cmd=[sys.executable, "-S", "-c", "import threading; threading.Event().wait()"])
ready = OpaqueFunction(function=lambda context: print("ready", flush=True))
sys.exit(run_launch(waiting, ready))
"""


@pytest.mark.skipif(os.name != "posix", reason="needs signals")
@pytest.mark.parametrize(("number", "status"), [(signal.SIGINT, 130), (signal.SIGTERM, 0)])
def test_ctrl_c_has_one_status(number, status):
    launch = subprocess.Popen([sys.executable, "-c", SCRIPT], stdout=subprocess.PIPE, text=True)
    assert launch.stdout is not None
    while launch.stdout.readline() != "ready\n":
        assert launch.poll() is None
    launch.send_signal(number)
    launch.communicate(timeout=60)
    assert launch.returncode == status
