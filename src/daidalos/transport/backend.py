"""Contract between sessions and middlewares, implemented by the zenoh, DDS and in-process backends.

A backend carries bytes between processes and keeps the graph informed of what others declare. Delivery within
the process, matching by QoS and decoding are the session's, so that they are alike everywhere.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple, Protocol

from daidalos.transport.graph import EndpointInfo, EndpointKind, Graph, NodeInfo
from daidalos.transport.qos import Qos


class SampleInfo(NamedTuple):
    """Metadata of a sample; stamps are Unix time in nanoseconds."""

    source_ns: int
    received_ns: int
    sequence: int
    gid: bytes


class RequestId(NamedTuple):
    """Identity of a service request: the client's gid and its request counter."""

    client: bytes
    sequence: int


class BackendPublisher(ABC):
    """Sender of a topic's samples to other processes."""

    @abstractmethod
    def put(self, parts: list[Any], sequence: int, stamp_ns: int) -> None:
        """Send one sample, given as buffers to be concatenated."""

    @property
    def has_readers(self) -> bool:
        """Whether the middleware itself knows of readers in other processes, before the graph names their nodes."""
        return False

    def watch_readers(self, on_change: Callable[[], None]) -> None:  # noqa: B027 - few middlewares know
        """Call `on_change`, on any thread, when `has_readers` has changed."""

    def wait_for_acks(self, timeout_ns: int | None) -> bool:
        """Wait until all reliable subscribers have acknowledged every sample; return False on timeout.

        True at once where nobody acknowledges: that a sample was sent is all that there is to know.
        """
        return True

    @abstractmethod
    def close(self) -> None:
        """Stop publishing."""


class BackendSubscription(ABC):
    """Receiver of a topic's samples from other processes.

    Samples are handed on as the backend's own objects, so that the receiving thread does next to nothing; the
    thread that takes them asks for their bytes.
    """

    @abstractmethod
    def data(self, sample: Any) -> bytes:
        """Return a sample's bytes."""

    @abstractmethod
    def info(self, sample: Any, received_ns: int) -> SampleInfo:
        """Return the metadata of a sample."""

    @abstractmethod
    def close(self) -> None:
        """Stop receiving."""


class BackendService(ABC):
    """Receiver of a service's requests from other processes, which it answers."""

    @abstractmethod
    def request(self, item: Any) -> tuple[bytes, RequestId, int]:
        """Return a request's bytes, its identity and its source stamp."""

    @abstractmethod
    def reply(self, request: RequestId, data: bytes) -> None:
        """Answer a request; requests of a client that is gone are ignored."""

    @abstractmethod
    def close(self) -> None:
        """Stop serving."""


class BackendClient(ABC):
    """Sender of a service's requests to other processes."""

    @abstractmethod
    def send(self, data: bytes, sequence: int, stamp_ns: int) -> None:
        """Send a request; the response goes to the callback given at declaration."""

    @abstractmethod
    def response(self, item: Any) -> tuple[bytes, int, int]:
        """Return a response's bytes, the sequence number of its request and its source stamp."""

    @abstractmethod
    def close(self) -> None:
        """Stop; outstanding responses are dropped."""


class Receiver(Protocol):
    """Receiving of samples, done by whoever has entered, and by a thread of the backend's own where nobody does."""

    def enter(self) -> bool:
        """Take over receiving; return False where another thread does it at the moment."""

    def wait(self, timeout_ns: int) -> Sequence[int]:
        """Wait until something comes or `wake` is called, at most so long; return it for `handle`."""

    def handle(self, numbers: Sequence[int]) -> None:
        """Pass on what `wait` has returned, without waiting for room in a queue."""

    def leave(self) -> None:
        """Stop receiving."""

    def wake(self) -> None:
        """End the wait; from any thread."""


class Backend(ABC):
    """Membership in a domain through one middleware."""

    identifier: str
    """Such as ``rmw_zenoh_cpp``."""
    wide: int
    """Bytes that a character of a wide string takes on this wire."""
    receiver: Receiver | None = None
    """Lets a thread that waits anyway receive; None where only the middleware's own threads do."""

    @abstractmethod
    def start(self, graph: Graph) -> None:
        """Join the domain; report the declarations of other processes to `graph` from now on."""

    @abstractmethod
    def close(self) -> None:
        """Leave the domain; everything still declared is undeclared."""

    @abstractmethod
    def settle(self, timeout_s: float) -> bool:
        """Wait until every known peer has declared its entities; return False on timeout."""

    @abstractmethod
    def identify(
        self, kind: EndpointKind, node: NodeInfo, name: str, type_name: str, type_hash: str, qos: Qos
    ) -> tuple[str, bytes]:
        """Return a new endpoint's key in the graph and its gid."""

    @abstractmethod
    def new_node(self, name: str, namespace: str, enclave: str) -> NodeInfo:
        """Return the description of a new local node."""

    @abstractmethod
    def declare_node(self, node: NodeInfo) -> Callable[[], None]:
        """Declare a local node to others; call the result to undeclare it."""

    @abstractmethod
    def declare_publisher(self, key: str, endpoint: EndpointInfo) -> BackendPublisher:
        """Declare a publisher."""

    @abstractmethod
    def declare_subscription(
        self, key: str, endpoint: EndpointInfo, on_sample: Callable[..., Any]
    ) -> BackendSubscription:
        """Declare a subscription; `on_sample` is called on the receiving thread.

        It may wait for room in the subscription's queue, or, with ``may_wait=False``, refuse a sample by returning
        False; it is then to be offered again.
        """

    @abstractmethod
    def declare_service(self, key: str, endpoint: EndpointInfo, on_request: Callable[[Any], None]) -> BackendService:
        """Declare a service; `on_request` is called on the receiving thread."""

    @abstractmethod
    def declare_client(self, key: str, endpoint: EndpointInfo, on_response: Callable[[Any], None]) -> BackendClient:
        """Declare a client; `on_response` is called on the receiving thread."""
