"""Outputs of DMX levels: Art-Net and sACN over UDP, and a USB widget."""

from __future__ import annotations

import contextlib
import random
import socket
import uuid
from collections.abc import Callable, Iterable
from typing import Any, Protocol

from daidalos.common.errors import UserError
from daidalos.industry.lighting import artnet, enttec, sacn

NAME = "Daidalos"


class Output(Protocol):
    """Output of universes.

    Attributes
    ----------
    universes : tuple of int or None
        What it sends; None for all.
    """

    universes: tuple[int, ...] | None

    def send(self, universe: int, data: bytes) -> None:
        """Send the levels of a universe.

        Raises
        ------
        OSError
            When they cannot be sent now.
        """

    def maintain(self, now: float, universes: Iterable[int]) -> None:
        """Do what is due beside levels, such as answers and announcements, at a time [s] of a monotonic clock."""

    def close(self) -> None:
        """End the stream and release what it holds."""


class ArtNetOutput:
    """Sender of ArtDmx to one receiver, or to all of a network by its broadcast address; answers ArtPoll.

    Parameters
    ----------
    host : str
        Address of the receiver; this machine by default.
    port : int
    universes : tuple of int, optional
        Port-Addresses; all where None.
    reply_port : int or None
        Port at which polls are answered, by the standard 6454; None for no answers. Where another program of this
        machine has it, there are none.
    """

    def __init__(
        self,
        host: str = "127.0.0.1",
        port: int = artnet.PORT,
        universes: tuple[int, ...] | None = None,
        reply_port: int | None = None,
    ) -> None:
        self.universes = universes
        self._target = resolve(host, port)
        self._socket = _socket(broadcast=True)
        self._sequences: dict[int, int] = {}
        self._replier = _replier(reply_port)
        self._replies: list[tuple[float, tuple[str, int]]] = []

    @property
    def answers_polls(self) -> bool:
        """Whether this sender has the port at which polls arrive."""
        return self._replier is not None

    def send(self, universe: int, data: bytes) -> None:
        """Send an ArtDmx packet."""
        sequence = self._sequences.get(universe, 0) % 255 + 1
        self._sequences[universe] = sequence
        self._socket.sendto(artnet.dmx_packet(universe, sequence, data), self._target)

    def maintain(self, now: float, universes: Iterable[int]) -> None:
        """Answer polls, each after a random part of a second as the protocol asks."""
        if self._replier is None:
            return
        with contextlib.suppress(BlockingIOError, ConnectionError):
            while True:
                packet, sender = self._replier.recvfrom(2048)
                if artnet.is_poll(packet) and len(self._replies) < 100:
                    self._replies.append((now + random.uniform(0.0, 1.0), sender))
        due = [one for one in self._replies if one[0] <= now]
        self._replies = [one for one in self._replies if one[0] > now]
        for _, sender in due:
            self._reply(sender, sorted(universes))

    def _reply(self, target: tuple[str, int], universes: list[int]) -> None:
        assert self._replier is not None
        address = _own_address(target)
        for number, universe in enumerate(universes[:255], start=1):
            reply = artnet.poll_reply(address, universe, number, NAME, f"{NAME} lighting", "sending")
            with contextlib.suppress(OSError):
                self._replier.sendto(reply, target)

    def close(self) -> None:
        """Close the sockets."""
        self._socket.close()
        if self._replier is not None:
            self._replier.close()


class SacnOutput:
    """Sender of sACN to one receiver, or to the multicast groups of the universes.

    Parameters
    ----------
    host : str
        Address of the receiver, or ``multicast``.
    port : int
    universes : tuple of int, optional
        All where None.
    priority : int
        From 0 to 200; a receiver takes the sender with the highest.
    source : str
        Name that receivers show.
    """

    def __init__(
        self,
        host: str = "127.0.0.1",
        port: int = sacn.PORT,
        universes: tuple[int, ...] | None = None,
        priority: int = sacn.DEFAULT_PRIORITY,
        source: str = NAME,
    ) -> None:
        self.universes = universes
        self._is_multicast = host == "multicast"
        self._target = ("", port) if self._is_multicast else resolve(host, port)
        self._socket = _socket(broadcast=False)
        if self._is_multicast:
            self._socket.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 4)
        self._cid = uuid.uuid4().bytes
        self._priority, self._source = priority, source
        self._sequences: dict[int, int] = {}
        self._next_discovery = -1.0

    def send(self, universe: int, data: bytes) -> None:
        """Send a data packet."""
        self._send(universe, data, is_terminated=False)

    def maintain(self, now: float, universes: Iterable[int]) -> None:
        """Announce the universes every ten seconds."""
        if now < self._next_discovery:
            return
        self._next_discovery = now + sacn.DISCOVERY_S
        target = self._address(sacn.DISCOVERY_UNIVERSE)
        for packet in sacn.discovery_packets(list(universes), self._cid, self._source):
            with contextlib.suppress(OSError):
                self._socket.sendto(packet, target)

    def close(self) -> None:
        """Announce the end of all streams, three times as the standard asks, and close the socket."""
        for universe in self._sequences:
            for _ in range(3):
                with contextlib.suppress(OSError):
                    self._send(universe, bytes(512), is_terminated=True)
        self._socket.close()

    def _send(self, universe: int, data: bytes, is_terminated: bool) -> None:
        sequence = (self._sequences.get(universe, -1) + 1) % 256
        self._sequences[universe] = sequence
        packet = sacn.data_packet(
            universe, sequence, data, self._cid, self._source, self._priority, is_terminated=is_terminated
        )
        self._socket.sendto(packet, self._address(universe))

    def _address(self, universe: int) -> tuple[str, int]:
        return (sacn.multicast_address(universe), self._target[1]) if self._is_multicast else self._target


class UsbOutput:
    """Sender to a USB widget that has one universe; looks for a lost one again with every frame.

    Parameters
    ----------
    device : str
        Serial port, such as ``/dev/ttyUSB0`` or ``COM3``.
    universe : int
    open_port : callable
        Opens a port; tests replace it.
    """

    def __init__(self, device: str, universe: int, open_port: Callable[[str], Any] | None = None) -> None:
        self.universes: tuple[int, ...] | None = (universe,)
        self._device = device
        self._open = open_port or _open_serial
        self._port: Any = self._open(device)

    def send(self, universe: int, data: bytes) -> None:
        """Write a frame."""
        if self._port is None:
            self._port = self._open(self._device)
        try:
            self._port.write(enttec.dmx_frame(data))
        except OSError:
            self.close()
            raise

    def maintain(self, now: float, universes: Iterable[int]) -> None:
        """Do nothing: the widget repeats the last levels by itself."""

    def close(self) -> None:
        """Close the port."""
        port, self._port = self._port, None
        if port is not None:
            with contextlib.suppress(OSError):
                port.close()


def _open_serial(device: str) -> Any:
    try:
        import serial
    except ImportError:
        raise UserError("a USB widget needs pyserial; run: pip install 'daidalos[industry]'") from None
    try:
        return serial.Serial(device, enttec.BAUD, timeout=0, write_timeout=0.5)
    except serial.SerialException as error:
        raise OSError(f"cannot open the USB widget at {device}: {error}") from None


def resolve(host: str, port: int) -> tuple[str, int]:
    """Return the address of a host, with a port; raises a `UserError` where there is none of its name."""
    try:
        return socket.gethostbyname(host), port
    except OSError:
        raise UserError(f"there is no host '{host}'") from None


def _socket(broadcast: bool) -> socket.socket:
    one = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    one.setblocking(False)
    if broadcast:
        one.setsockopt(socket.SOL_SOCKET, socket.SO_BROADCAST, 1)
    return one


def _replier(port: int | None) -> socket.socket | None:
    if port is None:
        return None
    one = _socket(broadcast=True)
    try:
        one.bind(("", port))
    except OSError:  # a receiver on this machine has the port
        one.close()
        return None
    return one


def _own_address(target: tuple[str, int]) -> str:
    """Return this machine's address on the way to another one."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.connect(target)
            return str(probe.getsockname()[0])
        except OSError:
            return "127.0.0.1"
