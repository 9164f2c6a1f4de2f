"""What a thousand hostile clients cost the studio's server: memory, and the latency of a client that behaves.

The hostile ones ask without reading, send frames that never end, subscribe without end, or never send a request; those
that the server closes connect again at once.

On a busy machine the latency is mostly the machine's. `own_delay` is the server's share: for how long its event loop
was late and computed meanwhile, in CPU time. `DAIDALOS_HOSTILE_NICE` is the niceness of the attackers, 19 by default;
where other programs leave no time at that, they hardly attack: `attackers_cpu_percent` says how much.
"""

from __future__ import annotations

import asyncio
import contextlib
import gc
import itertools
import json
import os
import statistics
import struct
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

import aiohttp
import psutil

from benchmarks.studio import _Source
from daidalos.studio.assets import AssetResolver
from daidalos.studio.server import StudioServer

CLIENTS = 1000
QUIET_S, HOSTILE_S = 3.0, 20.0
MESSAGE_BYTES, HERTZ = 100_000, 30
ASSET_BYTES = 20 << 20
FRAME_BYTES = 59 << 20
RECONNECT_S = 0.5
HANDSHAKE = (
    b"GET / HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
    b"Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: MDEyMzQ1Njc4OWFiY2RlZg==\r\n"
    b"Sec-WebSocket-Protocol: foxglove.sdk.v1\r\n\r\n"
)


def run() -> dict[str, float]:
    """Measure latency without and with the hostile clients, and the memory that the server takes for them."""
    source = _Source(["/scan"])
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "big.stl").write_bytes(bytes(ASSET_BYTES))
        with StudioServer(source, port=0, assets=AssetResolver(lambda name: Path(folder))) as server:
            gc.freeze()  # as programs that run a node do
            client = _start("behave", server.port)
            source.wait_for_listeners()
            stop = threading.Event()
            publisher = threading.Thread(target=_publish, args=(source, stop))
            publisher.start()
            delays = _Delays(server)
            time.sleep(QUIET_S)
            quiet_delays = delays.take()
            process = psutil.Process()
            before = most = process.memory_info().rss
            begin, used = time.perf_counter(), time.process_time()
            hostile = _start("attack", server.port)
            while time.perf_counter() - begin < HOSTILE_S:
                most = max(most, process.memory_info().rss)
                time.sleep(0.05)
            used = time.process_time() - used
            own = delays.take()
            attacked = sum(psutil.Process(hostile.pid).cpu_times()[:2])
            hostile.kill()
            hostile.wait()
            stop.set()
            publisher.join()
            source.listeners["/scan"](0, b"end")
            times = json.loads(client.communicate()[0])
    quiet = [latency for when, latency in times if when < begin]
    during = [latency for when, latency in times if when > begin + 1.0]
    return {
        "studio_hostile.latency_p50_before_ms": statistics.median(quiet),
        "studio_hostile.latency_p99_before_ms": _p99(quiet),
        "studio_hostile.latency_p50_ms": statistics.median(during),
        "studio_hostile.latency_p99_ms": _p99(during),
        "studio_hostile.own_delay_p99_before_ms": _p99(quiet_delays),
        "studio_hostile.own_delay_p50_ms": statistics.median(own),
        "studio_hostile.own_delay_p99_ms": _p99(own),
        "studio_hostile.own_delay_max_ms": max(own),
        "studio_hostile.messages_received_percent": 100 * len(during) / ((HOSTILE_S - 1.0) * HERTZ),
        "studio_hostile.cpu_percent": 100 * used / HOSTILE_S,
        "studio_hostile.attackers_cpu_percent": 100 * attacked / HOSTILE_S,
        "studio_hostile.memory_growth_MB": (most - before) / 1e6,
    }


def _p99(values: list[float]) -> float:
    return sorted(values)[len(values) * 99 // 100]


class _Delays:
    """Delays of the server's event loop that are its own work [ms], sampled every millisecond.

    What it did in the millisecond before counts as well, where the processor was taken away from it after that.
    """

    PERIOD_S = 0.001

    def __init__(self, server: StudioServer) -> None:
        self._found: list[float] = []
        server._soon(self._start)

    def take(self) -> list[float]:
        """Return the delays since the last call."""
        found, self._found = self._found, []
        return found

    def _start(self) -> None:
        self._loop = asyncio.get_running_loop()
        self._plan()

    def _plan(self) -> None:
        self._due, self._used = self._loop.time() + self.PERIOD_S, time.thread_time()
        self._loop.call_at(self._due, self._sample)

    def _sample(self) -> None:
        late, used = self._loop.time() - self._due, time.thread_time() - self._used
        self._found.append(1000 * max(0.0, min(late, used)))
        self._plan()


def _publish(source: _Source, stop: threading.Event) -> None:
    filler = bytes(MESSAGE_BYTES - 8)
    due = time.perf_counter()
    while not stop.is_set():
        source.listeners["/scan"](0, struct.pack("<d", time.perf_counter()) + filler)
        due += 1 / HERTZ
        time.sleep(max(0.0, due - time.perf_counter()))


def _start(role: str, port: int) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-m", "benchmarks.studio_hostile", role, str(port)], stdout=subprocess.PIPE, text=True
    )


async def behave(port: int) -> None:
    """Print when messages were sent and how long they took, in ms."""
    times: list[tuple[float, float]] = []
    async with (
        aiohttp.ClientSession() as http,
        http.ws_connect(f"ws://127.0.0.1:{port}/", protocols=("foxglove.sdk.v1",), max_msg_size=0) as socket,
    ):
        async for frame in socket:
            if frame.type is aiohttp.WSMsgType.TEXT:
                message = json.loads(frame.data)
                if message["op"] == "advertise":
                    wanted = [{"id": 1, "channelId": message["channels"][0]["id"]}]
                    await socket.send_json({"op": "subscribe", "subscriptions": wanted})
            elif frame.data[13:] == b"end":
                break
            else:
                (sent,) = struct.unpack_from("<d", frame.data, 13)
                times.append((sent, 1000 * (time.perf_counter() - sent)))
    print(json.dumps(times))


async def attack(port: int) -> None:
    """Attack with all clients until killed; what they do themselves takes no time from the server."""
    os.nice(int(os.environ.get("DAIDALOS_HOSTILE_NICE", "19")))
    ways = itertools.cycle((_ask, _never_end, _subscribe, _say_nothing))
    await asyncio.gather(*(_repeat(next(ways), port) for _ in range(CLIENTS)))


async def _repeat(way, port: int) -> None:
    while True:
        with contextlib.suppress(OSError, asyncio.IncompleteReadError):
            reader, writer = await asyncio.open_connection("127.0.0.1", port)
            try:
                await way(reader, writer)
            finally:
                writer.close()
        await asyncio.sleep(RECONNECT_S)


async def _ask(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
    """Ask for large assets, and read nothing."""
    writer.transport.pause_reading()
    request = json.dumps({"op": "fetchAsset", "requestId": 1, "uri": "package://p/big.stl"}).encode()
    writer.write(HANDSHAKE)
    while True:
        writer.write(_frame(request) * 100)
        await writer.drain()
        await asyncio.sleep(0.05)


async def _never_end(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
    """Send a large frame but for its last byte."""
    writer.write(HANDSHAKE)
    await reader.readuntil(b"serverInfo")
    writer.write(b"\x82\xff" + struct.pack(">Q", FRAME_BYTES + 1) + bytes(4))
    for _ in range(FRAME_BYTES >> 16):
        writer.write(bytes(1 << 16))
        await writer.drain()
    await reader.read()


async def _subscribe(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
    """Subscribe to one channel again and again."""
    writer.write(HANDSHAKE)
    wanted = [{"id": number, "channelId": 1} for number in range(1500)]
    frame = _frame(json.dumps({"op": "subscribe", "subscriptions": wanted}).encode())
    while True:
        writer.write(frame)
        await writer.drain()
        await reader.read(1 << 16)


async def _say_nothing(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
    """Send a part of a request."""
    writer.write(HANDSHAKE[:50])
    await reader.read()


def _frame(text: bytes) -> bytes:
    length = bytes([0x80 | len(text)]) if len(text) < 126 else bytes([0xFE]) + struct.pack(">H", len(text))
    if len(text) >= 1 << 16:
        raise ValueError("too long for this frame")
    return b"\x81" + length + bytes(4) + text


ROLES = {"behave": behave, "attack": attack}

if __name__ == "__main__":
    asyncio.run(ROLES[sys.argv[1]](int(sys.argv[2])))
