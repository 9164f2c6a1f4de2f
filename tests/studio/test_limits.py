"""What hostile clients cost the server and its other clients."""

import asyncio
import contextlib
import gc
import json
import logging
import socket
import struct
import threading
import time
import weakref
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import psutil
import pytest

from daidalos.studio import connections
from daidalos.studio import stream_client as client_module
from daidalos.studio.access import Refusal, Request
from daidalos.studio.assets import AssetResolver
from daidalos.studio.connections import Connection, Connections
from daidalos.studio.frames import asset_head
from daidalos.studio.limits import (
    MAX_ENTRIES,
    MAX_ERRORS,
    MAX_PUBLICATIONS,
    MAX_VALUES,
    PIECE_BYTES,
    SLICE_REQUESTS,
    Turn,
)
from daidalos.studio.protocol import SUBPROTOCOLS
from daidalos.studio.server import StudioServer

from .foxglove_client import FoxgloveClient
from .memory_source import MemorySource, encode, make

STRING = "std_msgs/msg/String"
TIMEOUT_S = 20
HANDSHAKE = (
    b"GET / HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
    b"Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: MDEyMzQ1Njc4OWFiY2RlZg==\r\n"
    b"Sec-WebSocket-Protocol: foxglove.sdk.v1\r\n\r\n"
)


@pytest.fixture
def source():
    source = MemorySource()
    source.add_topic("/chatter", STRING)
    return source


@pytest.fixture
def server(source, tmp_path):
    (tmp_path / "share" / "pkg").mkdir(parents=True)
    (tmp_path / "share" / "pkg" / "big.stl").write_bytes(bytes(4_000_000))
    assets = AssetResolver(lambda name: tmp_path / "share" / name)
    with StudioServer(source, name="test", port=0, assets=assets, static=tmp_path / "static") as server:
        yield server


def talk(server, conversation):
    async def run():
        async with FoxgloveClient(f"ws://127.0.0.1:{server.port}/", SUBPROTOCOLS[0]) as client:
            return await conversation(client)

    return asyncio.run(run())


@contextmanager
def raw(server: StudioServer, *begin: bytes) -> Iterator[socket.socket]:
    with socket.create_connection(("127.0.0.1", server.port), timeout=TIMEOUT_S) as opened:
        for data in begin:
            opened.sendall(data)
        yield opened


def read_all(opened: socket.socket) -> bytes:
    """Read until the server closes."""
    data = b""
    try:
        while chunk := opened.recv(1 << 16):
            data += chunk
    except ConnectionResetError:
        pass
    return data


@contextmanager
def hostile(server: StudioServer, *data: bytes) -> Iterator[socket.socket]:
    """Yield a WebSocket on which the server has been introduced, and that sends `data` then."""
    with raw(server, HANDSHAKE) as opened:
        introduced = b""
        while b"serverInfo" not in introduced:
            introduced += opened.recv(1 << 16)
        for each in data:
            opened.sendall(each)
        yield opened


def until(condition: Callable[[], object]) -> None:
    deadline = time.monotonic() + TIMEOUT_S
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.01)


def test_a_channel_is_subscribed_to_once_and_long_lists_are_refused(server, source):
    async def conversation(client):
        channel = (await client.channel("/chatter"))["id"]
        wanted = [{"id": number, "channelId": channel} for number in range(MAX_ENTRIES)]
        await client.say("subscribe", subscriptions=wanted)
        await client.sync()
        assert len(client.waiting("status")) == MAX_ERRORS
        await client.say("subscribe", subscriptions=[*wanted, *wanted])
        refusal = await client.expect("status", level=2)
        assert f"at most {MAX_ENTRIES}" in refusal["message"]
        assert source.listener_count("/chatter") == 1

    talk(server, conversation)


def test_a_client_advertises_so_many_channels(server):
    async def conversation(client):
        for begin in (0, MAX_PUBLICATIONS):
            channels = [
                {"id": begin + number, "topic": f"/t{begin + number}", "encoding": "cdr", "schemaName": STRING}
                for number in range(MAX_PUBLICATIONS)
            ]
            await client.say("advertise", channels=channels)
        assert f"more than {MAX_PUBLICATIONS}" in (await client.expect("status", level=2))["message"]

    talk(server, conversation)


def test_a_text_of_many_values_is_refused_before_it_is_read(server):
    async def conversation(client):
        await client.say("getParameters", parameterNames=[[0] * (MAX_VALUES + 1)])
        assert f"more than {MAX_VALUES} values" in (await client.expect("status", level=2))["message"]

    talk(server, conversation)


def test_a_long_text_closes_the_client_with_the_reason(server, monkeypatch):
    monkeypatch.setattr(client_module, "MAX_TEXT_BYTES", 1000)

    async def conversation(client):
        await client.say("getParameters", parameterNames=["x" * 2000])
        assert (await client.expect("closed"))["code"] == 1008

    talk(server, conversation)


@pytest.mark.slow
def test_who_sends_no_request_in_time_is_closed_with_the_reason(server, monkeypatch):
    monkeypatch.setattr(connections, "HANDSHAKE_S", 0.2)
    with raw(server) as silent, raw(server, HANDSHAKE[:40]) as slow:
        for opened in (silent, slow):
            assert b"408 Request Timeout" in read_all(opened)


def test_more_connections_than_the_limit_push_out_those_without_a_request(server, monkeypatch):
    monkeypatch.setattr(connections, "MAX_CONNECTIONS", 4)

    async def conversation(client):
        with hostile(server), raw(server) as oldest, raw(server), raw(server):
            assert b"503" in await asyncio.to_thread(read_all, oldest)
            await client.sync()

    talk(server, conversation)


def test_where_all_have_asked_a_further_connection_is_refused(server, monkeypatch):
    monkeypatch.setattr(connections, "MAX_CONNECTIONS", 2)
    with hostile(server), hostile(server), raw(server) as third:
        assert b"503" in read_all(third)


def test_unfinished_frames_are_dropped_beyond_the_limit(server, monkeypatch, caplog):
    monkeypatch.setattr(connections, "MAX_UNFINISHED_BYTES", 3_000_000)
    begin = b"\x82\xff" + struct.pack(">Q", 50_000_000) + bytes(4) + bytes(1_200_000)  # masked, binary, 50 MB

    async def conversation(client):
        with hostile(server, begin), hostile(server, begin), hostile(server, begin):
            while server.client_count > 3:
                await asyncio.sleep(0.01)
            await client.sync()

    with caplog.at_level(logging.WARNING):
        talk(server, conversation)
    assert "incomplete messages" in caplog.text


@pytest.mark.slow
def test_a_message_that_stays_unfinished_closes_the_client(server, monkeypatch):
    monkeypatch.setattr(connections, "MESSAGE_S", 0.2)
    with hostile(server, b"\x82\xff" + struct.pack(">Q", 1000) + bytes(20)) as opened:
        assert b"not complete after" in read_all(opened)


def test_who_asks_for_assets_and_reads_nothing_costs_little(server):
    request = json.dumps({"op": "fetchAsset", "requestId": 1, "uri": "package://pkg/big.stl"}).encode()
    frame = b"\x81" + bytes([0x80 | 126]) + struct.pack(">H", len(request)) + bytes(4) + request
    process = psutil.Process()

    async def conversation(client):
        await client.sync()
        before = process.memory_info().rss
        with hostile(server, frame * 200):
            for _ in range(20):
                await client.sync()
            assert process.memory_info().rss - before < 60_000_000

    talk(server, conversation)


@pytest.mark.slow
def test_who_reads_nothing_is_closed(server, source, monkeypatch, caplog):
    monkeypatch.setattr(connections, "STALL_S", 0.5)
    source.add_topic("/big", STRING)

    async def conversation(client):
        with hostile(server) as deaf:
            deaf.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 16)
            channel = (await client.channel("/big"))["id"]
            text = json.dumps({"op": "subscribe", "subscriptions": [{"id": 1, "channelId": channel}]}).encode()
            deaf.sendall(b"\x81" + bytes([0x80 | len(text)]) + bytes(4) + text)
            while not source.listener_count("/big"):
                await asyncio.sleep(0.01)
            payload = encode(STRING, make(STRING, data="x" * 8_000_000))
            while server.client_count > 1:
                source.send("/big", payload)
                await asyncio.sleep(0.05)

    with caplog.at_level(logging.WARNING):
        talk(server, conversation)
    assert "nothing was read" in caplog.text


def test_clients_that_never_stop_asking_leave_the_others_latency_alone(server):
    """Small version of the benchmark `studio_hostile`."""
    text = b'{"op":"subscribe","subscriptions":[{"id":1,"channelId":999}]}'
    many = (b"\x81" + bytes([0x80 | len(text)]) + bytes(4) + text) * 3000  # half a second of work for the server

    async def conversation(client):
        with contextlib.ExitStack() as stack:
            for _ in range(20):
                opened = stack.enter_context(hostile(server))
                opened.setblocking(False)
                with contextlib.suppress(BlockingIOError):
                    opened.send(many)
            for _ in range(5):
                begin = time.monotonic()
                await client.sync()
                assert time.monotonic() - begin < TIMEOUT_S / 10

    talk(server, conversation)


@pytest.mark.parametrize("last", [1, 125, 126, 65535, 65536])
def test_a_large_message_is_sent_in_fragments(server, tmp_path, last):
    data = (bytes(range(256)) * 3072)[: (512 << 10) + last - len(asset_head(1))]
    (tmp_path / "share" / "pkg" / "some.stl").write_bytes(data)

    async def conversation(client):
        await client.say("fetchAsset", uri="package://pkg/some.stl", requestId=1)
        assert (await client.expect("asset", request=1))["data"] == data

    talk(server, conversation)
    request = json.dumps({"op": "fetchAsset", "uri": "package://pkg/some.stl", "requestId": 1}).encode()
    with hostile(server, b"\x81" + bytes([0x80 | len(request)]) + bytes(4) + request) as opened:
        heads = []
        while not heads or heads[-1] != (0x80, last):
            heads.append(_skip_frame(opened))
    assert heads[-3:] == [(0x02, 256 << 10), (0x00, 256 << 10), (0x80, last)]


def _skip_frame(opened: socket.socket) -> tuple[int, int]:
    """Read a frame, and return the first byte of its head and its length, as short as it can be written."""

    def read(size: int) -> bytes:
        data = b""
        while len(data) < size:
            data += opened.recv(size - len(data))
        return data

    first, length = read(2)
    if length == 126:
        (length,) = struct.unpack(">H", read(2))
        assert length > 125
    elif length == 127:
        (length,) = struct.unpack(">Q", read(8))
        assert length > 65535
    read(length)
    return first, length


def test_memory_that_waits_to_be_read_is_taken_from_who_reads_least(monkeypatch):
    monkeypatch.setattr(connections, "MAX_HELD_BYTES", 1000)

    class Stream:
        def __init__(self, waiting: int) -> None:
            self.waiting_bytes = waiting
            self.reason = ""

        def stop(self, reason: str) -> None:
            self.reason = reason

    async def run():
        made = Connections()
        streams = [Stream(100), Stream(950)]
        for stream in streams:
            one = Connection(made, asyncio.Protocol())
            one.complete()
            one.stream = stream
            made.add(one)
        made.check(asyncio.get_running_loop().time())
        assert [bool(stream.reason) for stream in streams] == [False, True]

    asyncio.run(run())


def test_clients_take_turns_and_leave_time_to_everything_else():
    async def main() -> tuple[list[str], int]:
        order, handled, looks = asyncio.Lock(), [], 0

        async def ask(name: str) -> None:
            turn = Turn(order)
            for _ in range(10 * SLICE_REQUESTS):
                async with turn:
                    handled.append(name)

        async def look() -> None:
            nonlocal looks
            while True:
                looks += 1
                await asyncio.sleep(0)

        looking = asyncio.create_task(look())
        await asyncio.gather(ask("a"), ask("b"))
        looking.cancel()
        return handled, looks

    handled, looks = asyncio.run(main())
    assert handled[100:200].count("a") == handled[100:200].count("b")
    assert looks >= len(handled) // SLICE_REQUESTS


def test_what_a_client_sends_at_once_becomes_messages_piece_by_piece():
    class Parser(asyncio.Protocol):
        def __init__(self) -> None:
            self.pieces: list[int] = []
            self.come = asyncio.Event()

        def data_received(self, data: bytes) -> None:
            self.pieces.append(len(data))
            self.come.set()

    class Open:
        waiting_bytes = 0

        def stop(self, reason: str) -> None:
            """Implement `Stream`."""

    async def main() -> list[int]:
        own, other = socket.socketpair()
        parser = Parser()
        connections = Connections()
        connection = Connection(connections, parser)
        connection.stream = Open()
        transport, _ = await asyncio.get_running_loop().connect_accepted_socket(lambda: connection, own)
        sent = asyncio.create_task(asyncio.to_thread(other.sendall, bytes(20 * PIECE_BYTES)))
        while sum(parser.pieces) < 20 * PIECE_BYTES:
            parser.come.clear()
            connection.want()
            async with asyncio.timeout(60.0):
                await parser.come.wait()
            connection.complete()
        await sent
        transport.abort()
        other.close()
        return parser.pieces

    assert max(asyncio.run(main())) <= PIECE_BYTES


def test_of_requests_that_come_together_one_begins_in_each_step_of_the_event_loop(server, monkeypatch):
    step, begun, stands = 0, [], threading.Event()
    refusal = server._access.refusal

    def count() -> None:
        nonlocal step
        step += 1
        asyncio.get_running_loop().call_soon(count)

    def note(request: Request) -> Refusal | None:
        begun.append(step)
        return refusal(request)

    monkeypatch.setattr(server._access, "refusal", note)
    with contextlib.ExitStack() as opened:
        clients = [opened.enter_context(raw(server)) for _ in range(20)]
        until(lambda: len(server._connections._open) == len(clients))
        server._soon(lambda: stands.wait(TIMEOUT_S))
        for client in clients:
            client.sendall(HANDSHAKE)
        server._soon(count)
        stands.set()
        until(lambda: server.client_count == len(clients))
    assert len(set(begun)) == len(clients)


def test_what_a_client_held_is_freed_without_the_garbage_collector(server):
    gc.collect()
    gc.disable()
    try:
        with raw(server, HANDSHAKE):
            until(lambda: server.client_count == 1)
            (client,) = map(weakref.ref, server._clients)
        until(lambda: server.client_count == 0 and client() is None)
    finally:
        gc.enable()
