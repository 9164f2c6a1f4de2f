"""Predefined routines on sockets, all of them on this machine's loopback."""

from __future__ import annotations

import contextlib
import ipaddress
import socket
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from daidalos.industry.rapid.runtime.bytes import MAX_RAW_BYTES
from daidalos.industry.rapid.runtime.errors import RapidError
from daidalos.industry.rapid.runtime.registry import routine
from daidalos.industry.rapid.runtime.values import MAX_STRING, Handle

if TYPE_CHECKING:
    from daidalos.industry.rapid.runtime.task import Task

LOOPBACK = "127.0.0.1"
TIMEOUT = 60.0
"""Seconds of real time that a program waits, where it does not say."""
FOREVER = 9e8

CREATED, CONNECTED, BOUND, LISTENING, CLOSED = 0.0, 1.0, 2.0, 3.0, 4.0


@contextlib.contextmanager
def _named(what: str) -> Iterator[None]:
    """Raise errors of the system as those of a controller."""
    try:
        yield
    except TimeoutError:
        raise RapidError("ERR_SOCK_TIMEOUT", f"{what}: no answer in time") from None
    except OSError as error:
        in_use = "in use" in str(error).lower()
        raise RapidError("ERR_SOCK_ADDR_INUSE" if in_use else "ERR_SOCK_CLOSED", f"{what}: {error}") from None


def _socket(handle: Handle) -> socket.socket:
    if handle.state is None:
        raise RapidError("ERR_SOCK_CLOSED", "the socket is not open; SocketCreate comes first")
    found: socket.socket = handle.state[0]
    return found


def _timeout(found: socket.socket, seconds: float | None) -> None:
    limit = TIMEOUT if seconds is None else seconds
    found.settimeout(None if limit >= FOREVER else max(limit, 0.001))


@routine("SocketCreate")
def create(task: Task, socket_: Handle, udp_: Any = None) -> None:
    """Create a socket."""
    if socket_.state is not None:
        raise RapidError("ERR_SOCK_UNSPEC", "the socket is open already")
    found = socket.socket(socket.AF_INET, socket.SOCK_DGRAM if udp_ else socket.SOCK_STREAM)
    found.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    _keep(task, socket_, found, CREATED)


def _keep(task: Task, handle: Handle, found: socket.socket, status: float) -> None:
    handle.state = [found, status]
    task.resources.append(found)


@routine("SocketBind")
def bind(task: Task, socket_: Handle, localaddress_: str, localport_: float) -> None:
    """Bind a socket to a port of the loopback, whatever the address of the controller's own is."""
    with _named(f"port {localport_:g}"):
        _socket(socket_).bind((LOOPBACK, int(localport_)))
    socket_.state[1] = BOUND


@routine("SocketListen")
def listen(task: Task, socket_: Handle) -> None:
    """Listen for clients."""
    with _named("SocketListen"):
        _socket(socket_).listen()
    socket_.state[1] = LISTENING


@routine("SocketAccept")
def accept(
    task: Task, socket_: Handle, clientsocket_: Handle, clientaddress_: Any = None, time_: float | None = None
) -> None:
    """Wait for a client."""
    if clientsocket_.state is not None:
        raise RapidError("ERR_SOCK_UNSPEC", "the client's socket is open already")
    server = _socket(socket_)
    _timeout(server, time_)
    with task.waiting(), _named("SocketAccept"):
        found, address = server.accept()
    _keep(task, clientsocket_, found, CONNECTED)
    if clientaddress_ is not None:
        clientaddress_[0][clientaddress_[1]] = address[0]
    task.pass_time(0.0)


@routine("SocketConnect")
def connect(task: Task, socket_: Handle, address_: str, port_: float, time_: float | None = None) -> None:
    """Connect to a server on this machine."""
    if not _is_loopback(address_):
        raise RapidError("ERR_SOCK_ADDR_INVALID", f"'{address_}' is not this machine; programs talk on 127.0.0.1 only")
    client = _socket(socket_)
    _timeout(client, time_)
    with task.waiting(), _named(f"{address_}:{port_:g}"):
        client.connect((LOOPBACK, int(port_)))
    socket_.state[1] = CONNECTED
    task.pass_time(0.0)


def _is_loopback(address: str) -> bool:
    try:
        return ipaddress.ip_address(address).is_loopback
    except ValueError:
        return address == "localhost"


@routine("SocketSend")
def send(
    task: Task,
    socket_: Handle,
    str_: str | None = None,
    rawdata_: Handle | None = None,
    data_: list[float] | None = None,
    noofbytes_: float | None = None,
) -> None:
    """Send a string, raw bytes or an array of bytes."""
    content = _content(str_, rawdata_, data_)
    with _named("SocketSend"):
        _socket(socket_).sendall(content if noofbytes_ is None else content[: int(noofbytes_)])
    task.pass_time(0.0)


def _content(text: str | None, raw: Handle | None, data: list[float] | None) -> bytes:
    if text is not None:
        return text.encode("latin-1", "replace")
    return bytes(raw.state or b"") if raw is not None else bytes(int(one) & 0xFF for one in data or ())


@routine("SocketReceive")
def receive(
    task: Task,
    socket_: Handle,
    str_: Any = None,
    rawdata_: Handle | None = None,
    data_: list[float] | None = None,
    readnoofbytes_: float | None = None,
    norecbytes_: Any = None,
    time_: float | None = None,
) -> None:
    """Wait for bytes, and take them as a string, raw bytes or an array."""
    found = _socket(socket_)
    _timeout(found, time_)
    most = MAX_STRING if str_ is not None else MAX_RAW_BYTES
    with task.waiting(), _named("SocketReceive"):
        content = _exactly(found, int(readnoofbytes_)) if readnoofbytes_ else found.recv(most)
    if not content:
        raise RapidError("ERR_SOCK_CLOSED", "the other side has closed the connection")
    if str_ is not None:
        str_[0][str_[1]] = content.decode("latin-1")
    elif rawdata_ is not None:
        rawdata_.state = bytearray(content)
    elif data_ is not None:
        data_[: len(content)] = [float(one) for one in content[: len(data_)]]
    if norecbytes_ is not None:
        norecbytes_[0][norecbytes_[1]] = float(len(content))
    task.pass_time(0.0)


def _exactly(found: socket.socket, count: int) -> bytes:
    content = b""
    while len(content) < count:
        more = found.recv(count - len(content))
        if not more:
            return b""
        content += more
    return content


@routine("SocketClose")
def close(task: Task, socket_: Handle) -> None:
    """Close a socket; one that is closed stays so."""
    if socket_.state is not None:
        socket_.state[0].close()
        socket_.state = None


@routine("SocketGetStatus")
def status(task: Task, socket_: Handle) -> float:
    """Return what a socket does."""
    return float(socket_.state[1]) if socket_.state is not None else CLOSED


@routine("SocketPeek")
def peek(task: Task, socket_: Handle) -> float:
    """Return how many bytes can be received at once."""
    found = _socket(socket_)
    found.settimeout(0.0)
    try:
        return float(len(found.recv(MAX_RAW_BYTES, socket.MSG_PEEK)))
    except OSError:
        return 0.0
