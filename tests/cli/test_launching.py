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


ENDED_BEFORE = """
import os, signal, sys
from launch.actions import EmitEvent, OpaqueFunction, RegisterEventHandler
from launch.event_handlers import OnShutdown
from launch.events import Shutdown
from daidalos.cli.daidalos.launching import run_launch

press = OpaqueFunction(function=lambda context: os.kill(os.getpid(), signal.SIGINT))
watch = RegisterEventHandler(OnShutdown(on_shutdown=lambda event, context: press))
sys.exit(run_launch(watch, EmitEvent(event=Shutdown(reason="a process that Ctrl-C reached first has ended"))))
"""


@pytest.mark.skipif(os.name != "posix", reason="needs signals")
def test_ctrl_c_has_its_status_where_a_process_that_it_reached_first_ends_the_launch():
    assert subprocess.run([sys.executable, "-c", ENDED_BEFORE], timeout=60, capture_output=True).returncode == 130


EARLY = """
import _signal, os, sys
from daidalos.cli.daidalos import main

class Press:
    def find_spec(self, name, *rest):
        if name == "daidalos.cli.daidalos.program":
            os.kill(os.getpid(), _signal.SIGINT)

sys.meta_path.insert(0, Press())
sys.argv = ["daidalos", "extensions"]
sys.exit(main())
"""


@pytest.mark.skipif(os.name != "posix", reason="needs signals")
def test_ctrl_c_has_its_status_while_the_command_is_imported():
    ended = subprocess.run([sys.executable, "-c", EARLY], timeout=60, capture_output=True, text=True)
    assert (ended.returncode, ended.stdout, ended.stderr) == (130, "", "")
