"""A page of another origin that tries to use the studio, in a real browser."""

from __future__ import annotations

import http.server
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from browser.cdp import Chromium
from daidalos.studio.server import StudioServer
from studio.memory_source import MemorySource

pytestmark = [pytest.mark.browser, pytest.mark.slow]

WINDOW = (600, 400)
_PAGE = """<!doctype html><title>waiting</title><script>
const port = new URLSearchParams(location.search).get("port");
const connect = (host) => new Promise((end) => {
  const socket = new WebSocket(`ws://${host}:${port}/`, ["foxglove.sdk.v1"]);
  socket.onmessage = () => end("connected");
  socket.onerror = () => end("refused");
});
const read = (path) => fetch(`http://localhost:${port}${path}`).then(
  (response) => (response.ok ? "read" : "refused"), () => "refused");
const embed = () => new Promise((end) => {
  const script = document.createElement("script");
  script.src = `http://localhost:${port}/extensions.json`;
  script.onload = () => end("loaded");
  script.onerror = () => end("refused");
  document.head.append(script);
});
Promise.all([connect("localhost"), connect("127.0.0.1"), read("/"), read("/extensions.json"), embed()])
  .then((all) => { document.title = all.join(); });
</script>"""


class _Pages(http.server.BaseHTTPRequestHandler):
    def do_GET(self) -> None:
        self.send_response(200)
        self.send_header("Content-Type", "text/html")
        self.end_headers()
        self.wfile.write(_PAGE.encode())

    def log_message(self, format: str, *args: object) -> None:
        pass


@pytest.fixture
def hostile_port() -> Iterator[int]:
    """Serve the page from a port of its own, which makes it another origin."""
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), _Pages) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield server.server_address[1]
        server.shutdown()


def test_a_page_of_another_origin_gets_nothing(browser: Chromium, hostile_port: int, tmp_path: Path) -> None:
    with StudioServer(MemorySource(), port=0, static=tmp_path) as server:
        for host in ("localhost", "127.0.0.1"):
            browser.open(f"http://{host}:{hostile_port}/?port={server.port}")
            browser.wait_for("document.title !== 'waiting'")
            assert browser.evaluate("document.title") == "refused,refused,refused,refused,refused"
        assert server.client_count == 0
