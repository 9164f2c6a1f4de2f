"""Opening ports."""

import socket

import pytest

from daidalos.studio.ports import PortError, open_port


def close(sockets):
    for each in sockets:
        each.close()


def test_takes_the_next_port_where_the_wanted_one_is_used():
    with socket.create_server(("127.0.0.1", 0)) as used:
        wanted = used.getsockname()[1]
        sockets = open_port(["127.0.0.1"], wanted)
        try:
            assert wanted < sockets[0].getsockname()[1] < wanted + 64
        finally:
            close(sockets)


def test_both_loopbacks_share_one_port():
    sockets = open_port(["127.0.0.1", "::1"], 0)
    try:
        assert len({each.getsockname()[1] for each in sockets}) == 1
    finally:
        close(sockets)


def test_a_port_used_on_one_address_is_left_on_all():
    try:
        used = socket.create_server(("::1", 0), family=socket.AF_INET6)
    except OSError:
        pytest.skip("no IPv6 here")
    with used:
        wanted = used.getsockname()[1]
        sockets = open_port(["127.0.0.1", "::1"], wanted)
        try:
            assert sockets[0].getsockname()[1] != wanted
        finally:
            close(sockets)


def test_two_servers_never_share_a_port():
    first = open_port(["127.0.0.1"], 0)
    port = first[0].getsockname()[1]
    second = open_port(["127.0.0.1"], port)
    try:
        assert second[0].getsockname()[1] != port
    finally:
        close(first)
        close(second)


@pytest.mark.parametrize("host", ["192.0.2.1", "no-such-host.invalid"])
def test_an_address_of_another_machine_is_named(host):
    with pytest.raises(PortError, match=host):
        open_port([host], 0)
