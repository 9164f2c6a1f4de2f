"""Transient-local topics over zenoh: caches of publishers and queries of late subscriptions.

On the wire this is the protocol of zenoh's advanced publishers and subscribers, so that rmw_zenoh's nodes and ours
have each other's histories. Zenoh's own leave something behind in every process, some kilobytes for each publisher
that comes and goes, since its number becomes part of a key, and no number is given again. Here all publishers of a
topic in a session share one key, as zenoh allows for those that order their samples by time stamps; and who is there
to be asked, subscriptions learn from the graph.
"""

from __future__ import annotations

import contextlib
import threading
import time
from collections import Counter, deque
from collections.abc import Callable, Iterable
from typing import Any

import zenoh
from zenoh.handlers import Callback

from daidalos.transport.graph import EndpointInfo
from daidalos.transport.zenoh import attachment
from daidalos.transport.zenoh.endpoints import ZenohPublisher, ZenohSubscription
from daidalos.transport.zenoh.history_queries import Request
from daidalos.transport.zenoh.pool import Pool
from daidalos.transport.zenoh.threads import on_lasting_thread
from daidalos.transport.zenoh.worker import Worker

_MAX_PUBLISHERS = 10_000
"""Maximum number of publishers whose last samples are remembered."""

Kept = deque[tuple[bytes, bytes, zenoh.Timestamp]]
"""Last samples of a publisher: data, attachment and time stamp."""
Identity = tuple[int, int, bytes]
"""Number and source time of a sample, and its publisher's gid."""


class Caches:
    """Caches of a session, one for each topic."""

    def __init__(self, session: zenoh.Session, worker: Worker) -> None:
        self._session = session
        self._worker = worker
        self._lock = threading.Lock()
        self._caches: dict[str, Cache] = {}

    def enter(self, key: str, publisher: LatchedPublisher) -> Cache:
        """Add a publisher to the cache of its topic, and return the cache."""
        with self._lock:
            cache = self._caches.get(key)
            if cache is None:
                cache = self._caches[key] = Cache(self._session, key, self._worker)
            cache.publishers[publisher] = None
            return cache

    def leave(self, key: str, publisher: LatchedPublisher) -> None:
        """Remove a publisher's samples."""
        with self._lock:
            cache = self._caches[key]
            del cache.publishers[publisher]
            if not cache.publishers:
                del self._caches[key]
                cache.close()


class Cache:
    """Queryable for the kept samples of a topic's publishers.

    Attributes
    ----------
    publishers
        Whose samples; in the order in which they came.
    order
        Held while a sample is stamped and sent: receivers take one with an earlier stamp than the last for old.
    """

    def __init__(self, session: zenoh.Session, key: str, worker: Worker) -> None:
        self.publishers: dict[LatchedPublisher, None] = {}
        self.order = threading.RLock()
        self._key = key
        name = f"{key}/@adv/pub/{session.zid()}/uhlc/_"
        # Not on zenoh's thread, which reads what comes from the asker: it would wait for the asker to read.
        answer = Callback(on_lasting_thread(lambda query: worker.submit(lambda: self._answer(query))), indirect=False)
        self._queryable: Any = session.declare_queryable(name, answer, allowed_origin=zenoh.Locality.REMOTE)
        self._token: Any = session.liveliness().declare_token(name)

    def _answer(self, query: zenoh.Query) -> None:
        most = query.parameters.get("_max")
        count = int(most) if most is not None and most.isdecimal() else 0
        with contextlib.suppress(zenoh.ZError), query:  # who asked may be gone
            for publisher in tuple(self.publishers):
                for data, attached, stamp in tuple(publisher.kept)[-count:]:
                    query.reply(self._key, data, attachment=attached, timestamp=stamp)

    def close(self) -> None:
        """Stop answering queries."""
        with contextlib.suppress(zenoh.ZError):  # the session may have been closed before
            self._token.undeclare()
            self._queryable.undeclare()


class LatchedPublisher(ZenohPublisher):
    """Publisher that keeps its last samples for late subscriptions.

    Attributes
    ----------
    kept
        The last samples.
    """

    def __init__(self, session: zenoh.Session, key: str, endpoint: EndpointInfo, pool: Pool, caches: Caches) -> None:
        super().__init__(session, key, endpoint, pool)
        self.kept: Kept = deque(maxlen=endpoint.qos.limit)
        self._session = session
        self._key = key
        self._caches = caches
        self._cache = caches.enter(key, self)

    def put(self, parts: list[Any], sequence: int, stamp_ns: int) -> None:
        """Send one sample."""
        data = parts[0] if len(parts) == 1 else b"".join(parts)
        attached = attachment.pack(sequence, stamp_ns, self._gid)
        with self._lock, self._cache.order:
            if not self._closed:
                stamp = self._session.new_timestamp()
                self.kept.append((bytes(data), attached, stamp))
                self._publisher.put(self._pool.place(data), attachment=attached, timestamp=stamp)

    def close(self) -> None:
        """Undeclare, and remove the kept samples."""
        super().close()
        self._caches.leave(self._key, self)


class LatchedSubscription(ZenohSubscription):
    """Subscription that receives earlier samples first."""

    def __init__(
        self,
        session: zenoh.Session,
        key: str,
        endpoint: EndpointInfo,
        on_sample: Callable[[Any], None],
        request: Request,
    ) -> None:
        self._history = History(request, key, endpoint.qos.limit, on_sample)
        super().__init__(session, key, endpoint, self._history.accept)

    def request_history(self, session: str) -> None:
        """Query a session for the kept samples of its publishers, after one of them was added."""
        self._history.request_history(session)

    def close(self) -> None:
        """Undeclare."""
        self._history.close()
        super().close()


class HistoryQuery:
    """Pending query of a session's cache.

    Attributes
    ----------
    samples
        What was received from the session meanwhile.
    again
        Whether to ask again: there is one more publisher.
    """

    def __init__(self) -> None:
        self.samples: list[Any] = []
        self.again = False


class History:
    """Merger of kept and new samples, in order and without duplicates.

    Parameters
    ----------
    request
        Called with `key`, a session and this history to query the session; the answers go to `merge`.
    key
        Of the subscription.
    limit
        So many of each publisher's samples are asked for; all where None.
    deliver
        Called with one sample after the other.
    """

    def __init__(self, request: Request, key: str, limit: int | None, deliver: Callable[[zenoh.Sample], None]) -> None:
        self.limit = limit
        self._request = request
        self._key = key
        self._begin_ns = time.time_ns()
        self._deliver = deliver
        self._lock = threading.Lock()
        self._closed = False
        self._queries: dict[str, HistoryQuery | None] = {}  # by session; None where one was answered
        self._replied: dict[str, frozenset[Identity]] = {}
        self._last: dict[bytes, tuple[int, int]] = {}
        self._waiting: deque[zenoh.Sample] = deque()
        self._delivering = False

    def request_history(self, session: str) -> None:
        """Query a session for the kept samples of its publishers."""
        with self._lock:
            history_query = self._queries.get(session)
            if history_query is not None:
                history_query.again = True
                return
            self._queries[session] = HistoryQuery()
        self._ask(session)

    def accept(self, sample: zenoh.Sample) -> None:
        """Receive a sample."""
        stamp = sample.timestamp
        session = str(stamp.get_id()) if stamp is not None else ""
        with self._lock:
            unheard = bool(session) and session not in self._queries
            if unheard:  # it is here before its publisher is in the graph
                self._queries[session] = HistoryQuery()
            history_query = self._queries.get(session)
            if history_query is not None:
                history_query.samples.append(sample)
            elif (identity := _identity(sample)) not in self._replied.get(session, ()):
                self._note(identity)
                self._waiting.append(sample)
        if unheard:
            self._ask(session)
        self._deliver_waiting()

    def close(self) -> None:
        """Stop delivering."""
        with self._lock:
            self._closed = True
            self._waiting.clear()

    def _ask(self, session: str) -> None:
        if not self._closed:
            self._request(self._key, session, self)

    def merge(self, session: str, samples: list[Any], complete: bool) -> None:
        """Merge the answers of a session, and the samples that it sent meanwhile, in order.

        Parameters
        ----------
        session
            Whose answers.
        samples
            The kept samples.
        complete
            Whether all answers came in time.
        """
        with self._lock:
            history_query = self._queries[session]
            assert history_query is not None
            found = {_identity(sample): sample for sample in (*samples, *history_query.samples)}
            self._replied[session] = frozenset(found)
            for identity in self._wanted(filter(self._is_news, found)):
                self._note(identity)
                self._waiting.append(found[identity])
            again = history_query.again or not complete
            self._queries[session] = HistoryQuery() if again else None
        self._deliver_waiting()
        if again:
            self._ask(session)

    def _wanted(self, identities: Iterable[Identity]) -> list[Identity]:
        """Return samples in sending order, with at most as many from before the subscription as are kept.

        While a link is new, zenoh sends even what nobody has subscribed to yet.
        """
        ordered = sorted(identities, key=_source_time)
        later: Counter[bytes] = Counter(gid for _, _, gid in ordered)
        wanted = []
        for number, stamp, gid in ordered:
            later[gid] -= 1
            if stamp >= self._begin_ns or self.limit is None or later[gid] < self.limit:
                wanted.append((number, stamp, gid))
        return wanted

    def _is_news(self, identity: Identity) -> bool:
        """Return whether a sample was not delivered before the query and is not older than that."""
        number, stamp, gid = identity
        last = self._last.get(gid)
        return last is None or number > last[0] or stamp > last[1]  # a publisher that is made again counts from 1

    def _note(self, identity: Identity) -> None:
        number, stamp, gid = identity
        if len(self._last) >= _MAX_PUBLISHERS and gid not in self._last:
            del self._last[next(iter(self._last))]
        self._last[gid] = (number, stamp)

    def _deliver_waiting(self) -> None:
        """Deliver on one thread at a time without holding locks, since receivers may do anything."""
        while True:
            with self._lock:
                if self._delivering or not self._waiting or self._closed:
                    return
                self._delivering = True
                sample = self._waiting.popleft()
            try:
                self._deliver(sample)
            finally:
                self._delivering = False


def _identity(sample: zenoh.Sample) -> Identity:
    number, stamp_ns, gid = attachment.read(sample.attachment)
    stamp = sample.timestamp
    if not number and stamp is not None:  # a foreign sender's, known by zenoh's time stamp alone
        return 0, stamp.get_time_as_ntp64().as_nanos(), bytes(stamp.get_id())
    return number, stamp_ns, gid


def _source_time(identity: Identity) -> tuple[int, int]:
    return identity[1], identity[0]
