"""The interface of handles."""

from types import TracebackType
from typing import Any, Protocol


class DestroyableType(Protocol):
    """Object that can be kept in use and destroyed."""

    def __enter__(self) -> Any: ...

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None: ...

    def destroy_when_not_in_use(self) -> None:
        """Destroy the object when nobody uses it any more."""
        ...
