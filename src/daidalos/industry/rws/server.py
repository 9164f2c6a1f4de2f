"""The web server of Robot Web Services: version 1.0 of IRC5 with digests, version 2.0 of OmniCore over TLS."""

from __future__ import annotations

import asyncio
import ssl
from collections.abc import Awaitable, Callable, Mapping
from contextlib import suppress
from urllib.parse import unquote

from aiohttp import WSMsgType, web

from daidalos.common.errors import UserError
from daidalos.industry.rws import rendering
from daidalos.industry.rws.access import COOKIE, Access
from daidalos.industry.rws.controller import Refused, VirtualController
from daidalos.industry.rws.resources import Item, Malformed, Resources, Unknown
from daidalos.industry.rws.subscriptions import Subscriptions

LOOPBACK = "127.0.0.1"
MAX_BODY = 1 << 16
_PROTOCOLS = {1: "robapi2_subscription", 2: "rws_subscription"}
_LOOK_S = 0.05

Handler = Callable[[web.Request], Awaitable[web.StreamResponse]]


class RwsServer:
    """Web services of a controller.

    Parameters
    ----------
    controller : VirtualController
    version : int
        1 or 2.
    access : Access
    """

    def __init__(self, controller: VirtualController, version: int = 1, access: Access | None = None) -> None:
        if version not in _PROTOCOLS:
            raise ValueError(f"the version of Robot Web Services is {version}, but must be 1 or 2")
        self.version = version
        self._access = access or Access(is_basic=version == 2)
        self._resources = Resources(controller)
        self._subscriptions = Subscriptions(self._resources)

    def application(self) -> web.Application:
        """Return the application that answers requests."""
        application = web.Application(middlewares=[self._guard], client_max_size=MAX_BODY)
        application.router.add_post("/subscription", self._subscribe)
        application.router.add_delete("/subscription/{number}", self._unsubscribe)
        application.router.add_get("/poll/{number}", self._poll)
        application.router.add_get("/{path:.*}", self._get)
        application.router.add_route("*", "/{path:.*}", self._post)
        return application

    async def serve(
        self, address: str, port: int, context: ssl.SSLContext | None, started: Callable[[int], None]
    ) -> None:
        """Serve until the task is cancelled; `started` is called with the port.

        Raises
        ------
        UserError
            Where the port cannot be listened on.
        """
        runner = web.AppRunner(self.application(), shutdown_timeout=0.5)
        await runner.setup()
        try:
            await web.TCPSite(runner, address, port, ssl_context=context).start()
            started(runner.addresses[0][1])
            await asyncio.Event().wait()
        except (OSError, OverflowError) as error:
            reason = getattr(error, "strerror", None) or error
            raise UserError(f"{address}:{port} cannot be listened on: {reason}") from None
        finally:
            await runner.cleanup()

    # Who asks, and what goes wrong

    @web.middleware
    async def _guard(self, request: web.Request, handler: Handler) -> web.StreamResponse:
        session = request.cookies.get(COOKIE)
        is_new = not self._access.has_session(session)
        header = request.headers.get("Authorization", "")
        if is_new and not self._access.allows(header, request.method, request.raw_path):
            challenge = {"WWW-Authenticate": self._access.challenge()}
            return self._failure(request, 401, "who you are is not known", challenge)
        try:
            response = await handler(request)
        except Unknown as error:
            response = self._failure(request, 404, str(error))
        except Malformed as error:
            response = self._failure(request, 400, str(error))
        except Refused as error:
            response = self._failure(request, 403, str(error))
        if is_new and not response.prepared:
            response.set_cookie(COOKIE, self._access.new_session(), httponly=True)
        return response

    def _failure(
        self, request: web.Request, code: int, message: str, headers: Mapping[str, str] | None = None
    ) -> web.Response:
        is_json = self._wants_json(request)
        kind = "application/json" if is_json else rendering.XHTML
        return web.Response(
            status=code, text=rendering.failure(code, message, is_json), content_type=kind, headers=headers
        )

    def _wants_json(self, request: web.Request) -> bool:
        return request.query.get("json") == "1" or "json" in request.headers.get("Accept", "")

    # Resources

    async def _get(self, request: web.Request) -> web.Response:
        path, _ = self._place(request.path)
        return self._answer(request, await asyncio.to_thread(self._resources.get, path, dict(request.query)))

    def _answer(self, request: web.Request, items: list[Item]) -> web.Response:
        base = f"{request.scheme}://{request.host}/"
        if self._wants_json(request):
            text = rendering.as_json(items, base, request.path.lstrip("/"), self.version)
            kind = "application/json" if self.version == 1 else rendering.JSON_2
        else:
            text = rendering.as_xhtml(items, base, request.path.lstrip("/"))
            kind = rendering.XHTML if self.version == 1 else rendering.XHTML_2
        return web.Response(body=text.encode(), headers={"Content-Type": kind})

    async def _post(self, request: web.Request) -> web.Response:
        if request.method not in ("POST", "PUT"):
            raise Unknown(f"{request.method} is not known")
        path, action = self._place(request.path)
        form = await self._form(request)
        action = request.query.get("action", "") if self.version == 1 else action
        await asyncio.to_thread(self._resources.act, path, action, form)
        return web.Response(status=204)

    async def _form(self, request: web.Request) -> dict[str, str]:
        """Return the pairs of a body, in whatever type it is said to be."""
        try:
            text = (await request.read()).decode()
        except UnicodeDecodeError:
            raise Malformed("the body is no text in UTF-8") from None
        pairs = (part.partition("=") for part in text.split("&") if part)
        return {unquote(name.replace("+", " ")): unquote(value.replace("+", " ")) for name, _, value in pairs}

    def _place(self, path: str) -> tuple[str, str]:
        """Return the path of version 1.0 that one means, and the action that it ends with in version 2.0."""
        parts = [part for part in path.split("/") if part]
        if self.version == 1:
            return "/".join(parts), ""
        if parts == ["rw", "panel", "ctrl-state"]:
            return "rw/panel/ctrlstate", "setctrlstate"
        if parts == ["rw", "panel", "speedratio"]:
            return "rw/panel/speedratio", "setspeedratio"
        if parts[:3] == ["rw", "rapid", "execution"] and len(parts) == 4:
            return "rw/rapid/execution", parts[3]
        if parts[:3] == ["rw", "rapid", "symbol"] and parts[-1] == "data":
            return "/".join(["rw/rapid/symbol/data", *parts[3:-1]]), "set"
        if parts[:3] == ["rw", "iosystem", "signals"] and parts[-1] == "set-value":
            return "/".join(parts[:-1]), "set"
        return "/".join(parts), ""

    # Subscriptions

    async def _subscribe(self, request: web.Request) -> web.Response:
        form = await self._form(request)
        named = {key: self._followed(value) if key.isdigit() else value for key, value in form.items()}
        group, items = self._subscriptions.add(named)
        scheme = "wss" if request.scheme == "https" else "ws"
        response = self._answer(request, items)
        response.set_status(201)
        response.headers["Location"] = f"{scheme}://{request.host}/poll/{group.number}"
        return response

    def _followed(self, name: str) -> str:
        path, mark, detail = name.partition(";")
        return f"/{self._place(path)[0]}{mark}{detail}"

    async def _unsubscribe(self, request: web.Request) -> web.Response:
        self._subscriptions.remove(self._number(request))
        return web.Response(status=200)

    def _number(self, request: web.Request) -> int:
        text = request.match_info["number"]
        if not text.isdecimal() or len(text) > 9:
            raise Unknown(f"there is no subscription '{text}'")
        return int(text)

    async def _poll(self, request: web.Request) -> web.StreamResponse:
        group = self._subscriptions.group(self._number(request))
        socket = web.WebSocketResponse(protocols=[_PROTOCOLS[self.version]], heartbeat=30.0, max_msg_size=MAX_BODY)
        await socket.prepare(request)
        base = f"{request.scheme}://{request.host}/"
        sending = asyncio.create_task(self._send(socket, group.number, base))
        try:
            async for message in socket:
                if message.type in (WSMsgType.CLOSE, WSMsgType.ERROR):
                    break
        finally:
            sending.cancel()
            with suppress(asyncio.CancelledError, ConnectionError):
                await sending
            with suppress(Unknown):
                self._subscriptions.remove(group.number)
        return socket

    async def _send(self, socket: web.WebSocketResponse, number: int, base: str) -> None:
        """Send what changes, as long as the group is there."""
        group = self._subscriptions.group(number)
        while not socket.closed:
            try:
                items = self._subscriptions.changes(self._subscriptions.group(number))
            except Unknown:
                await socket.close()
                return
            if items:
                await socket.send_str(rendering.event(items, base, f"subscription/{group.number}"))
            await asyncio.sleep(_LOOK_S)
