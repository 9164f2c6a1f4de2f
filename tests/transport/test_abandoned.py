"""What nobody refers to any more is closed on a thread of its own, which ends before the session does."""

import subprocess
import sys
import threading

import pytest

from daidalos.transport.inprocess import InProcessBackend
from daidalos.transport.session import Session

PROGRAM = "import rclpy; rclpy.init(); rclpy.create_node('forgotten')"


def test_closing_a_session_waits_for_what_was_abandoned():
    session = Session(InProcessBackend())
    entered, closed = threading.Event(), []

    def close():
        entered.set()
        threading.Event().wait(0.2)
        closed.append(True)

    session.abandon(close)
    session.abandon(lambda: closed.append(False))
    assert entered.wait(10)
    session.close()
    assert sorted(closed) == [False, True]
    session.close()


@pytest.mark.slow
def test_programs_that_forget_their_node_end_well(monkeypatch, domain):
    monkeypatch.setenv("ROS_DOMAIN_ID", str(domain))
    for _ in range(40):
        done = subprocess.run([sys.executable, "-c", PROGRAM], capture_output=True, text=True, timeout=60)
        assert (done.returncode, done.stderr) == (0, "")


DROPPED = """
import gc, rclpy
from rclpy.context import Context
def drop():
    context = Context()
    rclpy.init(context=context)
    rclpy.create_node('forgotten', context=context)
drop()
gc.collect()
"""


@pytest.mark.slow
def test_programs_that_drop_their_context_end_well(monkeypatch, domain):
    monkeypatch.setenv("ROS_DOMAIN_ID", str(domain))
    for _ in range(10):
        done = subprocess.run([sys.executable, "-c", DROPPED], capture_output=True, text=True, timeout=60)
        assert (done.returncode, done.stderr) == (0, "")
