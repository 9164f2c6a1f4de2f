"""The server against Foxglove's own client library, where a developer has it (`npm install` in studio/web)."""

import json
import shutil
import subprocess
from pathlib import Path

import pytest

from daidalos.studio.assets import AssetResolver
from daidalos.studio.build import WEB
from daidalos.studio.server import StudioServer
from daidalos.studio.source import Graph, Service, SourceError

from .memory_source import MemorySource, decode, encode, make

STRING = "std_msgs/msg/String"


@pytest.fixture
def node() -> str:
    found = shutil.which("node")
    if found is None:
        pytest.skip("no Node.js here")
    if not (WEB / "node_modules/@foxglove/ws-protocol").is_dir():
        pytest.skip("Foxglove's client is not installed: npm install in studio/web")
    return found


def test_foxgloves_client_can_do_everything(node: str, tmp_path: Path) -> None:
    source = MemorySource()
    source.add_topic("/chatter", STRING, latched=True)
    source.send("/chatter", encode(STRING, make(STRING, data="hello")), 1_700_000_000_000_000_007)
    source.add_service(Service("/flip", "p/srv/Flip", "uint8[] a", "uint8[] b"), flip)
    source.set_graph(Graph({"/chatter": frozenset({"talker"})}))
    (tmp_path / "a.stl").write_text("solid a")
    with StudioServer(source, name="ours", port=0, assets=AssetResolver(lambda _: tmp_path)) as server:
        done = subprocess.run(
            [node, "interop/client.mjs", f"ws://127.0.0.1:{server.port}"],
            cwd=WEB,
            capture_output=True,
            text=True,
            timeout=60,
            check=False,
        )
        assert done.returncode == 0, done.stderr
    got = json.loads(done.stdout)
    assert got["name"] == "ours"
    assert "clientPublish" in got["capabilities"]
    assert got["message"] == {"data": "hello"}
    assert got["stamp"] == "1700000000000000007"
    assert got["response"] == [3, 2, 1]
    assert got["failure"] == "no"
    assert got["parameters"] == [{"name": "/node.speed", "value": 0.75, "type": "float64"}]
    assert got["graph"] == [{"name": "/chatter", "publisherIds": ["talker"]}]
    assert got["asset"] == "solid a"
    assert "no such file" in got["assetError"]
    ((topic, type_name, payload),) = source.published
    assert (topic, type_name) == ("/answer", STRING)
    assert decode(STRING, payload).data == "from Foxglove"


def flip(request: bytes) -> bytes:
    if request == b"BAD":
        raise SourceError("no")
    return request[::-1]
