"""The queue between who receives and who takes: what is held back for it, and for whom nobody waits."""

from __future__ import annotations

import threading
import time
from typing import Any

import pytest
from std_msgs.msg import Int32

from daidalos.interfaces.codec import codec_of
from daidalos.transport import subscription as module
from daidalos.transport.backend import BackendSubscription, SampleInfo
from daidalos.transport.graph import EndpointInfo, EndpointKind, NodeInfo
from daidalos.transport.publisher import Publisher
from daidalos.transport.qos import Qos, Reliability
from daidalos.transport.subscription import Subscription

DEPTH = 5
BURST = 60
CODEC = codec_of(Int32)


class Remote(BackendSubscription):
    """Samples are their bytes."""

    def data(self, sample: Any) -> bytes:
        data: bytes = sample
        return data

    def info(self, sample: Any, received_ns: int) -> SampleInfo:
        return SampleInfo(0, received_ns, 0, bytes(16))

    def close(self) -> None:
        pass


class Receiver:
    """A subscription with a thread that hands it samples as fast as it takes them."""

    def __init__(self, reliability: Reliability = Reliability.RELIABLE) -> None:
        self.ready = threading.Semaphore(0)
        qos = Qos(depth=DEPTH, reliability=reliability)
        node = NodeInfo("key", "name", "/")
        endpoint = EndpointInfo(EndpointKind.SUBSCRIPTION, node, "/a", "std_msgs/msg/Int32", "", qos, bytes(16))
        self.subscription = Subscription(endpoint, CODEC, self.ready.release)
        self.subscription.attach(Remote(), lambda: None)

    def accept(self, count: int) -> None:
        for number in range(count):
            self.subscription.accept(CODEC.encode(Int32(data=number)))

    def take_burst(self) -> list[int]:
        """Take a burst that arrives meanwhile."""
        sender = threading.Thread(target=self.accept, args=(BURST,))
        sender.start()
        taken: list[int] = []
        while sender.is_alive() or len(self.subscription):
            if self.ready.acquire(timeout=0.01) and (item := self.subscription.take()):
                taken.append(item[0].data)
        sender.join()
        return taken


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """The time in nanoseconds, where the machine is never busy with anything else: every look at it takes 5 us."""
    times = [0]

    def look() -> int:
        times[0] += 5_000
        return times[0]

    monkeypatch.setattr(module.time, "monotonic_ns", look)
    monkeypatch.setattr(module, "_TIMEOUT_S", 5.0)
    monkeypatch.setattr(Subscription, "_gave_up_at", -module._SHORT_FOR_NS)
    return times


def test_a_burst_is_held_back_from_the_first_on(clock: list[int]):
    assert Receiver().take_burst() == list(range(BURST))


def test_a_pause_before_a_burst_makes_nobody_slow(clock: list[int]):
    receiver = Receiver()
    receiver.take_burst()
    clock[0] += 3_600_000_000_000
    assert receiver.take_burst() == list(range(BURST))


def test_who_stumbles_once_is_waited_for(clock: list[int]):
    receiver = Receiver()
    receiver.accept(DEPTH)
    receiver.subscription.take()
    clock[0] += 1_000_000_000
    receiver.subscription.take()
    assert receiver.take_burst()[-BURST:] == list(range(BURST))


@pytest.mark.timing
def test_who_does_not_take_is_waited_for_once(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(Subscription, "_gave_up_at", -module._SHORT_FOR_NS)
    receiver = Receiver()
    begin = time.monotonic()
    receiver.accept(DEPTH + BURST)
    assert module._TIMEOUT_S < time.monotonic() - begin < 3 * module._TIMEOUT_S
    left = [receiver.subscription.take() for _ in range(DEPTH)]
    assert [item[0].data for item in left if item] == list(range(BURST, DEPTH + BURST))


@pytest.mark.timing
def test_what_the_same_callback_stalls_is_waited_for_less(clock: list[int], monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(module, "_TIMEOUT_S", 0.8)
    times = []
    for _ in range(2):
        receiver = Receiver()
        begin = time.perf_counter()
        receiver.accept(DEPTH + BURST)
        times.append(time.perf_counter() - begin)
    assert times[0] >= 0.8 > times[1] >= module._SHORT_TIMEOUT_S


@pytest.mark.timing
def test_a_slow_callback_is_waited_for_no_more(clock: list[int]):
    receiver = Receiver()
    receiver.accept(DEPTH)
    for _ in range(DEPTH - 1):
        clock[0] += 20_000_000
        receiver.subscription.take()
    receiver.accept(DEPTH)
    before = time.perf_counter()
    receiver.accept(BURST)
    assert time.perf_counter() - before < module._TIMEOUT_S


@pytest.mark.timing
def test_best_effort_waits_for_nobody():
    receiver = Receiver(Reliability.BEST_EFFORT)
    before = time.perf_counter()
    receiver.accept(BURST)
    assert time.perf_counter() - before < module._TIMEOUT_S
    assert len(receiver.subscription) == DEPTH


def test_a_sink_gets_what_is_queued_and_then_every_sample_at_once() -> None:
    receiver = Receiver()
    receiver.accept(2)
    got: list[int] = []
    receiver.subscription.drain_into(lambda message: got.append(message.data))
    receiver.subscription.accept(CODEC.encode(Int32(data=7)))
    receiver.subscription.accept_local((Int32(data=8), 0, 0, bytes(16)))
    assert got == [0, 1, 7, 8]
    assert not len(receiver.subscription)


def test_sinks_share_a_message_that_queues_and_the_publisher_do_not() -> None:
    node = NodeInfo("key", "name", "/")
    publisher = Publisher(
        EndpointInfo(EndpointKind.PUBLISHER, node, "/a", "std_msgs/msg/Int32", "", Qos(depth=DEPTH), bytes(16)), CODEC
    )
    sinks, queues = [Receiver().subscription for _ in range(2)], [Receiver().subscription for _ in range(2)]
    got: list[Int32] = []
    for sink in sinks:
        sink.drain_into(got.append)
    publisher.add_targets((sinks[0], *queues, sinks[1]))
    sent = Int32(data=3)
    for message in (sent, CODEC.encode(sent)):
        got.clear()
        publisher.publish(message)
        taken = [item[0] for queue in queues if (item := queue.take())]
        assert got[0] is got[1]
        assert len({id(one) for one in (*taken, got[0], sent)}) == 4
        assert all(one == sent for one in (*taken, *got))


def test_a_sample_that_was_taken_before_the_end_keeps_its_time() -> None:
    receiver = Receiver()
    receiver.accept(1)
    taken = receiver.subscription.take()
    assert taken is not None
    receiver.subscription.detach()
    info = receiver.subscription.info(taken[1])
    assert info.received_ns == taken[1][2]
