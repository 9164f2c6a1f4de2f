"""A simulated controller on the network: it sends its telegrams by UDP, and takes the answers that come in time."""

from __future__ import annotations

import socket
import time
from collections.abc import Callable
from contextlib import suppress

from daidalos.common.errors import UserError
from daidalos.industry.rsi.controller import SimulatedController
from daidalos.industry.rsi.telegrams import MAX_BYTES


class ControllerServer:
    """A socket from which a simulated controller sends.

    Parameters
    ----------
    controller : SimulatedController
    address, port : str, int
        Where its telegrams go.

    Raises
    ------
    UserError
        Where the address is not known.

    Attributes
    ----------
    refused : int
        Answers that did not count.
    last_refusal : str
        Why the last of them did not.
    """

    def __init__(self, controller: SimulatedController, address: str, port: int) -> None:
        self.controller = controller
        self.refused = 0
        self.last_refusal = ""
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        try:
            self._socket.connect((address, port))
        except OSError as error:
            self._socket.close()
            raise UserError(f"{address}:{port} cannot be sent to: {error.strerror or error}") from None

    def __enter__(self) -> ControllerServer:
        return self

    def __exit__(self, *_: object) -> None:
        self._socket.close()

    def send(self) -> None:
        """Send the telegram of a new cycle."""
        with suppress(ConnectionRefusedError):  # where nobody listens yet, the answer is lost, which is counted
            self._socket.send(self.controller.telegram())

    def receive(self, wait: float) -> None:
        """Take answers for a time [s], no longer than until the right one came, and end the cycle."""
        deadline = time.monotonic() + wait
        while True:
            self._socket.settimeout(max(deadline - time.monotonic(), 0.0))
            try:
                reason = self.controller.take(self._socket.recv(MAX_BYTES + 1))
            except ConnectionRefusedError:
                continue
            except (BlockingIOError, TimeoutError):
                break
            if not reason:
                break
            self.refused += 1
            self.last_refusal = reason
        self.controller.step()

    def lose(self, wait: float) -> None:
        """Throw the answer of the present cycle away, and end the cycle."""
        self._socket.settimeout(wait)
        with suppress(BlockingIOError, TimeoutError, ConnectionRefusedError):
            self._socket.recv(MAX_BYTES + 1)
        self.controller.step()

    def wait_for_partner(self, timeout: float) -> None:
        """Send the first telegram each cycle until somebody answers it.

        Raises
        ------
        UserError
            When nobody does within `timeout` [s] of real time.
        """
        deadline = time.monotonic() + timeout
        while time.monotonic() < deadline:
            self.send()
            begin = time.monotonic()
            self._socket.settimeout(self.controller.settings.cycle)
            with suppress(BlockingIOError, TimeoutError, ConnectionRefusedError):
                if not self.controller.take(self._socket.recv(MAX_BYTES + 1)):
                    return
            time.sleep(max(begin + self.controller.settings.cycle - time.monotonic(), 0.0))
        raise UserError(f"nobody answered within {timeout:g} s")

    def run(self, duration: float, each_cycle: Callable[[], None] | None = None) -> None:
        """Execute cycles in real time until a duration [s] is over or the robot stops."""
        begin = time.monotonic()
        count = 0
        while not self.controller.stopped and self.controller.time < duration:
            self.send()
            count += 1
            end = begin + count * self.controller.settings.cycle
            self.receive(max(end - time.monotonic(), 0.0))
            if each_cycle is not None:
                each_cycle()
            time.sleep(max(end - time.monotonic(), 0.0))
