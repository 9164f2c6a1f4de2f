"""Clients of services."""

from __future__ import annotations

import threading
import weakref
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from rclpy.callback_groups import CallbackGroup
from rclpy.context import Context
from rclpy.impl.entities import ClientHandle
from rclpy.impl.lazy_reexport import lazy_reexport
from rclpy.impl.running import THREAD, wait_for
from rclpy.impl.service_end import ServiceEnd
from rclpy.qos import QoSProfile
from rclpy.task import Future


class Client(ServiceEnd[ClientHandle]):
    """Client of a service; made by `Node.create_client`."""

    def __init__(
        self,
        context: Context,
        client_impl: ClientHandle,
        srv_type: Any,
        srv_name: str,
        qos_profile: QoSProfile,
        callback_group: CallbackGroup,
    ) -> None:
        super().__init__(client_impl, srv_type, srv_name, qos_profile, callback_group)
        self.context = context
        self._pending_requests: dict[int, Future] = {}
        self._lock = threading.RLock()
        self._has_own_waiter = 0
        self._has_stood_back = False
        client_impl.set_on_ready(self._on_ready)

    def call(self, request: Any, timeout_sec: float | None = None) -> Any:
        """Call the service and wait for the response.

        It needs no executor that spins. Called from a callback, other callbacks of the executor run meanwhile, as
        far as callback groups allow.

        Returns
        -------
        response or None
            None when `timeout_sec` seconds (None: no limit) pass without one.

        Raises
        ------
        TypeError
            When the request is of the wrong type.
        ROSInterruptException
            When the context is shut down meanwhile.
        """
        if not isinstance(request, self.srv_type.Request):
            raise TypeError()
        with self._lock:
            self._has_own_waiter += 1
        try:
            future = self.call_async(request)
            if not wait_for(future, self.context, (self.handle.name,), timeout_sec):
                self.remove_pending_request(future)
                return None
        finally:
            with self._lock:
                self._has_own_waiter -= 1
        return future.result()

    def get_pending_request(self, sequence_number: int) -> Future:
        """Return the future of a request.

        Raises
        ------
        KeyError
            When there is none of that number.
        """
        with self._lock:
            return self._pending_requests[sequence_number]

    def call_async(self, request: Any) -> Future:
        """Call the service; the future's result will be the response.

        Raises
        ------
        TypeError
            When the request is of the wrong type.
        """
        if not isinstance(request, self.srv_type.Request):
            raise TypeError()
        with self.handle as handle, self._lock:
            sequence_number = handle.send_request(request)
            if sequence_number in self._pending_requests:
                raise RuntimeError(f"Sequence ({sequence_number}) conflicts with pending request")
            future = Future()
            self._pending_requests[sequence_number] = future
            future.on_wake(_Forget(self, future, sequence_number))
        return future

    def remove_pending_request(self, future: Future) -> None:
        """Remove a request; its response will be dropped."""
        with self._lock:
            for number, pending in list(self._pending_requests.items()):
                if pending is future:
                    self._pending_requests.pop(number, None)
                    return

    def service_is_ready(self) -> bool:
        """Return whether somebody serves the service."""
        with self.handle as handle:
            return handle.service_server_is_available()

    def wait_for_service(self, timeout_sec: float | None = None) -> bool:
        """Wait until somebody serves the service; False when `timeout_sec` seconds pass, or at a shutdown."""
        with self.handle as handle:
            graph = handle.node.graph
            limit = None if timeout_sec is None or timeout_sec < 0 else timeout_sec
            graph.wait_for(lambda: not self.context.ok() or self.service_is_ready(), limit)
            return self.service_is_ready()

    def _on_ready(self) -> None:
        """Pass a response to the thread that waits in `call`, which may be the executor's, or make the client ready."""
        if self._has_own_waiter:
            work = self._rcl_take_unbound()
            while work is not None:
                work[0](*work[1])
                work = self._rcl_take_unbound()
        else:
            self._rcl_hook()

    def _rcl_take(self) -> tuple[Callable[..., Any], tuple[Any, ...]] | None:
        """Take a response, after the messages that became ready before it."""
        executor = THREAD.running[0]
        if not self._has_stood_back and executor is not None and not executor._ready.empty():
            self._has_stood_back = True
            self._rcl_hook()
            return None
        self._has_stood_back = False
        return self._rcl_take_unbound()

    def _rcl_take_unbound(self) -> tuple[Callable[..., Any], tuple[Any, ...]] | None:
        """Take a response; it only finishes a future, which need not wait for the callback group."""
        taken = self.handle.take_response()
        return None if taken is None else (self._finish, taken)

    def _finish(self, header: Any, response: Any) -> None:
        with self._lock:
            future = self._pending_requests.pop(header.request_id.sequence_number, None)
        if future is None:
            return
        node = self._rcl_node() if self._rcl_node else None
        future._set_executor(node.executor if node is not None else None)
        future.set_result(response)


class _Forget:
    """Callback that removes a request that was cancelled, without keeping its client alive."""

    def __init__(self, client: Client, future: Future, number: int) -> None:
        self._client = weakref.ref(client)
        self._number = number

    def __call__(self) -> None:
        client = self._client()
        if client is not None:
            with client._lock:
                client._pending_requests.pop(self._number, None)


if not TYPE_CHECKING:
    __getattr__ = lazy_reexport(
        __name__, {"rclpy.impl.type_variables": ("SrvType", "SrvTypeRequest", "SrvTypeResponse")}
    )
