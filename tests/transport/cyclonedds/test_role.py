"""Handing over of receiving between its own thread and executors that wait."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager

import pytest

pytest.importorskip("cyclonedds")

from daidalos.transport.cyclonedds.role import Role

_TIMEOUT_S = 10


class _Owner:
    """The own thread of a role; `turns` counts how often it has begun."""

    def __init__(self) -> None:
        self.role = Role()
        self.turns = threading.Semaphore(0)
        self.go_on = threading.Semaphore(0)
        self._ended = False
        self._thread = threading.Thread(target=self._run)
        self._thread.start()

    def _run(self) -> None:
        while not self._ended:
            with self.role.own():
                self.turns.release()
                self.go_on.acquire(timeout=_TIMEOUT_S)
            self.role.stand_by()

    def end(self) -> None:
        self._ended = True
        self.role.end()
        self.go_on.release()
        self._thread.join(_TIMEOUT_S)
        assert not self._thread.is_alive()


@pytest.fixture
def owner() -> Iterator[_Owner]:
    made = _Owner()
    yield made
    made.end()


@contextmanager
def _visit(role: Role) -> Iterator[None]:
    while not role.enter():
        """The own thread has it."""
    yield
    role.leave()


def test_who_finds_it_taken_is_refused_and_wanted(owner: _Owner):
    assert owner.turns.acquire(timeout=_TIMEOUT_S)
    assert not owner.role.is_wanted
    assert not owner.role.enter()
    assert owner.role.is_wanted
    owner.go_on.release()
    with _visit(owner.role):
        assert not owner.role.is_wanted
        assert not owner.role.enter()


def test_the_own_thread_goes_on_when_the_visitor_stays_away(owner: _Owner):
    assert owner.turns.acquire(timeout=_TIMEOUT_S)
    owner.go_on.release()
    for _ in range(3):  # after visits that follow one another as well
        with _visit(owner.role):
            """Enter and leave at once."""
    assert owner.turns.acquire(timeout=_TIMEOUT_S)


def test_the_own_thread_goes_on_after_a_long_visit(owner: _Owner):
    assert owner.turns.acquire(timeout=_TIMEOUT_S)
    owner.go_on.release()
    with _visit(owner.role):
        assert not owner.turns.acquire(timeout=0.1)
    assert owner.turns.acquire(timeout=_TIMEOUT_S)


def test_what_is_given_back_is_taken_at_once(owner: _Owner):
    assert owner.turns.acquire(timeout=_TIMEOUT_S)
    owner.go_on.release()
    while not owner.role.enter():
        """The own thread has it."""
    owner.role.give_back()
    assert owner.turns.acquire(timeout=_TIMEOUT_S)


def test_nobody_enters_after_the_end():
    owner = _Owner()
    owner.end()
    assert not owner.role.enter()
    owner.role.wait_until_free(_TIMEOUT_S)
