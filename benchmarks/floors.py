"""What memory and the middlewares take bare, in Python: the floors of rclpy's figures, measured in the same minutes.

A machine's clock and load change from hour to hour, and a figure with them; how far it lies above its floor does not.
"""

from __future__ import annotations

import itertools
import json
import os
import socket
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from benchmarks.processes import middle_and_tail_us, report, result, running, say_ready, start

ROUND_TRIPS = 2000
WARM = 300
WAKES = 4000
STREAM_S = 2.0
SMALL = b"x" * 69
ATTACHMENT = bytes(33)
"""As long as what rmw_zenoh attaches to every message: sequence number, time and gid."""
SETTLE_S = 0.5
UNIX_LINK, TCP_LINK = "unixsock-stream", "tcp"


def zenoh_latency(role: str, link: str = UNIX_LINK) -> tuple[float, float]:
    """Return the median and the 99th percentile, in us, of what goes to another process and back over zenoh.

    `role` is ``zenoh_ping`` for two topics, or ``zenoh_call`` for a query and its reply; ``rmw_ping`` and ``rmw_call``
    are the same with what ROS 2 asks of every message. For `link`, see `link_endpoint`.
    """
    echo = "rmw_echo" if role.startswith("rmw_") else "zenoh_echo"
    with link_endpoint(link) as endpoint, running("floors", echo, endpoint):
        return middle_and_tail_us(result(start("floors", role, endpoint))["times"])


def dds_latency() -> tuple[float, float]:
    """Return the same for two topics of the package cyclonedds."""
    with running("floors", "dds_echo"):
        return middle_and_tail_us(result(start("floors", "dds_ping"))["times"])


def wakes_1khz() -> tuple[float, float]:
    """Return the percentage of a core, and the jitter's 99th percentile in us, of a bare thread that wakes at 1 kHz."""
    return share_and_jitter(result(start("floors", "sleep_1khz")))


def share_and_jitter(measured: dict[str, Any]) -> tuple[float, float]:
    """Return the same of the ``ticks``, the processor time ``cpu`` and the duration ``seconds`` of a role."""
    jitter = sorted(abs(after - before - 0.001) for before, after in itertools.pairwise(measured["ticks"]))
    return 100 * measured["cpu"] / measured["seconds"], jitter[len(jitter) * 99 // 100] * 1e6


def zenoh_stream(size: int, link: str = UNIX_LINK) -> float:
    """Return how many payloads a second another process gets over zenoh, and copies, without loss."""
    with link_endpoint(link) as endpoint, running("floors", "zenoh_count", endpoint) as receiver:
        result(start("floors", "zenoh_flood", endpoint, str(size)))
        received = result(receiver)
    return float(received["count"] / received["seconds"])


@contextmanager
def link_endpoint(link: str) -> Iterator[str]:
    """Yield an endpoint of zenoh on this machine: a socket file for `UNIX_LINK`, a port of loopback for `TCP_LINK`."""
    if link == UNIX_LINK:
        with TemporaryDirectory(prefix="dd") as folder:
            yield f"{link}/{Path(folder) / 'z'}"
    else:
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            port = probe.getsockname()[1]
        yield f"{link}/127.0.0.1:{port}"


# Roles.


def _session(endpoint: str, how: str) -> Any:
    import zenoh

    config = zenoh.Config()
    settings = {
        "mode": "peer",
        "listen/endpoints": [],
        f"{how}/endpoints": [endpoint],
        "scouting/multicast/enabled": False,
        "transport/shared_memory/enabled": True,
    }
    for key, value in settings.items():
        config.insert_json5(key, json.dumps(value))
    return zenoh.open(config)


def _publisher(session: Any, key: str) -> Any:
    import zenoh

    return session.declare_publisher(key, congestion_control=zenoh.CongestionControl.BLOCK)


def _direct(function: Callable[[Any], None]) -> Any:
    from zenoh.handlers import Callback

    return Callback(function, indirect=False)


def zenoh_echo(endpoint: str) -> None:
    with _session(endpoint, "listen") as session:
        pong = _publisher(session, "pong")

        def reply(query: Any) -> None:
            with query:
                query.reply("call", query.payload)

        kept = (
            session.declare_subscriber("ping", _direct(lambda sample: pong.put(sample.payload))),
            session.declare_queryable("call", _direct(reply), complete=True),
        )
        say_ready()
        sys.stdin.read()
        assert kept


def zenoh_ping(endpoint: str) -> None:
    with _session(endpoint, "connect") as session:
        answered, ping = _Gate(), _publisher(session, "ping")
        kept = session.declare_subscriber("pong", _direct(answered.open))
        _repeat(lambda: ping.put(SMALL), answered)
        assert kept


def rmw_echo(endpoint: str) -> None:
    """Answer with rmw_zenoh's attachment, from a thread that is not zenoh's, as an executor does."""
    with _session(endpoint, "listen") as session:
        pong, come, received = _publisher(session, "pong"), _Gate(), []

        def receive(sample_or_query: Any) -> None:
            received.append(sample_or_query)
            come.open(sample_or_query)

        subscriber = session.declare_subscriber("ping", _direct(receive))
        queryable = session.declare_queryable("call", _direct(receive), complete=True)
        threading.Thread(target=lambda: (sys.stdin.read(), os._exit(0)), daemon=True).start()
        say_ready()
        while subscriber and queryable:
            come.wait()
            one = received.pop()
            data = one.payload.to_bytes()
            if hasattr(one, "reply"):
                with one:
                    one.reply("call", data, attachment=ATTACHMENT)
            else:
                pong.put(data, attachment=ATTACHMENT)


def rmw_ping(endpoint: str) -> None:
    with _session(endpoint, "connect") as session:
        answered, ping = _Gate(), _publisher(session, "ping")
        kept = session.declare_subscriber("pong", _direct(answered.open))
        _repeat(lambda: ping.put(SMALL, attachment=ATTACHMENT), answered)
        assert kept


def zenoh_call(endpoint: str) -> None:
    with _session(endpoint, "connect") as session:
        answered, querier = _Gate(), session.declare_querier("call")
        on_reply = _direct(answered.open)
        _repeat(lambda: querier.get(on_reply, payload=SMALL), answered)


def rmw_call(endpoint: str) -> None:
    with _session(endpoint, "connect") as session:
        answered, querier = _Gate(), session.declare_querier("call")
        on_reply = _direct(answered.open)
        _repeat(lambda: querier.get(on_reply, payload=SMALL, attachment=ATTACHMENT), answered)


def sleep_1khz() -> None:
    """Wake a thread a thousand times a second, and report when it woke and the processor time that it took."""
    ticks, gate, following = [], threading.Lock(), time.perf_counter()
    gate.acquire()
    before = time.process_time()
    while len(ticks) < WAKES:
        following += 0.001
        gate.acquire(timeout=max(following - time.perf_counter(), 0.0))
        ticks.append(time.perf_counter())
    report(ticks=ticks, cpu=time.process_time() - before, seconds=ticks[-1] - ticks[0])


class _Gate:
    """Lets one thread wait for another."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._lock.acquire()

    def open(self, _: Any) -> None:
        self._lock.release()

    def wait(self) -> None:
        self._lock.acquire()


def _repeat(send: Callable[[], Any], answered: _Gate) -> None:
    """Send and wait for the answer, many times, and report how long it took."""
    time.sleep(SETTLE_S)
    times = []
    for _ in range(ROUND_TRIPS + WARM):
        begin = time.perf_counter()
        send()
        answered.wait()
        times.append(time.perf_counter() - begin)
    report(times=times[WARM:])


def zenoh_count(endpoint: str) -> None:
    count, first, last = 0, 0.0, 0.0

    def receive(sample: Any) -> None:
        nonlocal count, first, last
        sample.payload.to_bytes()
        last = time.perf_counter()
        first = first or last
        count += 1

    with _session(endpoint, "listen") as session:
        kept = session.declare_subscriber("stream", _direct(receive))
        say_ready()
        sys.stdin.read()
        assert kept
    report(count=count, seconds=max(last - first, 1e-9))


def zenoh_flood(endpoint: str, size: str) -> None:
    with _session(endpoint, "connect") as session:
        publisher, data = _publisher(session, "stream"), os.urandom(int(size))
        time.sleep(SETTLE_S)
        end = time.perf_counter() + STREAM_S
        while time.perf_counter() < end:
            publisher.put(data)
        time.sleep(SETTLE_S)
    report()


def _dds(read: str, written: str) -> tuple[Any, Any, Callable[[], list[Any]]]:
    """Return the class of a message, a writer, and what waits for messages and takes them."""
    from dataclasses import make_dataclass

    from cyclonedds.core import InstanceState, Policy, Qos, ReadCondition, SampleState, ViewState, WaitSet
    from cyclonedds.domain import DomainParticipant
    from cyclonedds.idl import IdlStruct
    from cyclonedds.pub import DataWriter
    from cyclonedds.sub import DataReader
    from cyclonedds.topic import Topic

    text = make_dataclass("Text", [("data", str)], bases=(IdlStruct,))
    qos = Qos(Policy.Reliability.Reliable(10**9), Policy.History.KeepLast(10))
    participant = DomainParticipant(int(os.environ.get("ROS_DOMAIN_ID", "0")))
    reader = DataReader(participant, Topic(participant, read, text), qos=qos)
    writer = DataWriter(participant, Topic(participant, written, text), qos=qos)
    waitset = WaitSet(participant)
    waitset.attach(ReadCondition(reader, SampleState.Any | ViewState.Any | InstanceState.Any))

    def take() -> list[Any]:
        waitset.wait(10**10)
        return [sample for sample in reader.take(10) if isinstance(sample, text)]

    return text, writer, take


def dds_echo() -> None:
    _, writer, take = _dds("floor_ping", "floor_pong")
    threading.Thread(target=lambda: (sys.stdin.read(), os._exit(0)), daemon=True).start()
    say_ready()
    while True:
        for sample in take():
            writer.write(sample)


def dds_ping() -> None:
    text, writer, take = _dds("floor_pong", "floor_ping")
    message, times = text(data="x" * 64), []
    time.sleep(2 * SETTLE_S)
    for _ in range(ROUND_TRIPS + WARM):
        begin = time.perf_counter()
        writer.write(message)
        while not take():
            """What came was no message."""
        times.append(time.perf_counter() - begin)
    report(times=times[WARM:])


ROLES: dict[str, Callable[..., None]] = {
    role.__name__: role
    for role in (
        zenoh_echo, zenoh_ping, rmw_echo, rmw_ping, zenoh_call, rmw_call, zenoh_count, zenoh_flood, dds_echo, dds_ping,
        sleep_1khz,
    )
}  # fmt: skip

if __name__ == "__main__":
    ROLES[sys.argv[1]](*sys.argv[2:])
