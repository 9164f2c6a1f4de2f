"""The studio that other machines can reach, in a real browser: its token, cookie and encryption."""

from __future__ import annotations

import ssl
from collections.abc import Iterator
from pathlib import Path

import pytest
from yarl import URL

from browser.cdp import Chromium
from daidalos.studio.server import StudioServer
from studio.memory_source import MemorySource

pytestmark = [pytest.mark.browser, pytest.mark.slow]

WINDOW = (600, 400)
CONNECTED = "window.daidalos && daidalos.state().connected"
REFUSED = "document.body.textContent.includes('asks for the token')"
HOSTILE = """(async () => {{
  const connect = () => new Promise((end) => {{
    const socket = new WebSocket("ws://localhost:{port}/", ["foxglove.sdk.v1"]);
    socket.onmessage = () => end("connected");
    socket.onerror = () => end("refused");
  }});
  const read = (options) => fetch("http://localhost:{port}/extensions.json", options).then(
    (response) => (response.ok && response.type !== "opaque" ? "read" : "refused"), () => "refused");
  const embed = (kind, name) => new Promise((end) => {{
    const element = document.createElement(kind);
    element[name] = "http://localhost:{port}/extensions.json";
    element.onload = () => end("loaded");
    element.onerror = () => end("refused");
    document.head.append(element);
  }});
  const own = {{ credentials: "include" }};
  return (await Promise.all([
    connect(), read(own), read({{ ...own, mode: "no-cors" }}), embed("script", "src"), embed("img", "src"),
  ])).join();
}})()"""


@pytest.fixture
def server() -> Iterator[StudioServer]:
    with StudioServer(MemorySource(), port=0, hosts=("0.0.0.0",)) as server:
        yield server


def test_the_token_is_needed_once_in_each_browser(browser: Chromium, server: StudioServer) -> None:
    bare = f"http://localhost:{server.port}/"
    for address in (bare, f"{bare}?token=wrong"):
        browser.open(address)
        browser.wait_for(REFUSED)
    browser.open(server.url)
    browser.wait_for(CONNECTED)
    assert "token" not in browser.evaluate("location.href")
    assert browser.evaluate("document.cookie") == ""
    browser.open(bare)
    browser.wait_for(CONNECTED)
    # An old address does not end the visit.
    browser.open(f"{bare}?token=wrong")
    browser.wait_for(CONNECTED)
    browser.open(bare)
    browser.wait_for(CONNECTED)


def test_a_page_of_another_port_cannot_use_the_cookie(browser: Chromium, server: StudioServer, tmp_path: Path) -> None:
    browser.open(server.url)
    browser.wait_for(CONNECTED)
    with StudioServer(MemorySource(), port=0, static=tmp_path) as other:
        for host in ("localhost", "127.0.0.1"):
            browser.open(f"http://{host}:{other.port}/missing.json")
            assert browser.evaluate(HOSTILE.format(port=server.port)) == "refused,refused,refused,refused,refused"


def test_a_studio_with_a_certificate_is_used_over_it(browser: Chromium, tmp_path: Path) -> None:
    pytest.importorskip("cryptography")
    from daidalos.cli.ros2.keystore.certificates import new_authority, new_certificate

    authority, authority_key = tmp_path / "ca.pem", tmp_path / "ca.key"
    new_authority(authority, authority_key)
    new_certificate("localhost", tmp_path / "a.pem", tmp_path / "a.key", authority, authority_key)
    tls = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    tls.load_cert_chain(tmp_path / "a.pem", tmp_path / "a.key")
    with StudioServer(MemorySource(), port=0, hosts=("0.0.0.0",), tls=tls) as server:
        browser.trust_all_certificates()
        assert URL(server.url).scheme == "https"
        browser.open(server.url)
        browser.wait_for(CONNECTED)
        browser.open(f"https://localhost:{server.port}/")
        browser.wait_for(CONNECTED)
        browser.forget(server.url)
        browser.open(f"https://localhost:{server.port}/")
        browser.wait_for(REFUSED)
