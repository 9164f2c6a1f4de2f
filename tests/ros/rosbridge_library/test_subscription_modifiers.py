"""Pace of messages to one client."""

from __future__ import annotations

import threading
from typing import Any

from rosbridge_library.internal.subscription_modifiers import (
    MessageHandler,
    QueueMessageHandler,
    ThrottleMessageHandler,
)

HOUR_MS = 3_600_000


def test_messages_that_come_too_early_are_dropped() -> None:
    got: list[Any] = []
    handler = MessageHandler(None, got.append).set_throttle_rate(HOUR_MS)
    assert isinstance(handler, ThrottleMessageHandler)
    for number in range(3):
        handler.handle_message(number)
    assert got == [0]
    handler = handler.set_throttle_rate(0)
    handler.handle_message(3)
    assert got == [0, 3]


def test_the_newest_messages_wait() -> None:
    got: list[Any] = []
    came = threading.Semaphore(0)

    def publish(message: Any) -> None:
        got.append(message)
        came.release()

    handler = MessageHandler(None, publish).set_throttle_rate(HOUR_MS).set_queue_length(2)
    assert isinstance(handler, QueueMessageHandler)
    handler.handle_message("first")
    assert came.acquire(timeout=60.0)
    for number in range(5):
        handler.handle_message(number)
    assert got == ["first"]
    handler = handler.set_throttle_rate(0)
    assert came.acquire(timeout=60.0)
    assert came.acquire(timeout=60.0)
    assert got == ["first", 3, 4]
    handler.finish()
    handler.handle_message("late")
    assert got == ["first", 3, 4]


def test_an_error_of_the_client_does_not_end_the_handler() -> None:
    came = threading.Event()

    def publish(message: Any) -> None:
        if message == "bad":
            raise ValueError(message)
        came.set()

    handler = MessageHandler(None, publish).set_queue_length(4)
    handler.handle_message("bad")
    handler.handle_message("good")
    assert came.wait(60.0)
    handler.finish()
