"""Waitables: entities of one's own making that an executor waits for."""

from __future__ import annotations

from typing import Any, Self

from rclpy.callback_groups import CallbackGroup
from rclpy.task import Future


class NumberOfEntities:
    """Number of entities of each type that a waitable adds to a wait set."""

    __slots__ = (
        "num_clients",
        "num_events",
        "num_guard_conditions",
        "num_services",
        "num_subscriptions",
        "num_timers",
    )

    def __init__(
        self,
        num_subs: int = 0,
        num_gcs: int = 0,
        num_timers: int = 0,
        num_clients: int = 0,
        num_services: int = 0,
        num_events: int = 0,
    ) -> None:
        self.num_subscriptions = num_subs
        self.num_guard_conditions = num_gcs
        self.num_timers = num_timers
        self.num_clients = num_clients
        self.num_services = num_services
        self.num_events = num_events

    def __add__(self, other: NumberOfEntities) -> NumberOfEntities:
        result = NumberOfEntities()
        for name in self.__slots__:
            setattr(result, name, getattr(self, name) + getattr(other, name))
        return result

    def __iadd__(self, other: NumberOfEntities) -> Self:
        for name in self.__slots__:
            setattr(self, name, getattr(self, name) + getattr(other, name))
        return self

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, NumberOfEntities):
            return NotImplemented
        return all(getattr(self, name) == getattr(other, name) for name in self.__slots__)

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        counts = ", ".join(str(getattr(self, name)) for name in self.__slots__)
        return f"{type(self).__name__}({counts})"


class Waitable:
    """Group of entities that becomes ready when one of them does.

    An executor calls `add_to_wait_set` to learn of its entities, `is_ready` when one of them is ready, and
    then `take_data` and `execute`.
    """

    def __init__(self, callback_group: CallbackGroup) -> None:
        self.callback_group = callback_group
        self.callback_group.add_entity(self)
        self._futures: list[Future] = []
        self._rcl_node: Any = None

    def __enter__(self) -> Any:
        """Mark what is behind the waitable as in use."""
        raise NotImplementedError("Must be implemented by subclass")

    def __exit__(self, *exception: object) -> None:
        """Mark it as no longer in use."""
        raise NotImplementedError("Must be implemented by subclass")

    def add_future(self, future: Future) -> None:
        """Call a future's callbacks by the executor that runs the waitable."""
        self._futures.append(future)

    def remove_future(self, future: Future) -> None:
        """Remove a future that `add_future` added."""
        self._futures.remove(future)

    def is_ready(self, wait_set: Any) -> bool:
        """Return whether something is ready in the wait set."""
        raise NotImplementedError("Must be implemented by subclass")

    def take_data(self) -> Any:
        """Take what is ready, so that the wait set does not find it again."""
        raise NotImplementedError("Must be implemented by subclass")

    async def execute(self, taken_data: Any) -> None:
        """Process what was taken."""
        raise NotImplementedError("Must be implemented by subclass")

    def get_num_entities(self) -> NumberOfEntities:
        """Return how many entities it adds to a wait set."""
        raise NotImplementedError("Must be implemented by subclass")

    def add_to_wait_set(self, wait_set: Any) -> None:
        """Add its entities to a wait set."""
        raise NotImplementedError("Must be implemented by subclass")
