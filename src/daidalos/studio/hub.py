"""The server's view of the graph: numbered channels and services, and one subscription for many clients."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeVar

from daidalos.studio.source import GraphSource, Handle, MessageCallback, Service, Topic

Entry = TypeVar("Entry", Topic, Service)


@dataclass(frozen=True)
class Changes:
    """What is new and what is gone since the last refresh."""

    topics: dict[int, Topic]
    topics_gone: dict[int, Topic]
    services: dict[int, Service]
    services_gone: dict[int, Service]


class Hub:
    """Numbers what the graph offers and shares subscriptions; lives in the server's event loop.

    A topic that changes its type, definition or durability becomes a new channel, so that clients
    subscribe again and receive the messages of latched topics.
    """

    def __init__(self, source: GraphSource) -> None:
        self._source = source
        self._numbers = itertools.count(1)
        self._shared: dict[int, _SharedSubscription] = {}
        self.topics: dict[int, Topic] = {}
        self.services: dict[int, Service] = {}

    def refresh(self) -> Changes:
        """Read the graph again and number what is new."""
        topics, topics_gone = self._update(self.topics, self._source.topics())
        services, services_gone = self._update(self.services, self._source.services())
        return Changes(topics, topics_gone, services, services_gone)

    def subscribe(self, channel: int, received: MessageCallback) -> Handle:
        """Subscribe to a channel; raises KeyError where there is none of this number.

        Clients share one subscription to the graph, except for latched topics: only a subscription of its own
        brings a client the messages that are kept.
        """
        topic = self.topics[channel]
        if topic.latched:
            return self._source.subscribe(topic, received)
        shared = self._shared.get(channel)
        if shared is None:
            shared = _SharedSubscription(lambda: self._shared.pop(channel, None))
            shared.open(self._source, topic)
            self._shared[channel] = shared
        return shared.join(received)

    def _update(self, known: dict[int, Entry], now: Sequence[Entry]) -> tuple[dict[int, Entry], dict[int, Entry]]:
        wanted = set(now)
        gone = {number: entry for number, entry in known.items() if entry not in wanted}
        for number in gone:
            del known[number]
        here = set(known.values())
        new = {next(self._numbers): entry for entry in dict.fromkeys(now) if entry not in here}
        known.update(new)
        return new, gone


class _SharedSubscription:
    """One subscription to the graph and the clients that share it."""

    def __init__(self, emptied: Callable[[], object]) -> None:
        self._emptied = emptied
        self._source: Handle | None = None
        # Replaced, never changed: the thread that delivers reads it without a lock.
        self._subscribers: tuple[_Subscriber, ...] = ()

    def open(self, source: GraphSource, topic: Topic) -> None:
        self._source = source.subscribe(topic, self._deliver)

    def join(self, received: MessageCallback) -> Handle:
        subscriber = _Subscriber(self, received)
        self._subscribers = (*self._subscribers, subscriber)
        return subscriber

    def leave(self, subscriber: _Subscriber) -> None:
        self._subscribers = tuple(each for each in self._subscribers if each is not subscriber)
        if not self._subscribers and self._source is not None:
            self._emptied()
            self._source.close()
            self._source = None

    def _deliver(self, nanoseconds: int, payload: bytes) -> None:
        for subscriber in self._subscribers:
            subscriber.received(nanoseconds, payload)


class _Subscriber:
    """One client's part in a shared subscription."""

    def __init__(self, shared: _SharedSubscription, received: MessageCallback) -> None:
        self._shared = shared
        self.received = received

    def close(self) -> None:
        self._shared.leave(self)
