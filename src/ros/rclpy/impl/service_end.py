"""Common base of a node's clients and services."""

from __future__ import annotations

from types import GenericAlias
from typing import TYPE_CHECKING, Any, ClassVar, Generic, Self, TypeVar

from rclpy.callback_groups import CallbackGroup
from rclpy.impl.entities import ClientHandle, ServiceHandle
from rclpy.impl.ready import ReadyHook
from rclpy.qos import QoSProfile

if TYPE_CHECKING:
    from rclpy.clock import Clock
    from rclpy.service_introspection import ServiceIntrospectionState


Handle = TypeVar("Handle", bound=ClientHandle | ServiceHandle)


class ServiceEnd(Generic[Handle]):
    """One end of a service, as a node has it.

    Parameters
    ----------
    handle
        The endpoint.
    srv_type
        The class of the service.
    srv_name
        Its name, as the user gave it.
    qos_profile
        Quality of service.
    callback_group
        Decides when the end may run.
    """

    __class_getitem__: ClassVar[Any] = classmethod(GenericAlias)

    def __init__(
        self, handle: Handle, srv_type: Any, srv_name: str, qos_profile: QoSProfile, callback_group: CallbackGroup
    ) -> None:
        self.__handle = handle
        self._rcl_hook = ReadyHook(self)
        self._rcl_node: Any = None
        self.srv_type = srv_type
        self.srv_name = srv_name
        self.qos_profile = qos_profile
        self.callback_group = callback_group

    @property
    def handle(self) -> Handle:
        """The endpoint behind it."""
        return self.__handle

    @property
    def service_name(self) -> str:
        """The service's full name."""
        with self.__handle:
            return self.__handle.name

    @property
    def logger_name(self) -> str:
        """The name that its node logs under."""
        return self.__handle.node.logger_name()

    def configure_introspection(
        self, clock: Clock, service_event_qos_profile: QoSProfile, introspection_state: ServiceIntrospectionState
    ) -> None:
        """Publish events of requests and responses on ``<service>/_service_event``.

        Parameters
        ----------
        clock
            Stamps the events.
        service_event_qos_profile
            Quality of service of that topic.
        introspection_state
            OFF, METADATA, or CONTENTS for the messages as well.
        """
        with self.__handle as handle:
            handle.configure_introspection(clock, self.srv_type, service_event_qos_profile, introspection_state)

    def destroy(self) -> None:
        """Destroy the handle; use `Node.destroy_client` or `Node.destroy_service` instead."""
        self.__handle.destroy_when_not_in_use()

    def _rcl_has_more(self) -> bool:
        return len(self.__handle.impl) > 0

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *exception: object) -> None:
        self.destroy()
