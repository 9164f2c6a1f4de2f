"""Programs that tests of launch run, and how they watch them."""

import os

import psutil
import pytest
from launch.actions import RegisterEventHandler
from launch.event_handlers import OnProcessIO

posix = pytest.mark.skipif(os.name != "posix", reason="process groups and signals are POSIX's")

# Runs until it is told to stop, and says when it is ready for that.
PATIENT = """
import signal, threading
stop = threading.Event()
for number in (signal.SIGINT, signal.SIGTERM):
    signal.signal(number, lambda signum, frame: (print('got', signal.Signals(signum).name), stop.set()))
print('ready')
stop.wait()
"""
# Takes notice of nothing but SIGKILL.
STUBBORN = """
import signal, threading
for number in (signal.SIGINT, signal.SIGTERM):
    signal.signal(number, lambda signum, frame: print('ignored', signal.Signals(signum).name))
print('ready')
while True:
    signal.pause()
"""


def when_ready(action, *entities, text=b"ready\n"):
    """Visit entities once a process has said that it is ready."""
    received = bytearray()

    def on_stdout(event):
        was_ready = text in received
        received.extend(event.text)
        return None if was_ready or text not in received else list(entities)

    return RegisterEventHandler(OnProcessIO(target_action=action, on_stdout=on_stdout))


def is_running(pid):
    try:
        return psutil.Process(pid).status() != psutil.STATUS_ZOMBIE
    except psutil.NoSuchProcess:
        return False
