"""Shared memory for large messages: found again when it is free, and done without where it is not."""

from __future__ import annotations

import os

import pytest
import zenoh

from daidalos.transport.zenoh import pool as module
from daidalos.transport.zenoh.config import shared_memory_usable
from daidalos.transport.zenoh.pool import SHM_THRESHOLD, Pool

MIB = 2**20

needs_memory = pytest.mark.skipif(not shared_memory_usable(), reason="there is not enough shared memory")


@needs_memory
def test_a_large_message_lies_in_shared_memory_unchanged():
    data = os.urandom(SHM_THRESHOLD + 3)
    held = zenoh.ZBytes(Pool(enabled=True).place(data))
    assert held.as_shm() is not None
    assert held.to_bytes() == data


def test_small_messages_and_sessions_without_shared_memory_are_left_alone(monkeypatch: pytest.MonkeyPatch):
    small, large = bytes(SHM_THRESHOLD - 1), bytes(SHM_THRESHOLD)
    assert Pool(enabled=True).place(small) is small
    assert Pool(enabled=False).place(large) is large
    monkeypatch.setattr(module, "shared_memory_usable", lambda: False)
    assert Pool(enabled=True).place(large) is large


@needs_memory
def test_what_finds_no_room_is_left_alone_until_there_is_some():
    pool, data = Pool(enabled=True), bytes(3 * MIB)
    held = [pool.place(data) for _ in range(6)]
    assert held[0] is not data
    assert held[-1] is data
    held.clear()
    assert pool.place(data) is not data
    assert pool.place(bytes(MIB)) is not None
    beyond = bytes(17 * MIB)
    assert pool.place(beyond) is beyond


@needs_memory
def test_memory_that_stays_full_is_replaced_ever_later(monkeypatch: pytest.MonkeyPatch):
    now = 0.0
    monkeypatch.setattr(module.time, "monotonic", lambda: now)
    pool, data = Pool(enabled=True), bytes(4 * MIB)
    lost, waited = [], []
    for _ in range(2):
        while (placed := pool.place(data)) is not data:
            lost.append(placed)
        begin = now
        while (placed := pool.place(data)) is data:
            now += 0.5
        lost.append(placed)
        waited.append(now - begin)
    assert 1.0 < waited[0] <= 2.0 < waited[1] <= 3.0


@needs_memory
def test_memory_of_messages_of_many_sizes_is_found_again():
    pool = Pool(enabled=True)
    for number in range(200):
        data = bytes((number * 7919 % 60 + 1) * 2**16)
        assert pool.place(data) is not data
