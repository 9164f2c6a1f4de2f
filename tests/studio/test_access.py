"""Which hosts and origins are welcome."""

import pytest

from daidalos.studio.access import AccessPolicy

WELCOME = [
    ("localhost:8765", None),
    ("127.0.0.1:8765", None),
    ("[::1]:8765", None),
    ("LOCALHOST", "http://localhost:8765"),
    ("localhost:8765", "http://localhost:5173"),
    ("127.0.0.1:8765", "http://[::1]:9999"),
]
REFUSED = [
    (None, None),
    ("", None),
    ("evil.example:8765", None),
    ("evil.example:8765", "http://evil.example:8765"),  # rebinding: both carry the attacker's name
    ("localhost:8765", "http://evil.example"),
    ("localhost:8765", "null"),
    ("localhost:8765", "file://"),
    ("192.168.1.7:8765", None),
    ("localhost.evil.example", None),
    ("[::1", None),
    ("localhost:8765", "http://["),
]


@pytest.mark.parametrize(("host", "origin"), WELCOME)
def test_loopback_is_welcome(host, origin):
    assert AccessPolicy().refusal_reason(host, origin) is None


@pytest.mark.parametrize(("host", "origin"), REFUSED)
def test_everyone_else_is_refused_with_a_reason(host, origin):
    assert AccessPolicy().refusal_reason(host, origin)


def test_configured_hosts_and_origins_are_welcome():
    policy = AccessPolicy(["Robot.local"], ["https://app.example/"])
    assert policy.refusal_reason("robot.local:8765", "http://robot.local:8765") is None
    assert policy.refusal_reason("localhost", "https://app.example") is None
    assert policy.refusal_reason("localhost", "https://other.example")


def test_an_exposed_server_is_reached_by_address_but_not_by_unknown_name():
    policy = AccessPolicy(exposed=True)
    assert policy.refusal_reason("192.168.1.7:8765", "http://192.168.1.7:8765") is None
    assert policy.refusal_reason("evil.example:8765", None)
    assert policy.refusal_reason("192.168.1.7:8765", "http://evil.example")
    assert policy.refusal_reason("192.168.1.7:8765", "http://203.0.113.66")


def test_all_origins_can_be_admitted():
    assert AccessPolicy(origins=["*"]).refusal_reason("localhost", "http://anywhere.example") is None
