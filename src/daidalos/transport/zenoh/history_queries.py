"""Queries of other sessions' caches, shared by all subscriptions of a topic."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from typing import Any, Protocol

import zenoh
from zenoh.handlers import Callback

from daidalos.transport.zenoh.worker import Worker

_TIMEOUT_S = 5.0
"""Timeout of a session's answer; the query is repeated as long as the session is reachable."""


class Asker(Protocol):
    """Subscription that a query is made for."""

    limit: int | None
    """So many of each publisher's samples are asked for; all where None."""

    def merge(self, session: str, samples: list[Any], complete: bool) -> None:
        """Receive the answers of a session; `complete` is False if some did not come in time."""


class HistoryQueries:
    """Queries of sessions for the kept samples of topics, one at a time for each topic and session.

    Subscriptions that ask while a query of their topic is under way share the next one: a thousand subscriptions of
    a topic cost a few queries.

    Parameters
    ----------
    session
        The zenoh session.
    worker
        Where queries are sent and their answers are merged.
    """

    def __init__(self, session: zenoh.Session, worker: Worker) -> None:
        self._session = session
        self._worker = worker
        # Both are used in the worker's thread alone.
        self._waiting: dict[tuple[str, str], dict[Asker, None]] = {}
        self._pending: set[tuple[str, str]] = set()

    def request(self, key: str, session: str, asker: Asker) -> None:
        """Query a session for a topic's kept samples, which are passed to ``asker.merge`` on the worker's thread."""
        self._worker.submit(lambda: self._add((key, session), asker))

    def _add(self, place: tuple[str, str], asker: Asker) -> None:
        self._waiting.setdefault(place, {})[asker] = None
        if place not in self._pending:
            # Whoever has asked by now shares the query.
            self._pending.add(place)
            self._worker.submit(lambda: self._send(place))

    def _send(self, place: tuple[str, str]) -> None:
        askers = tuple(self._waiting.pop(place))
        limits = [asker.limit for asker in askers]
        samples: list[Any] = []
        failed: list[Any] = []

        def on_reply(reply: zenoh.Reply) -> None:
            if reply.ok is not None:
                samples.append(reply.ok)
            else:
                failed.append(reply)

        def on_end() -> None:
            self._worker.submit(lambda: self._finish(place, askers, samples, not failed))

        key, session = place
        parameters = "" if None in limits else f"?_max={max(limit for limit in limits if limit is not None)}"
        with contextlib.suppress(zenoh.ZError):  # the session may have been closed
            self._session.get(
                f"{key}/@adv/pub/{session}/**{parameters}",
                Callback(on_reply, on_end, indirect=False),
                target=zenoh.QueryTarget.ALL,
                consolidation=zenoh.ConsolidationMode.NONE,
                accept_replies=zenoh.ReplyKeyExpr.ANY,
                timeout=_TIMEOUT_S,
                allowed_destination=zenoh.Locality.REMOTE,
            )

    def _finish(self, place: tuple[str, str], askers: tuple[Asker, ...], samples: list[Any], complete: bool) -> None:
        self._pending.discard(place)
        if place in self._waiting:
            self._pending.add(place)
            self._worker.submit(lambda: self._send(place))
        for asker in askers:
            asker.merge(place[1], samples, complete)


Request = Callable[[str, str, Asker], None]
"""`HistoryQueries.request`."""
