"""Numbers are given again, but not at once and only to what is alike."""

from __future__ import annotations

import pytest

from daidalos.transport.zenoh import entity_ids
from daidalos.transport.zenoh.entity_ids import EntityIds


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    now = [100.0]
    monkeypatch.setattr(entity_ids.time, "monotonic", lambda: now[0])
    return now


def test_numbers_differ_while_they_are_held():
    given = EntityIds()
    assert len({given.acquire("a") for _ in range(100)}) == 100


def test_a_number_rests_before_it_is_given_again_to_the_like(clock):
    given = EntityIds()
    first = given.acquire("a")
    given.release("a", first)
    assert given.acquire("a") != first
    clock[0] += 10.0
    assert given.acquire("b") != first
    assert given.acquire("a") == first
    assert given.acquire("a") != first


def test_what_is_remembered_is_limited(clock, monkeypatch):
    monkeypatch.setattr(entity_ids, "_MAX_ENTITIES", 3)
    given = EntityIds()
    for name in "abcd":
        given.release(name, given.acquire(name))
    clock[0] += 10.0
    assert given.acquire("d") == 3
    assert given.acquire("a") == 4
