"""Restriction of a domain's sockets to what comes from this machine.

The library binds the sockets on which it receives to every address, whichever interface it is told to use. On Linux
they get a filter that drops what neither came over the loopback device nor is a copy of what this machine sent by
multicast. Processes of this machine are heard nevertheless, also under the machine's address in the network: the
system sends what is for itself over loopback. (A socket that is bound to that device would not hear them.)
"""

from __future__ import annotations

import ctypes
import logging
import os
import socket
import stat
import struct
import sys
from collections.abc import Iterator
from contextlib import suppress

from daidalos.transport.environment import DiscoveryRange, Environment

_LOGGER = logging.getLogger(__name__)
FIRST_PORT, PORTS_PER_DOMAIN = 7400, 250
"""Ports of DDS (RTPS 2.5, 9.6.2.3)."""
# Of linux/filter.h, linux/if_packet.h and asm-generic/socket.h: a classic BPF program that compares the device and the
# kind of a packet.
_SO_ATTACH_FILTER = 26
_LOAD, _KIND, _DEVICE = 0x20, 0xFFFFF000 + 4, 0xFFFFF000 + 8
_LOOPED_BACK = 5
_JUMP_IF_EQUAL, _RETURN = 0x15, 0x06
_ALL = 0xFFFFFFFF
_ANY = ("0.0.0.0", "::")


def is_confined(environment: Environment) -> bool:
    """Return whether a domain is to be reached from this machine only.

    With static peers, or a configuration of the user's own, other machines may take part.
    """
    elsewhere = environment.static_peers or os.environ.get("CYCLONEDDS_URI")
    return environment.discovery is not DiscoveryRange.SUBNET and not elsewhere


def drops_what_others_send(environment: Environment) -> bool:
    """Return whether a domain's sockets drop what other machines send."""
    return sys.platform.startswith("linux") and is_confined(environment)


def confine(domain: int) -> None:
    """Make the sockets of this process in a domain's range of ports drop what other machines send, on Linux."""
    first = FIRST_PORT + PORTS_PER_DOMAIN * domain
    for opened in _receiving_sockets():
        with opened:
            if opened.getsockname()[1] in range(first, first + PORTS_PER_DOMAIN):
                try:
                    _drop_from_elsewhere(opened)
                except OSError as error:
                    _LOGGER.warning(
                        "DDS domain %d can be reached from other machines: a socket takes no filter (%s)",
                        domain,
                        error.strerror,
                    )
                    return


def _drop_from_elsewhere(receiver: socket.socket) -> None:
    """Make a socket drop the packets that neither came over the loopback device nor were sent here by multicast."""
    program = b"".join(
        struct.pack("=HBBI", *instruction)
        for instruction in (
            (_LOAD, 0, 0, _DEVICE),
            (_JUMP_IF_EQUAL, 2, 0, socket.if_nametoindex("lo")),
            (_LOAD, 0, 0, _KIND),
            (_JUMP_IF_EQUAL, 0, 1, _LOOPED_BACK),
            (_RETURN, 0, 0, _ALL),
            (_RETURN, 0, 0, 0),
        )
    )
    buffer = ctypes.create_string_buffer(program, len(program))
    described = struct.pack("@HP", len(program) // 8, ctypes.addressof(buffer))
    receiver.setsockopt(socket.SOL_SOCKET, _SO_ATTACH_FILTER, described)


def _receiving_sockets() -> Iterator[socket.socket]:
    """Yield copies of this process's UDP sockets that receive on every address."""
    for number in map(int, os.listdir("/proc/self/fd")):
        with suppress(OSError):  # it is closed by now
            if not stat.S_ISSOCK(os.fstat(number).st_mode):
                continue
            copy = socket.socket(fileno=os.dup(number))
            udp = copy.family in (socket.AF_INET, socket.AF_INET6) and copy.type == socket.SOCK_DGRAM
            if udp and copy.getsockname()[0] in _ANY:
                yield copy
            else:
                copy.close()
