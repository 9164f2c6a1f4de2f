"""Services that the client calls."""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, ClassVar

from daidalos.transport.steady_timers import STEADY_TIMERS
from rosbridge_library.capability import Capability, Field, split_id
from rosbridge_library.internal.services import ServiceCaller

if TYPE_CHECKING:
    from rosbridge_library.protocol import Protocol


class CallService(Capability):
    """Operation ``call_service``; calls run beside each other."""

    call_service_msg_fields: tuple[Field, ...] = (
        (True, "service", str),
        (False, "fragment_size", (int, type(None))),
        (False, "compression", (str, type(None))),
        (False, "timeout", (int, float, type(None))),
    )
    services_glob: ClassVar[Sequence[str] | None] = None
    default_timeout: float = 0.0
    """Time in which a response must come, in seconds, where a call has no ``timeout``; 0 waits without end."""

    def __init__(self, protocol: Protocol) -> None:
        super().__init__(protocol)
        self.default_timeout = (protocol.parameters or {}).get("default_call_service_timeout", self.default_timeout)
        self._calls: set[ServiceCaller] = set()
        protocol.register_operation("call_service", self.call_service)

    def call_service(self, message: dict[str, Any]) -> None:
        """Call a service; the client gets ``service_response``, with ``result`` false where the call failed."""
        self.basic_type_check(message, self.call_service_msg_fields)
        asked = message["service"]
        service, number = split_id(asked, message.get("id"))
        try:
            self.check_name(self.services_glob, service)
            self.check_room(len(self._calls), "calls are under way")
        except Exception as error:
            self._fail(asked, number, error)
            return

        def succeeded(values: dict[str, Any]) -> None:
            self._calls.discard(call)
            self._respond(asked, number, values, True)

        def failed(error: Exception) -> None:
            self._calls.discard(call)
            self._fail(asked, number, error)

        call = ServiceCaller(service, message.get("args", []), succeeded, failed, self.protocol.node_handle)
        self._calls.add(call)
        call.start()
        timeout_s = message.get("timeout") or self.default_timeout
        if timeout_s > 0:
            late = TimeoutError(f"Timeout exceeded while waiting for service response: {timeout_s:g} s")
            STEADY_TIMERS.at(time.monotonic_ns() + int(min(timeout_s, 1e6) * 1e9), lambda: call.give_up(late))

    def _fail(self, service: str, number: Any, error: Exception) -> None:
        self.protocol.log("error", f"call_service {type(error).__name__}: {error}", number)
        self._respond(service, number, str(error), False)

    def _respond(self, service: str, number: Any, values: Any, result: bool) -> None:
        response = {"op": "service_response", "service": service, "values": values, "result": result}
        self.protocol.send(response if number is None else {**response, "id": number})

    def finish(self) -> None:
        """Wait for no more responses."""
        self._calls.clear()
        self.protocol.unregister_operation("call_service")
