"""The receiving thread's end, and the pace of work that grows with what is known of the domain."""

from __future__ import annotations

import threading
import time

import pytest

pytest.importorskip("cyclonedds")

from daidalos.transport.cyclonedds.library import INFINITE, load
from daidalos.transport.cyclonedds.reception import Paced, Reception
from daidalos.transport.environment import Environment
from daidalos.transport.session import Session
from daidalos.transport.shared import make_backend


def test_work_that_takes_long_waits_in_proportion_and_is_done_once():
    done = []

    def work() -> None:
        begin = time.thread_time_ns()
        while time.thread_time_ns() - begin < 10_000_000:
            """Use the processor."""
        done.append(time.monotonic_ns())

    paced = Paced(work)
    assert paced.run() == INFINITE
    paced.request()
    assert paced.run() == INFINITE
    for _ in range(100):
        paced.request()
        wait = paced.run()
    assert len(done) == 1
    assert 0 < wait <= 500_000_000
    time.sleep(wait * 1e-9)
    assert paced.run() == INFINITE
    assert len(done) == 2
    assert done[1] - done[0] >= 90_000_000


def test_the_thread_ends_with_its_participant(domain: int):
    session = Session(make_backend(Environment(domain, middleware="rmw_cyclonedds_cpp")))
    library = load()
    participant = library.check(library.dds_create_participant(domain, None, None), "join the domain")
    reception = Reception(library, participant, "tested")
    thread = next(one for one in threading.enumerate() if one.name == "tested")
    library.dds_delete(participant)
    thread.join(10.0)
    assert not thread.is_alive()
    assert not reception.enter()
    session.close()


def test_what_is_requested_during_the_work_is_done_again():
    done = []

    def work() -> None:
        done.append(len(done))
        if len(done) == 1:
            paced.request()

    paced = Paced(work)
    paced.request()
    while (wait := paced.run()) != INFINITE:
        time.sleep(wait * 1e-9)
    assert done == [0, 1]
