"""Handles: what stays of an entity while somebody still uses it."""

from __future__ import annotations

import threading
from typing import Self

from rclpy.impl.errors import InvalidHandle


class Destroyable:
    """Base of handles.

    ``with handle:`` keeps what is behind it alive; `destroy_when_not_in_use` takes effect when the last such
    block ends, and from then on entering raises `InvalidHandle`.
    """

    def __init__(self) -> None:
        self._uses = 0
        self._please_destroy = False
        self._use_lock = threading.Lock()

    def __enter__(self) -> Self:
        with self._use_lock:
            if self._please_destroy:
                raise InvalidHandle("cannot use Destroyable because destruction was requested")
            self._uses += 1
        return self

    def __exit__(self, *exception: object) -> None:
        with self._use_lock:
            self._uses -= 1
            gone = self._please_destroy and self._uses == 0
        if gone:
            self._destroy()

    def destroy_when_not_in_use(self) -> None:
        """Destroy now, or when the last user is done. Further calls do nothing."""
        with self._use_lock:
            if self._please_destroy:
                return
            self._please_destroy = True
            gone = self._uses == 0
        if gone:
            self._destroy()

    @property
    def pointer(self) -> int:
        """A number that identifies the handle."""
        return id(self)

    @property
    def is_destroyed(self) -> bool:
        """Whether destruction was asked for."""
        return self._please_destroy

    def _destroy(self) -> None:
        """Release what is behind the handle."""
