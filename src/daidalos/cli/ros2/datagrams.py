"""UDP multicast, to test whether the network supports it."""

from __future__ import annotations

import socket
import struct
from argparse import ArgumentTypeError

GROUP = "225.0.0.1"
PORT = 49150
_LARGEST = 4096


def send(data: bytes, ttl: int | None = None) -> None:
    """Send one datagram to the group; `ttl` is the number of routers that it may pass."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        if ttl is not None:
            sender.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, struct.pack("b", ttl))
        sender.sendto(data, (GROUP, PORT))


def open_receiver() -> socket.socket:
    """Return a socket that has joined the group."""
    receiver = socket.socket(socket.AF_INET, socket.SOCK_DGRAM, socket.IPPROTO_UDP)
    try:
        receiver.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        if hasattr(socket, "SO_REUSEPORT"):
            receiver.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEPORT, 1)
        receiver.bind(("", PORT))
        membership = struct.pack("=4sl", socket.inet_aton(GROUP), socket.INADDR_ANY)
        receiver.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, membership)
    except OSError:
        receiver.close()
        raise
    return receiver


def receive(receiver: socket.socket) -> tuple[bytes, str, int]:
    """Wait for a datagram; return it with the sender's address and port."""
    data, (host, port) = receiver.recvfrom(_LARGEST)
    return data, host, port


def hops(text: str) -> int:
    """Return a time to live; argument type."""
    value = int(text) if text.isascii() and text.isdigit() else -1
    if not 0 <= value <= 127:
        raise ArgumentTypeError("value must be an integer from 0 to 127")
    return value
