"""Web page that fills a projector with a picture, and says where somebody clicks on it."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable
from typing import Any

from daidalos.common.errors import UserError

_PAGE = """<!doctype html><meta charset="utf-8"><title>Projector</title>
<style>html,body{margin:0;height:100%;background:#000;overflow:hidden;cursor:crosshair}
img{width:100vw;height:100vh;display:block}</style><img id="picture" src="/stream" draggable="false">
<script>
const picture = document.getElementById("picture");
picture.onclick = ({clientX, clientY}) => fetch("/click", {method: "POST", body: JSON.stringify(
    [clientX / picture.clientWidth, clientY / picture.clientHeight])});
document.ondblclick = () => document.documentElement.requestFullscreen();
</script>"""
_BOUNDARY = "picture"


class PictureServer:
    """Server of one picture at ``http://host:port/``, which changes in all browsers at once, until `close`.

    Parameters
    ----------
    host : str
    port : int
        0 for a free one; `port` says which.
    clicked : callable, optional
        Called with the place of a click, each from 0 to 1, on the server's thread.

    Raises
    ------
    UserError
        When it cannot listen there.
    """

    def __init__(self, host: str, port: int, clicked: Callable[[float, float], None] | None = None) -> None:
        self._clicked = clicked or (lambda x, y: None)
        self._picture = b""
        self._loop = asyncio.new_event_loop()
        self._changed = asyncio.Condition()
        self._number = 0
        self._is_ending = False
        self._is_up = threading.Event()
        self._problem = ""
        self.port = port
        self._thread = threading.Thread(target=self._run, args=(host, port), name="pictures", daemon=True)
        self._thread.start()
        self._is_up.wait()
        if self._problem:
            self._thread.join()
            raise UserError(self._problem)

    def show(self, png: bytes) -> None:
        """Show a picture in PNG."""
        asyncio.run_coroutine_threadsafe(self._change(png), self._loop).result()

    def close(self) -> None:
        """Stop serving."""
        if not self._thread.is_alive():
            return
        self._is_ending = True
        asyncio.run_coroutine_threadsafe(self._change(self._picture), self._loop).result()
        asyncio.run_coroutine_threadsafe(self._runner.cleanup(), self._loop).result()
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join()

    async def _change(self, png: bytes) -> None:
        async with self._changed:
            self._picture, self._number = png, self._number + 1
            self._changed.notify_all()

    def _run(self, host: str, port: int) -> None:
        asyncio.set_event_loop(self._loop)
        try:
            self._loop.run_until_complete(self._start(host, port))
        except OSError as error:
            self._problem = f"the projector's page cannot be served at {host}:{port}: {error.strerror}"
            self._is_up.set()
            return
        self._is_up.set()
        self._loop.run_forever()
        self._loop.close()

    async def _start(self, host: str, port: int) -> None:
        from aiohttp import web

        application = web.Application()
        application.add_routes(
            [web.get("/", self._page), web.get("/stream", self._stream), web.get("/picture.png", self._single),
             web.post("/click", self._click)]
        )  # fmt: skip
        self._runner: Any = web.AppRunner(application, shutdown_timeout=1.0)
        await self._runner.setup()
        await web.TCPSite(self._runner, host, port).start()
        self.port = self._runner.addresses[0][1]

    async def _page(self, request: Any) -> Any:
        from aiohttp import web

        return web.Response(text=_PAGE, content_type="text/html")

    async def _single(self, request: Any) -> Any:
        from aiohttp import web

        return web.Response(body=self._picture, content_type="image/png", headers={"Cache-Control": "no-store"})

    async def _click(self, request: Any) -> Any:
        from aiohttp import web

        try:
            x, y = (float(one) for one in await request.json())
        except (ValueError, TypeError):
            raise web.HTTPBadRequest(text="expected [x, y]") from None
        if not (0.0 <= x <= 1.0 and 0.0 <= y <= 1.0):
            raise web.HTTPBadRequest(text="x and y must be from 0 to 1")
        self._clicked(x, y)
        return web.Response()

    async def _stream(self, request: Any) -> Any:
        """Send each picture as a part of a multipart response, the newest where a browser is slow."""
        from aiohttp import web

        response = web.StreamResponse(headers={"Content-Type": f"multipart/x-mixed-replace; boundary={_BOUNDARY}"})
        await response.prepare(request)
        sent = -1
        while not self._is_ending:
            number, png = self._number, self._picture
            # A browser shows a part when the next one begins: each is sent twice.
            head = f"--{_BOUNDARY}\r\nContent-Type: image/png\r\nContent-Length: {len(png)}\r\n\r\n".encode()
            await response.write(2 * (head + png + b"\r\n"))
            sent = number
            async with self._changed:
                await self._changed.wait_for(lambda sent=sent: self._number != sent)  # type: ignore[misc]
        return response
