"""Numbers are given again, but not at once and only to what is alike."""

from __future__ import annotations

import pytest

from daidalos.transport.zenoh import numbers
from daidalos.transport.zenoh.numbers import Numbers


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    now = [100.0]
    monkeypatch.setattr(numbers.time, "monotonic", lambda: now[0])
    return now


def test_numbers_differ_while_they_are_held():
    given = Numbers()
    assert len({given.take("a") for _ in range(100)}) == 100


def test_a_number_rests_before_it_is_given_again_to_the_like(clock):
    given = Numbers()
    first = given.take("a")
    given.give_back("a", first)
    assert given.take("a") != first
    clock[0] += 10.0
    assert given.take("b") != first
    assert given.take("a") == first
    assert given.take("a") != first


def test_what_is_remembered_is_limited(clock, monkeypatch):
    monkeypatch.setattr(numbers, "_MAX_ENTITIES", 3)
    given = Numbers()
    for name in "abcd":
        given.give_back(name, given.take(name))
    clock[0] += 10.0
    assert given.take("d") == 3
    assert given.take("a") == 4
