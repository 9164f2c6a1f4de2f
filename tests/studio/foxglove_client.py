"""A client of the published Foxglove WebSocket protocol, written from its text, independent of the server."""

import asyncio
import json
import struct
from collections import deque
from typing import Any

import aiohttp

SUBPROTOCOL = "foxglove.sdk.v1"
TIMEOUT_S = 10


class FoxgloveClient:
    """Connects, sorts what the server says by its op, and waits for what a test expects."""

    def __init__(self, url: str, subprotocol: str = SUBPROTOCOL) -> None:
        self.url = url
        self.subprotocol = subprotocol
        self.info: dict[str, Any] = {}
        self.channels: dict[str, dict[str, Any]] = {}
        self.services: dict[str, dict[str, Any]] = {}
        self._inbox: deque[dict[str, Any]] = deque()
        self._arrived = asyncio.Event()

    async def __aenter__(self) -> "FoxgloveClient":
        self._http = aiohttp.ClientSession()
        self.socket = await self._http.ws_connect(self.url, protocols=(self.subprotocol,), max_msg_size=0)
        self._reader = asyncio.create_task(self._read())
        self.info = await self.expect("serverInfo")
        return self

    async def __aexit__(self, *_: object) -> None:
        self._reader.cancel()
        await self._http.close()

    async def say(self, op: str, **fields: Any) -> None:
        await self.socket.send_str(json.dumps({"op": op, **fields}))

    async def expect(self, op: str, **fields: Any) -> dict[str, Any]:
        """The next thing of this op with these fields; what comes before it stays for others."""

        def matches(message: dict[str, Any]) -> bool:
            return message["op"] == op and all(message.get(key) == value for key, value in fields.items())

        async with asyncio.timeout(TIMEOUT_S):
            while True:
                for message in self._inbox:
                    if matches(message):
                        self._inbox.remove(message)
                        return message
                self._arrived.clear()
                await self._arrived.wait()

    def waiting(self, op: str) -> list[dict[str, Any]]:
        return [message for message in self._inbox if message["op"] == op]

    async def channel(self, topic: str) -> dict[str, Any]:
        """The channel of a topic, as soon as it is advertised."""
        async with asyncio.timeout(TIMEOUT_S):
            while topic not in self.channels:
                self._arrived.clear()
                await self._arrived.wait()
        return self.channels[topic]

    async def service(self, name: str) -> dict[str, Any]:
        async with asyncio.timeout(TIMEOUT_S):
            while name not in self.services:
                self._arrived.clear()
                await self._arrived.wait()
        return self.services[name]

    async def subscribe(self, topic: str, number: int) -> None:
        channel = await self.channel(topic)
        await self.say("subscribe", subscriptions=[{"id": number, "channelId": channel["id"]}])

    async def sync(self) -> None:
        """Return when the server has dealt with all that was said before."""
        await self.say("fetchAsset", requestId=4_000_000_000, uri="sync:")
        await self.expect("asset", request=4_000_000_000)

    async def _read(self) -> None:
        async for frame in self.socket:
            if frame.type is aiohttp.WSMsgType.TEXT:
                self._sort(json.loads(frame.data))
            elif frame.type is aiohttp.WSMsgType.BINARY:
                self._inbox.append(_parse(frame.data))
            self._arrived.set()
        self._inbox.append({"op": "closed", "code": self.socket.close_code})
        self._arrived.set()

    def _sort(self, message: dict[str, Any]) -> None:
        match message["op"]:
            case "advertise":
                self.channels.update({each["topic"]: each for each in message["channels"]})
            case "unadvertise":
                gone = set(message["channelIds"])
                self.channels = {t: each for t, each in self.channels.items() if each["id"] not in gone}
            case "advertiseServices":
                self.services.update({each["name"]: each for each in message["services"]})
            case "unadvertiseServices":
                gone = set(message["serviceIds"])
                self.services = {n: each for n, each in self.services.items() if each["id"] not in gone}
        self._inbox.append(message)


def _parse(frame: bytes) -> dict[str, Any]:
    match frame[0]:
        case 1:
            subscription, stamp = struct.unpack_from("<IQ", frame, 1)
            return {"op": "message", "subscription": subscription, "stamp": stamp, "payload": frame[13:]}
        case 2:
            return {"op": "time", "stamp": struct.unpack_from("<Q", frame, 1)[0]}
        case 3:
            service, call, length = struct.unpack_from("<III", frame, 1)
            encoding = frame[13 : 13 + length].decode()
            return {
                "op": "serviceResponse",
                "service": service,
                "call": call,
                "encoding": encoding,
                "payload": frame[13 + length :],
            }
        case 4:
            request, failed, length = struct.unpack_from("<IBI", frame, 1)
            error = frame[10 : 10 + length].decode()
            return {
                "op": "asset",
                "request": request,
                "failed": bool(failed),
                "error": error,
                "data": frame[10 + length :],
            }
    raise AssertionError(f"unknown opcode {frame[0]}")
