"""Services."""

from __future__ import annotations

from collections.abc import Callable
from types import GenericAlias, TracebackType
from typing import TYPE_CHECKING, Any, Self

from rclpy.callback_groups import CallbackGroup
from rclpy.impl.entities import ServiceHandle
from rclpy.impl.ready import ReadyHook
from rclpy.qos import QoSProfile

if TYPE_CHECKING:
    from rclpy.clock import Clock
    from rclpy.service_introspection import ServiceIntrospectionState


class Service:
    """Answers requests; made by `Node.create_service`."""

    concurrent = False
    """Whether callbacks may overlap, in nodes for asyncio."""

    __class_getitem__ = classmethod(GenericAlias)

    def __init__(
        self,
        service_impl: ServiceHandle,
        srv_type: Any,
        srv_name: str,
        callback: Callable[[Any, Any], Any],
        callback_group: CallbackGroup,
        qos_profile: QoSProfile,
    ) -> None:
        self.__service = service_impl
        self._rcl_hook = ReadyHook(self)
        self._rcl_node: Any = None
        self.srv_type = srv_type
        self.srv_name = srv_name
        self.callback = callback
        self.callback_group = callback_group
        self._executor_event = False
        self.qos_profile = qos_profile
        self._rcl_serves = frozenset((service_impl.name,))
        service_impl.set_on_ready(self._rcl_hook)

    def send_response(self, response: Any, header: Any) -> None:
        """Answer the request with that header.

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
        with self.handle:
            self.__service.send_response(response, header)

    @property
    def handle(self) -> ServiceHandle:
        """What is behind the service."""
        return self.__service

    @property
    def service_name(self) -> str:
        """The service's full name."""
        with self.handle:
            return self.__service.name

    @property
    def logger_name(self) -> str:
        """The name that the service's node logs under."""
        return self.__service.node.logger_name()

    def configure_introspection(
        self, clock: Clock, service_event_qos_profile: QoSProfile, introspection_state: ServiceIntrospectionState
    ) -> None:
        """Tell of requests and responses on ``<service>/_service_event``.

        Parameters
        ----------
        clock
            Stamps the events.
        service_event_qos_profile
            Quality of service of that topic.
        introspection_state
            OFF, METADATA, or CONTENTS for the messages as well.
        """
        with self.handle as handle:
            handle.configure_introspection(clock, self.srv_type, service_event_qos_profile, introspection_state)

    def destroy(self) -> None:
        """Let go; use `Node.destroy_service` instead."""
        self.__service.destroy_when_not_in_use()

    def _rcl_take(self) -> tuple[Callable[..., Any], tuple[Any, ...]] | None:
        taken = self.__service.take_request()
        return None if taken is None else (self._answer, taken)

    def _answer(self, request: Any, header: Any) -> Any:
        response = self.callback(request, self.srv_type.Response())
        if hasattr(response, "__await__"):
            return self._answer_later(response, header)
        self.send_response(response, header)
        return None

    async def _answer_later(self, awaitable: Any, header: Any) -> None:
        self.send_response(await awaitable, header)

    def _rcl_has_more(self) -> bool:
        return len(self.__service.impl) > 0

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.destroy()
