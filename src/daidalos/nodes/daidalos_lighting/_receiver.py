"""UDP receivers of simulated devices."""

from __future__ import annotations

import socket

from daidalos.common.errors import UserError


def listen(protocol: str, host: str, port: int) -> socket.socket:
    """Return a socket that receives at a port without waiting.

    Raises
    ------
    UserError
        When the port cannot be had; the message names the protocol.
    """
    receiver = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    receiver.setblocking(False)
    try:
        receiver.bind((host, port))
    except OSError as error:
        receiver.close()
        raise UserError(f"cannot receive {protocol} at {host}:{port}: {error.strerror}") from None
    return receiver
