"""A simulated controller on the network: every 4 ms it sends where its robot is, and takes the guidance that came."""

from __future__ import annotations

import socket
import time
from collections.abc import Callable
from contextlib import suppress

from daidalos.common.errors import UserError
from daidalos.industry.egm.controller import CYCLE, GuidedController

MAX_BYTES = 4096


class EgmControllerServer:
    """A socket from which a simulated controller sends to the port of a guiding program.

    Parameters
    ----------
    controller : GuidedController
    address, port : str, int
        Where its messages go.

    Raises
    ------
    UserError
        Where the address is not known.
    """

    def __init__(self, controller: GuidedController, address: str, port: int) -> None:
        self.controller = controller
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        try:
            self._socket.connect((address, port))
        except (OSError, OverflowError) as error:
            self._socket.close()
            raise UserError(f"{address}:{port} cannot be sent to: {getattr(error, 'strerror', error)}") from None
        self._socket.setblocking(False)

    def __enter__(self) -> EgmControllerServer:
        return self

    def __exit__(self, *_: object) -> None:
        self._socket.close()

    def cycle(self) -> None:
        """Take what came, move the robot for a cycle, and send where it is."""
        while True:
            try:
                self.controller.take(self._socket.recv(MAX_BYTES + 1))
            except (ConnectionRefusedError, ConnectionResetError):
                continue  # nobody listens yet
            except (BlockingIOError, TimeoutError):
                break
        self.controller.step()
        with suppress(ConnectionRefusedError):
            self._socket.send(self.controller.message())

    def run(self, duration: float, each_cycle: Callable[[], None] | None = None) -> None:
        """Execute cycles in real time until a duration [s] is over or the robot stops."""
        begin = due = time.monotonic()
        while not self.controller.stopped and due - begin < duration:
            self.cycle()
            if each_cycle is not None:
                each_cycle()
            # A cycle that came late is not made up for: several at once would look like time without guidance.
            due = max(due + CYCLE, time.monotonic())
            time.sleep(max(due - time.monotonic(), 0.0))
