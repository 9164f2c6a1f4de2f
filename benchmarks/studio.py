"""What the studio's server carries, what it costs, and what a slow client costs; and how large the page is."""

from __future__ import annotations

import asyncio
import gzip
import json
import struct
import subprocess
import sys
import threading
import time
from collections.abc import Iterator, Sequence
from concurrent.futures import Future
from contextlib import contextmanager

import aiohttp
import psutil

from daidalos.studio.files import STATIC
from daidalos.studio.server import StudioServer
from daidalos.studio.source import Graph, MessageCallback, Observer, Parameter, Publication, Service, Topic

SECONDS = 4.0
STREAMS = {  # topic: bytes, hertz
    "/scan": (6_600, 10),
    "/image": (640 * 480 * 3, 30),
    "/cloud": (1 << 20, 10),
    "/tf": (1_200, 50),
}
SMALL_TOPICS = 64
SMALL_BYTES = 100
SLOW_MESSAGES = 400


def run() -> dict[str, float | str]:
    """Measure everything."""
    return measure_streams() | measure_small() | measure_slow() | measure_page()


class _Source:
    """A graph that only sends bytes."""

    def __init__(self, names: Sequence[str]) -> None:
        self.listeners: dict[str, MessageCallback] = {}
        self._topics = [Topic(name, "std_msgs/msg/String", "string data") for name in names]

    def attach(self, observer: Observer) -> _Handle:
        return _Handle()

    def topics(self) -> Sequence[Topic]:
        return self._topics

    def services(self) -> Sequence[Service]:
        return []

    def graph(self) -> Graph:
        return Graph()

    def time(self) -> int | None:
        return None

    def subscribe(self, topic: Topic, received: MessageCallback) -> _Handle:
        self.listeners[topic.name] = received
        return _Handle()

    def advertise(self, topic: str, type_name: str) -> Publication:
        raise NotImplementedError

    def call(self, service: str, request: bytes) -> Future[bytes]:
        raise NotImplementedError

    def get_parameters(self, names: Sequence[str]) -> Future[Sequence[Parameter]]:
        raise NotImplementedError

    def set_parameters(self, parameters: Sequence[Parameter]) -> Future[Sequence[Parameter]]:
        raise NotImplementedError

    def wait_for_listeners(self) -> None:
        while len(self.listeners) < len(self._topics):
            time.sleep(0.01)


class _Handle:
    def close(self) -> None:
        """Nothing to give back."""


@contextmanager
def _connected(names: Sequence[str], mode: str) -> Iterator[tuple[_Source, subprocess.Popen[str]]]:
    """Run a server with a client in a process of its own, subscribed to everything."""
    source = _Source(names)
    with StudioServer(source, port=0) as server:
        client = subprocess.Popen(
            [sys.executable, __file__, f"ws://127.0.0.1:{server.port}/", mode], stdout=subprocess.PIPE, text=True
        )
        try:
            source.wait_for_listeners()
            yield source, client
        finally:
            client.kill()
            client.wait()


def measure_streams() -> dict[str, float | str]:
    """Measure a robot's usual load: bytes, latency from publishing to the client, and the server's share of a core."""
    with _connected(list(STREAMS), "read") as (source, client):
        cpu, begun = time.process_time(), time.perf_counter()
        threads = [
            threading.Thread(target=_stream, args=(source.listeners[name], size, hertz))
            for name, (size, hertz) in STREAMS.items()
        ]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        seconds = time.perf_counter() - begun
        cpu = time.process_time() - cpu
        source.listeners["/tf"](0, b"end")
        got = json.loads(client.communicate()[0])
    return {
        "studio.stream_MB_s": got["bytes"] / seconds / 1e6,
        "studio.stream_cpu_percent": 100 * cpu / seconds,
        "studio.stream_latency_p50_ms": got["p50_ms"],
        "studio.stream_latency_p99_ms": got["p99_ms"],
    }


def _stream(send: MessageCallback, size: int, hertz: float) -> None:
    filler = bytes(size - 8)
    due = time.perf_counter()
    for _ in range(int(SECONDS * hertz)):
        send(0, struct.pack("<q", time.perf_counter_ns()) + filler)
        due += 1 / hertz
        time.sleep(max(0.0, due - time.perf_counter()))


def measure_small() -> dict[str, float | str]:
    """Small messages as fast as they go, from a thread beside the server's."""
    names = [f"/small{number}" for number in range(SMALL_TOPICS)]
    with _connected(names, "read") as (source, client):
        sends = [source.listeners[name] for name in names]
        filler = bytes(SMALL_BYTES - 8)
        begun = time.perf_counter()
        sent = 0
        while time.perf_counter() - begun < SECONDS:
            payload = struct.pack("<q", time.perf_counter_ns()) + filler
            for send in sends:
                send(0, payload)
            sent += len(sends)
        seconds = time.perf_counter() - begun
        for _ in range(2):
            sends[0](0, b"end")
        got = json.loads(client.communicate()[0])
    return {
        "studio.small_sent_per_s": sent / seconds,
        "studio.small_delivered_per_s": got["messages"] / seconds,
    }


def measure_slow() -> dict[str, float | str]:
    """Measure the memory that a client costs which reads nothing while messages of 1 MB come."""
    with _connected(["/big"], "deaf") as (source, _):
        process = psutil.Process()
        before = process.memory_info().rss
        most = before
        longest = 0.0
        for number in range(SLOW_MESSAGES):
            payload = number.to_bytes(4, "little") * 250_000
            begun = time.perf_counter()
            source.listeners["/big"](0, payload)
            longest = max(longest, time.perf_counter() - begun)
            most = max(most, process.memory_info().rss)
    return {
        "studio.slow_client_MB": (most - before) / 1e6,
        "studio.slow_client_longest_send_ms": 1000 * longest,
    }


def measure_page() -> dict[str, float | str]:
    """Measure the size of the built page."""
    packed = [path for path in STATIC.rglob("*.gz") if path.with_suffix("").suffix in {".js", ".css", ".html"}]
    if not packed:
        return {"studio.page_kB": "not built"}
    return {
        "studio.page_kB": sum(len(gzip.decompress(path.read_bytes())) for path in packed) / 1e3,
        "studio.page_gzip_kB": sum(path.stat().st_size for path in packed) / 1e3,
    }


async def _client(url: str, mode: str) -> None:
    """Subscribe to everything; read until a message says "end", or read nothing any more."""
    latencies: list[int] = []
    total = 0
    async with (
        aiohttp.ClientSession() as http,
        http.ws_connect(url, protocols=("foxglove.sdk.v1",), max_msg_size=0) as socket,
    ):
        async for frame in socket:
            if frame.type is aiohttp.WSMsgType.TEXT:
                message = json.loads(frame.data)
                if message["op"] == "advertise":
                    ids = [channel["id"] for channel in message["channels"]]
                    wanted = [{"id": number, "channelId": number} for number in ids]
                    await socket.send_json({"op": "subscribe", "subscriptions": wanted})
                    if mode == "deaf":
                        await asyncio.Event().wait()
            elif frame.data[13:] == b"end":
                break
            else:
                total += len(frame.data)
                latencies.append(time.perf_counter_ns() - struct.unpack_from("<q", frame.data, 13)[0])
    latencies.sort()
    print(
        json.dumps(
            {
                "messages": len(latencies),
                "bytes": total,
                "p50_ms": latencies[len(latencies) // 2] / 1e6,
                "p99_ms": latencies[int(len(latencies) * 0.99)] / 1e6,
            }
        )
    )


if __name__ == "__main__":
    asyncio.run(_client(sys.argv[1], sys.argv[2]))
