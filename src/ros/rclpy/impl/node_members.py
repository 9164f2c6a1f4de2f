"""Members of a node, such as publishers, subscriptions, services, clients and timers, and their destruction."""

from __future__ import annotations

import weakref
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from rclpy.callback_groups import CallbackGroup
from rclpy.client import Client
from rclpy.guard_condition import GuardCondition
from rclpy.publisher import Publisher
from rclpy.service import Service
from rclpy.subscription import Subscription
from rclpy.timer import Rate, Timer
from rclpy.waitable import Waitable

if TYPE_CHECKING:
    from rclpy.executors import Executor

KINDS = ("waitable", "publisher", "subscription", "client", "service", "timer", "guard", "rate")
"""Of what a node makes, in the order in which it is destroyed with the node."""


class NodeMembers:
    """The part of `Node` that lists and destroys what it consists of."""

    executor: Executor | None
    _rcl_members: dict[str, list[Any]]

    def _wake_executor(self) -> None:
        """Wake the node's executor, if there is one, so that it checks again what it waits for."""
        raise NotImplementedError

    @property
    def publishers(self) -> Iterator[Publisher]:
        """The node's publishers."""
        yield from self._rcl_members["publisher"]

    @property
    def subscriptions(self) -> Iterator[Subscription]:
        """The node's subscriptions."""
        yield from self._rcl_members["subscription"]

    @property
    def clients(self) -> Iterator[Client]:
        """The node's clients."""
        yield from self._rcl_members["client"]

    @property
    def services(self) -> Iterator[Service]:
        """The node's services."""
        yield from self._rcl_members["service"]

    @property
    def timers(self) -> Iterator[Timer]:
        """The node's timers."""
        yield from self._rcl_members["timer"]

    @property
    def guards(self) -> Iterator[GuardCondition]:
        """The node's guard conditions."""
        yield from self._rcl_members["guard"]

    @property
    def waitables(self) -> Iterator[Waitable]:
        """The node's waitables."""
        yield from self._rcl_members["waitable"]

    def _rcl_add(self, kind: str, entity: Any, group: CallbackGroup | None = None) -> Any:
        """Add an entity: it belongs to the node and is run by the node's executor."""
        if group is not None:
            group.add_entity(entity)
        entity._rcl_node = weakref.ref(self)
        self._rcl_members[kind].append(entity)
        executor = self.executor
        if executor is not None:
            attach(entity, executor)
        return entity

    def _rcl_remove(self, kind: str, entity: Any) -> bool:
        members = self._rcl_members[kind]
        if entity not in members:
            return False
        members.remove(entity)
        detach(entity)
        return True

    def add_waitable(self, waitable: Waitable) -> None:
        """Add a waitable that the node's executor waits for."""
        if not hasattr(waitable, "_rcl_hook"):
            from rclpy.impl.wait_set import adapt

            adapt(waitable)
        self._rcl_add("waitable", waitable)

    def remove_waitable(self, waitable: Waitable) -> None:
        """Remove a waitable that `add_waitable` added."""
        self._rcl_remove("waitable", waitable)
        self._wake_executor()

    def destroy_publisher(self, publisher: Publisher) -> bool:
        """Destroy a publisher; False when it is not one of the node's."""
        if publisher not in self._rcl_members["publisher"]:
            return False
        self._rcl_members["publisher"].remove(publisher)
        for handler in publisher.event_handlers:
            self._rcl_remove("waitable", handler)
        publisher.destroy()
        return True

    def destroy_subscription(self, subscription: Subscription) -> bool:
        """Destroy a subscription; False when it is not one of the node's."""
        if not self._rcl_remove("subscription", subscription):
            return False
        for handler in subscription.event_handlers:
            self._rcl_remove("waitable", handler)
        subscription.destroy()
        return True

    def destroy_client(self, client: Client) -> bool:
        """Destroy a client; False when it is not one of the node's."""
        return self._rcl_destroy_member("client", client)

    def destroy_service(self, service: Service) -> bool:
        """Destroy a service; False when it is not one of the node's."""
        return self._rcl_destroy_member("service", service)

    def destroy_timer(self, timer: Timer) -> bool:
        """Destroy a timer; False when it is not one of the node's."""
        return self._rcl_destroy_member("timer", timer)

    def destroy_guard_condition(self, guard: GuardCondition) -> bool:
        """Destroy a guard condition; False when it is not one of the node's."""
        return self._rcl_destroy_member("guard", guard)

    def destroy_rate(self, rate: Rate) -> bool:
        """Destroy a rate; False when it is not one of the node's."""
        return self._rcl_destroy_member("rate", rate)

    def _rcl_destroy_member(self, kind: str, entity: Any) -> bool:
        if not self._rcl_remove(kind, entity):
            return False
        entity.destroy()
        return True


def attach(entity: Any, executor: Executor) -> None:
    """Attach an entity to an executor."""
    entity = _ready_part(entity)
    hook = getattr(entity, "_rcl_hook", None)
    if hook is None:
        return  # publishers run nothing
    hook.attach(executor._put)
    if isinstance(entity, Timer):
        entity.handle.attach(executor._schedule)
    elif hasattr(entity, "_rcl_adapter"):
        entity._rcl_adapter.attach(executor._schedule)


def detach(entity: Any) -> None:
    """Detach an entity from its executor."""
    entity = _ready_part(entity)
    hook = getattr(entity, "_rcl_hook", None)
    if hook is None:
        return
    hook.detach()
    if isinstance(entity, Timer):
        entity.handle.attach(None)
    elif hasattr(entity, "_rcl_adapter"):
        entity._rcl_adapter.attach(None)


def _ready_part(entity: Any) -> Any:
    """Return what becomes ready in an entity: of a rate its timer, at whose ticks `spin_once` returns."""
    return entity._timer if isinstance(entity, Rate) else entity
