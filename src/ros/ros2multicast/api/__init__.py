"""UDP multicast, to test whether the network supports it."""

from __future__ import annotations

import socket
import struct
from argparse import ArgumentTypeError

DEFAULT_GROUP = "225.0.0.1"
DEFAULT_PORT = 49150
_LARGEST = 4096


def send(data: bytes, *, group: str = DEFAULT_GROUP, port: int = DEFAULT_PORT, ttl: int | None = None) -> None:
    """Send one datagram to a multicast group.

    Parameters
    ----------
    data
        Content of the datagram.
    group, port
        Multicast address and UDP port.
    ttl
        Number of routers that it may pass; that of the system where None.
    """
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        if ttl is not None:
            sender.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, struct.pack("b", ttl))
        sender.sendto(data, (group, port))


def open_receiver(group: str = DEFAULT_GROUP, port: int = DEFAULT_PORT) -> socket.socket:
    """Return a socket that has joined a multicast group."""
    receiver = socket.socket(socket.AF_INET, socket.SOCK_DGRAM, socket.IPPROTO_UDP)
    try:
        receiver.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        if hasattr(socket, "SO_REUSEPORT"):
            receiver.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEPORT, 1)
        receiver.bind(("", port))
        membership = struct.pack("=4sl", socket.inet_aton(group), socket.INADDR_ANY)
        receiver.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, membership)
    except OSError:
        receiver.close()
        raise
    return receiver


def receive(
    *, group: str = DEFAULT_GROUP, port: int = DEFAULT_PORT, timeout: float | None = None
) -> tuple[bytes, tuple[str, int]]:
    """Wait for a datagram of a multicast group; return it with the sender's address and port.

    Parameters
    ----------
    group, port
        Multicast address and UDP port.
    timeout
        How long to wait [s]; without limit where None.

    Raises
    ------
    TimeoutError
        When none arrives in time.
    """
    with open_receiver(group, port) as receiver:
        receiver.settimeout(timeout)
        return receive_from(receiver)


def receive_from(receiver: socket.socket) -> tuple[bytes, tuple[str, int]]:
    """Wait for a datagram on a socket of `open_receiver`; return it with the sender's address and port."""
    data, (host, port) = receiver.recvfrom(_LARGEST)
    return data, (host, port)


def hops(text: str) -> int:
    """Return a time to live; for argparse."""
    value = int(text) if text.isascii() and text.isdigit() else -1
    if not 0 <= value <= 127:
        raise ArgumentTypeError("value must be an integer from 0 to 127")
    return value
