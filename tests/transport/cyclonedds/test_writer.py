"""The queue of a writer, whose library refuses samples as long as the test says."""

from __future__ import annotations

import ctypes as c
import threading
from typing import Any

import pytest

pytest.importorskip("cyclonedds", reason="the extra 'dds' is not installed")

from daidalos.transport.cyclonedds.library import RETCODE_TIMEOUT
from daidalos.transport.cyclonedds.writer import Writer

TIMEOUT_S = 30.0


class Congested:
    """The library's functions that a writer calls; samples are taken while `reader` is set."""

    def __init__(self) -> None:
        self.reader = threading.Event()
        self.taken: list[int] = []
        self.arrived = threading.Condition()

    def check(self, code: int, what: str) -> int:
        return code

    def dds_get_entity_sertype(self, entity: int, found: Any) -> int:
        return 0

    def ddsi_serdata_from_ser_iov(self, kind: Any, form: int, count: int, buffers: Any, size: int) -> bytes:
        return c.string_at(buffers._obj.base, size)

    def dds_writecdr(self, entity: int, sample: bytes) -> int:
        if not self.reader.wait(0.001):
            return RETCODE_TIMEOUT
        with self.arrived:
            self.taken.append(int.from_bytes(sample, "little"))
            self.arrived.notify_all()
        return 0

    def dds_wait_for_acks(self, entity: int, timeout_ns: int) -> int:
        return 0

    def dds_delete(self, entity: int) -> int:
        return 0


def write(writer: Writer, number: int) -> None:
    writer.write([number.to_bytes(4, "little")])


@pytest.mark.parametrize("limit", [1, 2])
def test_samples_follow_a_full_queue_that_was_emptied_during_the_wait_for_room(limit: int) -> None:
    library: Any = Congested()
    writer = Writer(library, 1, "/topic", limit)
    sent = 0
    for _ in range(50):
        library.reader.clear()
        for number in range(sent + 1, sent + limit + 1):  # fills the queue
            write(writer, number)
        sent += limit
        waiting = threading.Thread(target=write, args=(writer, sent + 1))
        waiting.start()
        library.reader.set()
        waiting.join(TIMEOUT_S)
        write(writer, sent + 2)
        sent += 2
        with library.arrived:
            assert library.arrived.wait_for(lambda: len(library.taken) == sent, TIMEOUT_S), library.taken[-5:]  # noqa: B023
    assert library.taken == list(range(1, sent + 1))
    assert writer.dropped == 0
    assert writer.wait_for_acks(None)
    writer.close()


def test_a_full_queue_without_a_reader_keeps_the_newest_samples(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("daidalos.transport.cyclonedds.writer._ROOM_TIMEOUT_NS", 1_000_000)
    library: Any = Congested()
    writer = Writer(library, 1, "/topic", 3)
    for number in range(1, 11):
        write(writer, number)
    assert 6 <= writer.dropped <= 7  # one may be on its way
    library.reader.set()
    write(writer, 11)
    assert writer.wait_for_acks(int(TIMEOUT_S * 1e9))
    assert library.taken[-3:] == [9, 10, 11]
    writer.close()
