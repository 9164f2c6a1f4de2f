"""The server as its clients see it, over real sockets and real CDR."""

import asyncio
import gzip
import os
import threading
import time

import aiohttp
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from daidalos.studio.assets import AssetResolver
from daidalos.studio.outbox import BACKLOG
from daidalos.studio.protocol import SUBPROTOCOLS
from daidalos.studio.server import StudioServer
from daidalos.studio.source import Graph, Service, SourceError

from .foxglove_client import FoxgloveClient
from .memory_source import MemorySource, decode, encode, make

STRING = "std_msgs/msg/String"


def text(content):
    return encode(STRING, make(STRING, data=content))


@pytest.fixture
def source():
    source = MemorySource()
    source.add_topic("/chatter", STRING)
    return source


@pytest.fixture
def server(source, tmp_path):
    (tmp_path / "share" / "pkg").mkdir(parents=True)
    (tmp_path / "share" / "pkg" / "a.stl").write_bytes(b"solid")
    assets = AssetResolver(lambda name: tmp_path / "share" / name)
    with StudioServer(source, name="test", port=0, assets=assets, static=tmp_path / "static") as server:
        yield server


def talk(server, conversation, subprotocol=SUBPROTOCOLS[0]):
    """Run a conversation of a client with the server."""

    async def run():
        async with FoxgloveClient(f"ws://127.0.0.1:{server.port}/", subprotocol) as client:
            return await conversation(client)

    return asyncio.run(run())


@pytest.mark.parametrize("subprotocol", SUBPROTOCOLS)
def test_introduces_itself_under_both_subprotocols(server, subprotocol):
    async def conversation(client):
        assert client.socket.protocol == subprotocol
        assert client.info["name"] == "test"
        assert client.info["supportedEncodings"] == ["cdr"]
        assert "time" not in client.info["capabilities"]
        channel = await client.channel("/chatter")
        assert channel["encoding"] == "cdr"
        assert channel["schemaEncoding"] == "ros2msg"
        assert channel["schemaName"] == STRING
        assert channel["schema"].strip() == "string data"

    talk(server, conversation, subprotocol)


def test_listens_on_both_loopbacks(server):
    async def run():
        for host in ("127.0.0.1", "[::1]", "localhost"):
            async with FoxgloveClient(f"ws://{host}:{server.port}/") as client:
                assert client.info["name"] == "test"

    asyncio.run(run())


def test_messages_arrive_unchanged_with_their_stamp(server, source):
    async def conversation(client):
        await client.subscribe("/chatter", 7)
        await client.sync()
        source.send("/chatter", text("hello"), 1_700_000_000_123_456_789)
        got = await client.expect("message", subscription=7)
        assert got["stamp"] == 1_700_000_000_123_456_789
        assert decode(STRING, got["payload"]).data == "hello"
        await client.say("unsubscribe", subscriptionIds=[7])
        await client.sync()
        assert source.listener_count("/chatter") == 0

    talk(server, conversation)


def test_clients_share_a_subscription(server, source):
    async def run():
        url = f"ws://127.0.0.1:{server.port}/"
        async with FoxgloveClient(url) as one, FoxgloveClient(url) as two:
            for client in (one, two):
                await client.subscribe("/chatter", 1)
                await client.sync()
            assert source.subscribe_count == 1
            source.send("/chatter", text("both"))
            for client in (one, two):
                assert decode(STRING, (await client.expect("message"))["payload"]).data == "both"

    asyncio.run(run())


def test_every_client_gets_what_a_latched_topic_keeps(server, source):
    source.add_topic("/kept", STRING, latched=True)
    for content in ("a", "b"):
        source.send("/kept", text(content))

    async def conversation(client):
        await client.subscribe("/kept", 1)
        got = [decode(STRING, (await client.expect("message"))["payload"]).data for _ in range(2)]
        assert got == ["a", "b"]
        # A second subscription of the same client to a channel is refused, as by other servers of the protocol.
        await client.subscribe("/kept", 2)
        assert "subscribed to already" in (await client.expect("status", level=1))["message"]
        await client.say("unsubscribe", subscriptionIds=[1])
        await client.subscribe("/kept", 2)
        assert decode(STRING, (await client.expect("message", subscription=2))["payload"]).data == "a"

    talk(server, conversation)
    talk(server, conversation)


def test_a_topic_that_becomes_latched_is_offered_anew(server, source):
    async def conversation(client):
        before = (await client.channel("/chatter"))["id"]
        await client.subscribe("/chatter", 1)
        await client.sync()
        source.add_topic("/chatter", STRING, latched=True)
        gone = await client.expect("unadvertise")
        assert gone["channelIds"] == [before]
        assert (await client.channel("/chatter"))["id"] != before
        await client.sync()
        assert source.listener_count("/chatter") == 0

    talk(server, conversation)


def test_topics_come_and_go(server, source):
    async def conversation(client):
        source.add_topic("/new", STRING)
        channel = await client.channel("/new")
        await client.subscribe("/new", 1)
        await client.sync()
        source.remove_topic("/new")
        gone = await client.expect("unadvertise")
        assert gone["channelIds"] == [channel["id"]]
        await client.say("subscribe", subscriptions=[{"id": 2, "channelId": channel["id"]}])
        error = await client.expect("status", level=1)
        assert "does not exist" in error["message"]

    talk(server, conversation)


def test_unknown_definitions_are_told_and_the_word_withdrawn(server, source):
    async def conversation(client):
        source.add_topic("/odd", STRING, known=False)
        error = await client.expect("status")
        assert "/odd" in error["message"]
        assert "schemaEncoding" not in (await client.channel("/odd"))
        source.remove_topic("/odd")
        assert (await client.expect("removeStatus"))["statusIds"] == [error["id"]]

    talk(server, conversation)


@pytest.mark.parametrize("name", ["geometry_msgs/PointStamped", "geometry_msgs/msg/PointStamped"])
def test_clients_publish(server, source, name):
    payload = encode(STRING, make(STRING, data="from the page"))

    async def conversation(client):
        await client.say("advertise", channels=[{"id": 5, "topic": "/out", "encoding": "cdr", "schemaName": name}])
        await client.socket.send_bytes(b"\x01" + (5).to_bytes(4, "little") + payload)
        await client.sync()
        assert source.published == [("/out", "geometry_msgs/msg/PointStamped", payload)]
        await client.say("unadvertise", channelIds=[5])
        await client.socket.send_bytes(b"\x01" + (5).to_bytes(4, "little") + payload)
        assert "not advertised" in (await client.expect("status"))["message"]
        assert source.unadvertised == ["/out"]

    talk(server, conversation)


def test_a_publication_that_can_not_be_is_refused_with_the_reason(server):
    async def conversation(client):
        wrong = {"id": 1, "topic": "/chatter", "encoding": "cdr", "schemaName": "std_msgs/Bool"}
        await client.say("advertise", channels=[wrong])
        assert "std_msgs/msg/String" in (await client.expect("status"))["message"]
        await client.say("advertise", channels=[{**wrong, "encoding": "json"}])
        assert "json" in (await client.expect("status"))["message"]

    talk(server, conversation)


def request_frame(service, call, payload, encoding=b"cdr"):
    head = service.to_bytes(4, "little") + call.to_bytes(4, "little") + len(encoding).to_bytes(4, "little")
    return b"\x02" + head + encoding + payload


def test_services_are_called(server, source):
    def answer(request):
        if request == b"bad":
            raise SourceError("the node said no")
        return request[::-1]

    source.add_service(Service("/flip", "p/srv/Flip", "uint8[] a", "uint8[] b"), answer)

    async def conversation(client):
        number = (await client.service("/flip"))["id"]
        await client.socket.send_bytes(request_frame(number, 11, b"abc"))
        got = await client.expect("serviceResponse")
        assert (got["service"], got["call"], got["encoding"], got["payload"]) == (number, 11, "cdr", b"cba")
        await client.socket.send_bytes(request_frame(number, 12, b"bad"))
        failure = await client.expect("serviceCallFailure")
        assert failure == {
            "op": "serviceCallFailure",
            "serviceId": number,
            "callId": 12,
            "message": "the node said no",
        }
        await client.socket.send_bytes(request_frame(999, 13, b""))
        assert "does not exist" in (await client.expect("serviceCallFailure"))["message"]
        await client.socket.send_bytes(request_frame(number, 14, b"", b"json"))
        assert "json" in (await client.expect("serviceCallFailure"))["message"]
        source.remove_service("/flip")
        assert (await client.expect("unadvertiseServices"))["serviceIds"] == [number]

    talk(server, conversation)


def test_parameters_are_read_set_and_watched(server, source):
    source.change_parameter("/node.speed", 0.5)
    source.change_parameter("/node.name", "waffle")

    async def conversation(client):
        await client.say("getParameters", parameterNames=[], id="all")
        everything = await client.expect("parameterValues", id="all")
        assert {each["name"] for each in everything["parameters"]} == {"/node.speed", "/node.name"}
        await client.say("getParameters", parameterNames=["/node.speed", "/node.none"], id="some")
        some = await client.expect("parameterValues", id="some")
        assert some["parameters"] == [{"name": "/node.speed", "value": 0.5, "type": "float64"}]
        await client.say("subscribeParameterUpdates", parameterNames=["/node.speed"])
        wanted = {"name": "/node.speed", "value": 1.5, "type": "float64"}
        await client.say("setParameters", parameters=[wanted], id="set")
        assert (await client.expect("parameterValues", id="set"))["parameters"] == [wanted]
        assert (await client.expect("parameterValues"))["parameters"] == [wanted]
        source.change_parameter("/node.name", "burger")
        await client.say("unsubscribeParameterUpdates", parameterNames=["/node.speed"])
        await client.sync()
        source.change_parameter("/node.speed", 2.0)
        await client.sync()
        assert client.waiting("parameterValues") == []

    talk(server, conversation)


def test_the_graph_is_told_in_steps(server, source):
    source.set_graph(Graph({"/chatter": frozenset({"talker"})}))

    async def conversation(client):
        await client.say("subscribeConnectionGraph")
        first = await client.expect("connectionGraphUpdate")
        assert first["publishedTopics"] == [{"name": "/chatter", "publisherIds": ["talker"]}]
        source.set_graph(Graph({}, {"/chatter": frozenset({"listener"})}))
        update = await client.expect("connectionGraphUpdate")
        assert update["publishedTopics"] == [{"name": "/chatter", "publisherIds": []}]
        assert update["subscribedTopics"] == [{"name": "/chatter", "subscriberIds": ["listener"]}]
        await client.say("unsubscribeConnectionGraph")
        await client.sync()
        source.set_graph(Graph())
        source.add_topic("/later", STRING)
        await client.channel("/later")
        assert client.waiting("connectionGraphUpdate") == []

    talk(server, conversation)


def test_time_is_told_once_there_is_time(server, source):
    async def conversation(client):
        source.set_time(5_000_000_000)
        again = await client.expect("serverInfo")
        assert "time" in again["capabilities"]
        assert again["sessionId"] == client.info["sessionId"]
        assert (await client.expect("time"))["stamp"] == 5_000_000_000
        for step in range(2000):
            source.set_time(6_000_000_000 + step)
        while (await client.expect("time"))["stamp"] != 6_000_001_999:
            pass

    talk(server, conversation)

    async def late(client):
        assert "time" in client.info["capabilities"]
        assert (await client.expect("time"))["stamp"] == 6_000_001_999

    talk(server, late)


def test_assets_are_fetched(server):
    async def conversation(client):
        await client.say("fetchAsset", uri="package://pkg/a.stl", requestId=3)
        got = await client.expect("asset", request=3)
        assert (got["failed"], got["data"]) == (False, b"solid")
        await client.say("fetchAsset", uri="package://pkg/../../etc/x.stl", requestId=4)
        got = await client.expect("asset", request=4)
        assert got["failed"]
        assert "leaves its package" in got["error"]

    talk(server, conversation)


BAD_TEXTS = [
    "",
    "nonsense",
    "[]",
    "{}",
    '{"op": 3}',
    '{"op": "dance"}',
    '{"op": "subscribe"}',
    '{"op": "subscribe", "subscriptions": [3]}',
    '{"op": "subscribe", "subscriptions": [{"id": -1, "channelId": 1}]}',
    '{"op": "subscribe", "subscriptions": [{"id": "a", "channelId": 1}]}',
    '{"op": "unsubscribe", "subscriptionIds": "all"}',
    '{"op": "advertise", "channels": [{"id": 1}]}',
    '{"op": "setParameters", "parameters": [{"value": 1}]}',
    '{"op": "getParameters", "parameterNames": [1]}',
    '{"op": "getParameters", "parameterNames": [], "id": 4}',
    '{"op": "fetchAsset", "requestId": 1}',
    '{"op": "fetchAsset", "requestId": 99999999999, "uri": "x"}',
]


def test_malformed_frames_are_answered_and_kill_nothing(server):
    async def conversation(client):
        for frame in BAD_TEXTS:
            await client.socket.send_str(frame)
            assert (await client.expect("status", level=2))["message"]
        for frame in [b"", b"\x00", b"\x01\x01", b"\x02\x00\x00\x00\x00", b"\x09abc", b"\x03" + bytes(20)]:
            await client.socket.send_bytes(frame)
            assert (await client.expect("status", level=2))["message"]
        await client.sync()

    talk(server, conversation)


JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner, max_size=3),
    max_leaves=6,
)
OPS = [
    "subscribe", "unsubscribe", "advertise", "unadvertise", "getParameters", "setParameters", "fetchAsset",
    "subscribeParameterUpdates", "unsubscribeParameterUpdates", "subscribeConnectionGraph",
]  # fmt: skip
KEYS = [
    "subscriptions", "subscriptionIds", "channels", "channelIds", "parameterNames", "parameters", "id",
    "requestId", "uri",
]  # fmt: skip
FRAMES = st.binary(max_size=40) | st.builds(
    lambda op, fields: {"op": op, **fields},
    st.sampled_from(OPS),
    st.dictionaries(st.sampled_from(KEYS), JSON, max_size=4),
)


@settings(
    max_examples=30,
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
)
@given(st.lists(FRAMES, max_size=20))
def test_no_client_can_kill_the_server(server, frames):
    async def conversation(client):
        for frame in frames:
            if isinstance(frame, bytes):
                await client.socket.send_bytes(frame)
            else:
                await client.socket.send_json(frame)
        await client.sync()

    talk(server, conversation)


def test_a_slow_client_gets_the_newest_and_holds_up_nobody(server, source):
    source.add_topic("/big", STRING)
    chunk = "x" * (1 << 20)

    async def run():
        url = f"ws://127.0.0.1:{server.port}/"
        async with FoxgloveClient(url) as slow, FoxgloveClient(url) as quick:
            for client in (slow, quick):
                await client.subscribe("/big", 1)
                await client.sync()
            slow._reader.cancel()  # it reads no more
            began = time.monotonic()
            for number in range(200):
                payload = text(f"{number:04d}" + chunk)
                source.send("/big", payload, number)
                await asyncio.sleep(0)
            produced = time.monotonic() - began
            stamps = []
            while not stamps or stamps[-1] != 199:
                stamps.append((await quick.expect("message"))["stamp"])
            assert stamps == sorted(stamps)
            # The slow one wakes up: what is in the pipes, then only the newest few.
            slow._reader = asyncio.create_task(slow._read())
            late = []
            while not late or late[-1] != 199:
                late.append((await slow.expect("message"))["stamp"])
            assert late[-BACKLOG:] == list(range(200 - BACKLOG, 200))
            assert len(late) < 150
            return produced

    assert asyncio.run(run()) < 20


@pytest.mark.timing
def test_stops_within_a_second_with_clients_connected(source, tmp_path):
    server = StudioServer(source, port=0, static=tmp_path)
    server.start()
    stopped = threading.Event()

    async def run():
        url = f"ws://127.0.0.1:{server.port}/"
        async with FoxgloveClient(url) as polite, FoxgloveClient(url) as deaf:
            await polite.subscribe("/chatter", 1)
            await polite.sync()
            deaf._reader.cancel()

            def stop():
                server.stop()
                stopped.set()

            began = time.monotonic()
            await asyncio.to_thread(stop)
            took = time.monotonic() - began
            assert (await polite.expect("closed"))["code"] == 1001
            return took

    assert asyncio.run(run()) < 1.0
    assert stopped.is_set()
    assert source.listener_count("/chatter") == 0
    assert source.observers == []
    server.stop()  # twice is harmless


def test_a_client_that_vanishes_is_forgotten(server, source):
    async def conversation(client):
        await client.subscribe("/chatter", 1)
        await client.sync()
        client.socket._response.connection.transport.abort()

    talk(server, conversation)

    async def wait():
        async with asyncio.timeout(5):
            while server.client_count or source.listener_count("/chatter"):
                await asyncio.sleep(0.01)

    asyncio.run(wait())


async def get(server, path="/", **headers):
    async with (
        aiohttp.ClientSession(auto_decompress=False) as http,
        http.get(f"http://127.0.0.1:{server.port}{path}", headers=headers) as response,
    ):
        return response, await response.read()


def test_other_sites_and_other_names_are_refused(server):
    async def run():
        for headers in ({"Host": "evil.example"}, {"Origin": "http://evil.example"}):
            response, _ = await get(server, **headers)
            assert response.status == 403
        async with aiohttp.ClientSession() as http:
            with pytest.raises(aiohttp.WSServerHandshakeError) as caught:
                await http.ws_connect(
                    f"ws://127.0.0.1:{server.port}/",
                    protocols=SUBPROTOCOLS,
                    headers={"Origin": "http://evil.example"},
                )
            assert caught.value.status == 403
            with pytest.raises(aiohttp.WSServerHandshakeError) as caught:
                await http.ws_connect(f"ws://127.0.0.1:{server.port}/", protocols=["chat"])
            assert caught.value.status == 400

    asyncio.run(run())


def test_without_a_built_page_a_plain_one_tells_how_to_get_it(server):
    async def run():
        response, body = await get(server)
        assert response.status == 200
        assert response.content_type == "text/html"
        assert b"python -m daidalos.studio.build" in body

    asyncio.run(run())


def test_serves_what_is_only_there_compressed(server, tmp_path):
    (tmp_path / "static" / "assets").mkdir(parents=True)
    (tmp_path / "static" / "index.html").write_bytes(b"<!doctype html>")
    (tmp_path / "static" / "assets" / "large-abc.js.gz").write_bytes(gzip.compress(b"let a = 1;"))

    async def run():
        for accepted, unpacked in (("gzip, deflate", gzip.decompress), ("identity", bytes)):
            response, body = await get(server, "/assets/large-abc.js", **{"Accept-Encoding": accepted})
            assert (response.status, response.content_type) == (200, "text/javascript")
            assert "immutable" in response.headers["Cache-Control"]
            assert "default-src" in response.headers["Content-Security-Policy"]
            assert unpacked(body) == b"let a = 1;"
        response, _ = await get(server, "/assets/large-abc.js.gz")
        assert response.status == 404

    asyncio.run(run())


def test_serves_the_built_page(server, tmp_path):
    static = tmp_path / "static"
    (static / "assets").mkdir(parents=True)
    script = b"let a = 1;" * 100
    (static / "index.html").write_bytes(b"<!doctype html>")
    (static / "source.sha256").write_bytes(b"hash")
    (static / "assets" / "index-abc.js").write_bytes(script)
    (static / "assets" / "index-abc.js.gz").write_bytes(gzip.compress(script))
    (tmp_path / "secret").write_text("secret")
    os.makedirs(static / ".hidden", exist_ok=True)
    (static / ".hidden" / "x").write_text("hidden")

    async def run():
        response, body = await get(server)
        assert (response.content_type, body) == ("text/html", b"<!doctype html>")
        assert response.headers["Cache-Control"] == "no-cache"
        assert "frame-ancestors" in response.headers["Content-Security-Policy"]
        response, body = await get(server, "/assets/index-abc.js", **{"Accept-Encoding": "gzip"})
        assert response.content_type == "text/javascript"
        assert response.headers["Content-Encoding"] == "gzip"
        assert "immutable" in response.headers["Cache-Control"]
        assert gzip.decompress(body) == script
        response, body = await get(server, "/assets/index-abc.js", **{"Accept-Encoding": "identity"})
        assert body == script
        etag = response.headers["ETag"]
        response, _ = await get(
            server, "/assets/index-abc.js", **{"If-None-Match": etag, "Accept-Encoding": "identity"}
        )
        assert response.status == 304
        outside = [
            "/nothing",
            "/../secret",
            "/%2e%2e/secret",
            "/..%2fsecret",
            "/.hidden/x",
            "/assets",
            "//etc/passwd",
        ]
        for path in outside:
            assert b"404" in await first_line(server, path)

    asyncio.run(run())


async def first_line(server, path):
    """Ask for a path as it is written: clients tidy it up before they send it."""
    reader, writer = await asyncio.open_connection("127.0.0.1", server.port)
    writer.write(f"GET {path} HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n".encode())
    line = await reader.readline()
    writer.close()
    await writer.wait_closed()
    return line
