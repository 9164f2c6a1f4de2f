"""Processes end with the process that started them, however that one ends."""

import os
import signal
import subprocess
import sys

import psutil
import pytest

pytestmark = pytest.mark.skipif(os.name != "posix", reason="needs a shell and signals")

PARENT = """
import subprocess, sys, threading
from daidalos.workspaces.orphans import guard

script = "import signal, sys, threading\\n"
script += "signal.signal(signal.SIGINT, lambda *_: (print('orderly', flush=True), sys.exit()))\\n"
script += "print('ready', flush=True)\\nthreading.Event().wait()"
child = subprocess.Popen([sys.executable, "-S", "-c", script], process_group=0)
guard.watch({target})
print(child.pid, flush=True)
{after}
"""

LAUNCH = """
import sys, threading
from launch import LaunchDescription, LaunchService
from launch.actions import ExecuteProcess, OpaqueFunction, RegisterEventHandler
from launch.event_handlers import OnProcessStart

node = ExecuteProcess(cmd=[sys.executable, "-S", "-c", "import threading; threading.Event().wait()"])
tell = OnProcessStart(target_action=node, on_start=lambda event, context: print("pid", event.pid, flush=True))
service = LaunchService(noninteractive=True)
service.include_launch_description(LaunchDescription([RegisterEventHandler(tell), node]))
service.run()
"""


def started(script):
    return subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True)


def read_pid(process):
    for line in process.stdout:
        if line.split()[-1].isdigit():
            return int(line.split()[-1])
    raise AssertionError("no process id was printed")


@pytest.mark.slow
@pytest.mark.parametrize("target", ["child.pid", "-child.pid"], ids=["process", "group"])
def test_a_killed_parent_takes_its_children_with_it(target):
    parent = started(PARENT.format(target=target, after="threading.Event().wait()"))
    lines = {parent.stdout.readline().strip() for _ in range(2)}  # the two processes print in either order
    (number,) = lines - {"ready"}
    assert "ready" in lines
    child = psutil.Process(int(number))
    parent.kill()
    child.wait(20)
    assert "orderly" in parent.stdout.read()  # SIGINT came first
    parent.wait()


@pytest.mark.slow
def test_a_released_child_is_left_alone():
    after = "guard.release(child.pid)\nguard.watch(1 << 22)\nprint('released', flush=True)\nthreading.Event().wait()"
    parent = started(PARENT.format(target="child.pid", after=after))
    lines = {parent.stdout.readline().strip() for _ in range(3)}  # the child is ready before or after the others
    assert {"ready", "released"} < lines
    (number,) = lines - {"ready", "released"}
    child = psutil.Process(int(number))
    shells = [each for each in psutil.Process(parent.pid).children() if each.pid != child.pid]
    parent.kill()
    psutil.wait_procs(shells, 20)
    try:
        assert child.is_running()
    finally:
        child.kill()
    parent.wait()


@pytest.mark.slow
def test_a_killed_launch_takes_its_processes_with_it():
    launch = started(LAUNCH)
    node = psutil.Process(read_pid(launch))
    launch.send_signal(signal.SIGKILL)
    node.wait(20)
    launch.wait()
