"""MQTT broker within this process, so that nothing has to be installed: amqtt on a thread of its own."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import threading
from typing import Any

from daidalos.common.errors import UserError

_SHUTDOWN_S = 1.0


class EmbeddedBroker:
    """Broker that runs within a ``with`` block.

    Parameters
    ----------
    host : str
        Address at which it listens.
    port : int

    Raises
    ------
    UserError
        When amqtt is not installed, or the port is in use.
    """

    def __init__(self, host: str, port: int) -> None:
        self._host, self._port = host, port
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._run, name="mqtt broker", daemon=True)
        self._is_up = threading.Event()
        self._problem = ""
        self._broker: Any = None

    def __enter__(self) -> EmbeddedBroker:
        try:
            import amqtt.broker  # noqa: F401
        except ImportError:
            raise UserError("the embedded broker needs amqtt; run: pip install 'daidalos[industry]'") from None
        self._thread.start()
        self._is_up.wait()
        if self._problem:
            self._thread.join()
            raise UserError(self._problem)
        return self

    def __exit__(self, *error: object) -> None:
        # amqtt may wait for ever for a client that connects meanwhile; its tasks are cancelled all the same.
        shutdown = asyncio.wait_for(self._broker.shutdown(), _SHUTDOWN_S)
        with contextlib.suppress(TimeoutError):
            asyncio.run_coroutine_threadsafe(shutdown, self._loop).result()
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join()

    def _run(self) -> None:
        asyncio.set_event_loop(self._loop)
        try:
            self._loop.run_until_complete(self._start())
        except Exception as error:  # whatever the library raises while it starts
            self._problem = f"the embedded broker cannot listen at {self._host}:{self._port}: {error}"
            self._is_up.set()
            return
        self._is_up.set()
        self._loop.run_forever()
        tasks = asyncio.all_tasks(self._loop)
        for task in tasks:
            task.cancel()
        if tasks:
            self._loop.run_until_complete(asyncio.wait(tasks, timeout=_SHUTDOWN_S))
        self._loop.close()

    async def _start(self) -> None:
        from amqtt.broker import Broker

        logging.getLogger("amqtt").setLevel(logging.CRITICAL)
        logging.getLogger("transitions").setLevel(logging.CRITICAL)
        configuration = {
            "listeners": {"default": {"type": "tcp", "bind": f"{self._host}:{self._port}"}},
            "plugins": {"amqtt.plugins.authentication.AnonymousAuthPlugin": {"allow_anonymous": True}},
        }
        self._broker = Broker(configuration)
        await self._broker.start()
