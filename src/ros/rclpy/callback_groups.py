"""Groups of callbacks that may or may not run concurrently."""

from __future__ import annotations

import threading
import weakref
from typing import Any


class CallbackGroup:
    """Base of callback groups."""

    def __init__(self) -> None:
        super().__init__()
        self.entities: weakref.WeakSet[Any] = weakref.WeakSet()

    def add_entity(self, entity: Any) -> None:
        """Add an entity."""
        self.entities.add(entity)

    def has_entity(self, entity: Any) -> bool:
        """Return whether an entity belongs to the group."""
        return entity in self.entities

    def can_execute(self, entity: Any) -> bool:
        """Return whether the entity's callback may begin now."""
        raise NotImplementedError

    def beginning_execution(self, entity: Any) -> bool:
        """Reserve the group for a callback; return False when it may not begin."""
        raise NotImplementedError

    def ending_execution(self, entity: Any) -> None:
        """Release the group after a callback."""
        raise NotImplementedError


class ReentrantCallbackGroup(CallbackGroup):
    """Callbacks may all run at the same time."""

    def can_execute(self, entity: Any) -> bool:
        """Return True."""
        return True

    def beginning_execution(self, entity: Any) -> bool:
        """Return True."""
        return True

    def ending_execution(self, entity: Any) -> None:
        """Release nothing: any number of callbacks may run."""


class MutuallyExclusiveCallbackGroup(CallbackGroup):
    """Callbacks run one after the other."""

    def __init__(self) -> None:
        super().__init__()
        self._active_entity: Any = None
        self._lock = threading.Lock()

    def can_execute(self, entity: Any) -> bool:
        """Return whether no callback of the group runs."""
        return self._active_entity is None

    def beginning_execution(self, entity: Any) -> bool:
        """Reserve the group for a callback; return False when another one runs."""
        with self._lock:
            if self._active_entity is None:
                self._active_entity = entity
                return True
        return False

    def ending_execution(self, entity: Any) -> None:
        """Release the group after a callback."""
        with self._lock:
            if self._active_entity is entity:
                self._active_entity = None
