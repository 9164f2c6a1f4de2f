"""The program's side of KUKA RSI: a UDP port on which the robot's telegrams are answered within their cycle."""

from __future__ import annotations

import socket
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from daidalos.common.errors import UserError
from daidalos.industry.rsi.telegrams import MAX_BYTES, MAX_IPOC, Telegram, TelegramError, decode, encode

LOOPBACK = "127.0.0.1"
DEFAULT_PORT = 59152
MAX_GAP_MS = 1000
"""Jump of the IPOC, in either direction, from which a telegram belongs to another run of the robot's program [ms]."""

Handler = Callable[[Telegram], Mapping[str, Mapping[str, float]]]
"""From the robot's telegram to the groups of the answer, such as ``{"RKorr": {"Y": 0.01}}``."""


class ConnectionLost(UserError):
    """The robot has stopped sending, or began another run."""


class NoTelegram(ConnectionLost):
    """No telegram came in time."""


@dataclass
class ClientStatistics:
    """What a client has seen.

    Attributes
    ----------
    answered : int
        Telegrams.
    repeated : int
        Telegrams that came once more; they were answered as before.
    late : int
        Telegrams that were older than one that came before, or that waited behind a newer one.
    missed : int
        Cycles without a telegram, by the IPOC.
    refused : int
        Datagrams that were no telegrams, or came from another address.
    delays : int
        Greatest number of answers in a row that the robot missed.
    durations : list of float
        Computing times of the answers [s].
    """

    answered: int = 0
    repeated: int = 0
    late: int = 0
    missed: int = 0
    refused: int = 0
    delays: int = 0
    durations: list[float] = field(default_factory=list)


class RsiClient:
    """A UDP port on which a robot is answered.

    Parameters
    ----------
    address : str
        Own address that is listened on.
    port : int
        0 for any.
    sensor : str
        `Type` of the answers, SENTYPE of the robot's configuration.
    robot : str, optional
        Address of the robot; without, the first sender is taken for it.

    Raises
    ------
    UserError
        Where the port cannot be opened.
    """

    def __init__(
        self, address: str = LOOPBACK, port: int = DEFAULT_PORT, sensor: str = "ImFree", robot: str | None = None
    ) -> None:
        self._sensor = sensor
        self._robot = robot
        self._last: Telegram | None = None
        self._cycle_ms = 0
        self._answer = b""
        self.statistics = ClientStatistics()
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        try:
            self._socket.bind((address, port))
        except (OSError, OverflowError) as error:
            self._socket.close()
            reason = getattr(error, "strerror", None) or error
            raise UserError(f"{address}:{port} cannot be listened on: {reason}") from None

    def __enter__(self) -> RsiClient:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Close the port."""
        self._socket.close()

    @property
    def port(self) -> int:
        """Port that is listened on."""
        return int(self._socket.getsockname()[1])

    def answer(self, handler: Handler, timeout: float) -> Telegram:
        """Wait for the next telegram, answer it, and return it.

        Of several that wait, the newest is answered, since the robot no longer takes answers to the others. Where the
        handler fails, the robot gets an answer without corrections first.

        Raises
        ------
        NoTelegram
            When none came within `timeout` [s] of real time.
        ConnectionLost
            When its IPOC jumped by more than `MAX_GAP_MS`.
        """
        deadline = time.monotonic() + timeout
        while True:
            telegram, sender = self._receive(deadline, timeout)
            begin = time.perf_counter()
            if self._last is not None and telegram.ipoc == self._last.ipoc:
                self.statistics.repeated += 1
                self._socket.sendto(self._answer, sender)
                continue
            if not self._is_next(telegram):
                self.statistics.late += 1
                continue
            self._last = telegram
            self.statistics.delays = max(self.statistics.delays, telegram.delay)
            groups: Mapping[str, Mapping[str, float]] = {}
            try:
                groups = handler(telegram)
                self._answer = self._encoded(groups, telegram.ipoc)
            except BaseException:
                self._socket.sendto(self._encoded({}, telegram.ipoc), sender)
                raise
            self._socket.sendto(self._answer, sender)
            self.statistics.answered += 1
            self.statistics.durations.append(time.perf_counter() - begin)
            return telegram

    def _encoded(self, groups: Mapping[str, Mapping[str, float]], ipoc: int) -> bytes:
        values = {name: group[""] for name, group in groups.items() if "" in group}
        keyed = {name: group for name, group in groups.items() if "" not in group}
        return encode(Telegram("Sen", self._sensor, ipoc, keyed, values))

    def _is_next(self, telegram: Telegram) -> bool:
        """Return whether a telegram is newer than the last one, and count the cycles between them."""
        if self._last is None:
            return True
        step = telegram.ipoc - self._last.ipoc
        if abs(step) > MAX_GAP_MS or telegram.ipoc >= MAX_IPOC:
            raise ConnectionLost(f"the robot's IPOC jumped from {self._last.ipoc} to {telegram.ipoc}")
        if step < 0:
            return False
        if self._cycle_ms:
            self.statistics.missed += max(round(step / self._cycle_ms) - 1, 0)
        self._cycle_ms = min(self._cycle_ms or step, step)
        return True

    def _receive(self, deadline: float, timeout: float) -> tuple[Telegram, tuple[str, int]]:
        """Return the newest telegram that waits, or the next one."""
        newest = None
        while True:
            self._socket.settimeout(0.0 if newest else max(deadline - time.monotonic(), 1e-6))
            try:
                data, sender = self._socket.recvfrom(MAX_BYTES + 1)
            except (BlockingIOError, TimeoutError):
                break
            except ConnectionResetError:  # what Windows says of an answer that nobody took
                continue
            telegram = self._accepted(data, sender[0])
            if telegram is not None:
                self.statistics.late += newest is not None
                newest = telegram, sender
            if time.monotonic() > deadline:
                break
        if newest is None:
            raise NoTelegram(f"no telegram of a robot came within {timeout:g} s")
        return newest

    def _accepted(self, data: bytes, sender: str) -> Telegram | None:
        """Return the telegram of a datagram, None for one that is none or comes from elsewhere."""
        if self._robot is None or sender == self._robot:
            try:
                telegram = decode(data, "Rob")
            except TelegramError:
                pass
            else:
                self._robot = sender
                return telegram
        self.statistics.refused += 1
        return None


def own_address_towards(robot: str) -> str:
    """Return the address of this computer on the network of a robot.

    Raises
    ------
    UserError
        Where the address is not known or not reachable.
    """
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.connect((robot, DEFAULT_PORT))  # sends nothing
        except OSError as error:
            raise UserError(f"{robot} cannot be reached: {error.strerror or error}") from None
        return str(probe.getsockname()[0])
