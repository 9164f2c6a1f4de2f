"""Which hosts, origins and tokens are admitted."""

import pytest

from daidalos.studio.access import AccessPolicy, Request

ADMITTED = [
    ("localhost:8765", None),
    ("127.0.0.1:8765", None),
    ("[::1]:8765", None),
    ("LOCALHOST", "http://localhost"),
    ("localhost", "https://localhost"),
    ("localhost:8765", "http://localhost:8765"),
    ("[::1]:8765", "http://[::1]:8765"),
]
REFUSED = [
    (None, None),
    ("", None),
    ("evil.example:8765", None),
    ("evil.example:8765", "http://evil.example:8765"),  # rebinding: both carry the attacker's name
    ("localhost:8765", "http://evil.example"),
    ("localhost:8765", "http://localhost:5173"),  # another server of this machine, whoever wrote its pages
    ("127.0.0.1:8765", "http://localhost:8765"),
    ("localhost:8765", "null"),
    ("localhost:8765", "file://"),
    ("localhost:8765", ""),
    ("192.168.1.7:8765", None),
    ("localhost.evil.example", None),
    ("[::1", None),
    ("localhost:8765", "http://["),
    ("localhost:99999999", "http://localhost:99999999"),
]
TOKEN = "secret-of-the-test"


def refusal(policy, host=None, origin=None, **secrets):
    return policy.refusal(Request(host, origin, **secrets))


@pytest.mark.parametrize(("host", "origin"), ADMITTED)
def test_the_own_page_on_loopback_is_admitted(host, origin):
    assert refusal(AccessPolicy(), host, origin) is None


@pytest.mark.parametrize(("host", "origin"), REFUSED)
def test_everyone_else_is_refused_with_a_reason(host, origin):
    assert refusal(AccessPolicy(), host, origin).status == 403


def test_configured_hosts_and_origins_are_admitted():
    policy = AccessPolicy(["Robot.local"], ["https://app.example/"])
    assert refusal(policy, "robot.local:8765", "http://robot.local:8765") is None
    assert refusal(policy, "localhost", "https://app.example") is None
    assert refusal(policy, "localhost", "https://other.example")


def test_all_origins_can_be_admitted():
    assert refusal(AccessPolicy(origins=["*"]), "localhost", "http://anywhere.example") is None


@pytest.mark.parametrize("wrong", [None, "", TOKEN[:-1], TOKEN + "x", "é", "\ud800"])
def test_without_the_token_nobody_is_admitted(wrong):
    policy = AccessPolicy(origins=["*"], token=TOKEN)
    assert refusal(policy, "localhost", token=wrong).status == 401
    assert refusal(policy, "localhost", cookie=wrong).status == 401


def test_the_token_admits_under_every_name_and_from_every_program():
    policy = AccessPolicy(token=TOKEN)
    for host, origin in [("robot.local:8765", None), ("192.168.1.7", "file://"), ("localhost", "https://x.example")]:
        assert refusal(policy, host, origin, token=TOKEN) is None


def test_the_cookie_admits_the_own_page_only():
    policy = AccessPolicy(token=TOKEN)
    assert refusal(policy, "192.168.1.7:8765", "http://192.168.1.7:8765", cookie=TOKEN) is None
    # Browsers send a cookie to every port of a host.
    assert refusal(policy, "192.168.1.7:8765", "http://192.168.1.7:9999", cookie=TOKEN).status == 403
    assert refusal(policy, "192.168.1.7:8765", "http://203.0.113.66", cookie=TOKEN).status == 403
