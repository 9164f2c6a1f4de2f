"""What a zenoh thread keeps between the calls that it makes into Python."""

from __future__ import annotations

import json
import multiprocessing
import os
import sys
import threading
import time
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from queue import SimpleQueue
from typing import Any

import pytest
import zenoh
from zenoh.handlers import Callback

from daidalos.transport.environment import read_environment
from daidalos.transport.session import Session
from daidalos.transport.shared import make_backend
from daidalos.transport.zenoh.threads import on_lasting_thread

COUNT = 20


def most_calls_known(socket: str, lasts: bool) -> int:
    """Send samples between two sessions; return how many calls a thread that took them has known of."""
    local = threading.local()
    counts: SimpleQueue[int] = SimpleQueue()
    there = threading.Event()

    def count(_: Any) -> None:
        local.count = getattr(local, "count", 0) + 1
        counts.put(local.count)

    with session("listen", socket) as listener, session("connect", socket) as talker:
        kept = listener.declare_subscriber("a", Callback(on_lasting_thread(count) if lasts else count, indirect=False))
        publisher = talker.declare_publisher("a", congestion_control=zenoh.CongestionControl.BLOCK)
        matching = publisher.declare_matching_listener(lambda status: there.set())
        assert publisher.matching_status.matching or there.wait(10)
        for number in range(COUNT):
            publisher.put(str(number))
        most = max(counts.get(timeout=10) for _ in range(COUNT))
        matching.undeclare()
        kept.undeclare()
        return most


def session(how: str, socket: str) -> zenoh.Session:
    config = zenoh.Config()
    config.insert_json5("mode", '"peer"')
    config.insert_json5("scouting/multicast/enabled", "false")
    config.insert_json5("listen/endpoints", "[]")
    config.insert_json5(f"{how}/endpoints", json.dumps([f"unixsock-stream/{socket}"]))
    return zenoh.open(config)


@pytest.mark.parametrize("lasts", [True, False])
def test_a_thread_is_known_again(tmp_path: Path, lasts: bool):
    with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as fresh:
        most = fresh.submit(most_calls_known, f"{tmp_path}/z", lasts).result(60)
    assert (most > 1) is lasts


def threads_of_a_session(variable: str | None, awaited: set[str]) -> tuple[set[str], str | None]:
    """Open a session; return its threads' names and what the environment says of threads then.

    A thread is called as the one that started it until it runs, so that the names come a moment later.
    """
    if variable is not None:
        os.environ["ZENOH_RUNTIME"] = variable
    session = Session(make_backend(read_environment()))
    deadline = time.monotonic() + 10
    while not awaited <= (names := thread_names()) and time.monotonic() < deadline:
        pass
    session.close()
    return names, os.environ.get("ZENOH_RUNTIME")


def thread_names() -> set[str]:
    return {Path(f"/proc/self/task/{task}/comm").read_text().strip() for task in os.listdir("/proc/self/task")}


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="only Linux names threads in /proc")
@pytest.mark.parametrize("own", [None, "(net: (worker_threads: 1))"])
def test_links_are_read_where_they_are_waited_for(monkeypatch: pytest.MonkeyPatch, own: str | None):
    monkeypatch.delenv("ZENOH_RUNTIME", raising=False)
    monkeypatch.setenv("RMW_IMPLEMENTATION", "rmw_zenoh_cpp")
    with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as fresh:
        awaited = {"net-0"} if own is None else {"net-0", "acc-0"}
        names, after = fresh.submit(threads_of_a_session, own, awaited).result(60)
    assert {"net-0", "acc-0"} & names == awaited
    assert after == own
