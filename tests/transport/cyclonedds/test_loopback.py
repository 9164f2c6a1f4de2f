"""DDS sockets that receive from this machine only."""

from __future__ import annotations

import ctypes
import socket
import sys
from contextlib import ExitStack

import pytest

pytest.importorskip("cyclonedds")

from daidalos.transport.cyclonedds import loopback
from daidalos.transport.environment import DiscoveryRange, Environment
from daidalos.transport.session import Session
from daidalos.transport.shared import make_backend

DDS = "rmw_cyclonedds_cpp"


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="filters of sockets are Linux's")
@pytest.mark.parametrize("reach", DiscoveryRange)
def test_sockets_are_filtered_unless_the_range_is_the_network(domain, reach):
    session = Session(make_backend(Environment(domain, reach, middleware=DDS)))
    first = loopback.FIRST_PORT + loopback.PORTS_PER_DOMAIN * domain
    ports = range(first, first + loopback.PORTS_PER_DOMAIN)
    with ExitStack() as stack:
        found = [stack.enter_context(one) for one in loopback._receiving_sockets()]
        lengths = {_filter_length(one) for one in found if one.getsockname()[1] in ports}
    session.close()
    assert lengths == ({0} if reach is DiscoveryRange.SUBNET else {6})


def _filter_length(receiver: socket.socket) -> int:
    """The number of instructions of a socket's filter, which the length in the reply is for SO_GET_FILTER."""
    libc = ctypes.CDLL(None, use_errno=True)
    length = ctypes.c_uint(0)
    failed = libc.getsockopt(receiver.fileno(), socket.SOL_SOCKET, 26, None, ctypes.byref(length))
    assert not failed
    return length.value


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="filters of sockets are Linux's")
def test_a_filtered_socket_hears_this_machine_under_every_address_and_no_other_device(monkeypatch):
    with (
        socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as receiver,
        socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender,
    ):
        receiver.bind(("0.0.0.0", 0))
        receiver.settimeout(5.0)
        sender.connect(("192.0.2.200", 9))  # nothing is sent: the system chooses the address of an interface
        loopback._drop_from_elsewhere(receiver)
        for address in ("127.0.0.1", sender.getsockname()[0]):
            with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
                other.sendto(b"here", (address, receiver.getsockname()[1]))
            assert receiver.recv(10) == b"here"
        monkeypatch.setattr(socket, "if_nametoindex", lambda name: 12345)  # a device that nothing comes over
        loopback._drop_from_elsewhere(receiver)
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
            other.sendto(b"there", ("127.0.0.1", receiver.getsockname()[1]))
        receiver.settimeout(0.2)
        with pytest.raises(TimeoutError):
            receiver.recv(10)


def test_named_peers_and_a_users_configuration_are_reached(monkeypatch):
    monkeypatch.delenv("CYCLONEDDS_URI", raising=False)
    assert loopback.is_confined(Environment(0))
    assert not loopback.is_confined(Environment(0, static_peers=("10.0.0.1",)))
    monkeypatch.setenv("CYCLONEDDS_URI", "<CycloneDDS/>")
    assert not loopback.is_confined(Environment(0))
