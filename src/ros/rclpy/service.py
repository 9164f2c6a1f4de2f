"""Services."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from rclpy.callback_groups import CallbackGroup
from rclpy.impl.entities import ServiceHandle
from rclpy.impl.lazy_reexport import lazy_reexport
from rclpy.impl.service_end import ServiceEnd
from rclpy.qos import QoSProfile


class Unanswered(Exception):
    """Error of a callback that leaves a request without an answer, as its caller would not get a true one."""


class Service(ServiceEnd[ServiceHandle]):
    """Server of a service; made by `Node.create_service`."""

    concurrent = False
    """Whether callbacks may overlap, in nodes for asyncio."""

    def __init__(
        self,
        service_impl: ServiceHandle,
        srv_type: Any,
        srv_name: str,
        callback: Callable[[Any, Any], Any],
        callback_group: CallbackGroup,
        qos_profile: QoSProfile,
    ) -> None:
        super().__init__(service_impl, srv_type, srv_name, qos_profile, callback_group)
        self.callback = callback
        self._rcl_serves = frozenset((service_impl.name,))
        service_impl.set_on_ready(self._rcl_hook)

    def send_response(self, response: Any, header: Any) -> None:
        """Send the response to the request with that header.

        Raises
        ------
        TypeError
            When the response is of the wrong type.
        """
        if not isinstance(response, self.srv_type.Response):
            raise TypeError(
                f"The callback of service '{self.srv_name}' returned {type(response)}, "
                f"expected {self.srv_type.Response}"
            )
        with self.handle as handle:
            handle.send_response(response, header)

    def _rcl_take(self) -> tuple[Callable[..., Any], tuple[Any, ...]] | None:
        taken = self.handle.take_request()
        return None if taken is None else (self._answer, taken)

    def _answer(self, request: Any, header: Any) -> Any:
        response = self.callback(request, self.srv_type.Response())
        if hasattr(response, "__await__"):
            return self._answer_later(response, header)
        self.send_response(response, header)
        return None

    async def _answer_later(self, awaitable: Any, header: Any) -> None:
        with contextlib.suppress(Unanswered):
            self.send_response(await awaitable, header)


if not TYPE_CHECKING:
    __getattr__ = lazy_reexport(
        __name__, {"rclpy.impl.type_variables": ("SrvType", "SrvTypeRequest", "SrvTypeResponse")}
    )
