"""Letting messages pass that bring something new."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable
from functools import partial, reduce
from typing import Any

from .simple_filter import SimpleFilter

_BASIC_TYPES = (bool, int, float, str)


class ComparisonHandler(ABC):
    """Handler that decides which messages a `ComparisonFilter` lets pass."""

    @abstractmethod
    def message_fits(self, message: Any) -> bool:
        """Return whether a message may pass."""


class CachedComparisonHandler(ComparisonHandler):
    """Base of those who compare a message with the last one that passed; the first one passes.

    Parameters
    ----------
    field_getters
        Functions that return a value of a message; one of them that fits suffices.
    """

    def __init__(self, field_getters: Iterable[Callable[[Any], Any]] = ()) -> None:
        self._field_getters = list(field_getters)
        self._message_cache: Any = None

    def message_fits(self, message: Any) -> bool:
        """Return whether a message may pass, and remember it if so."""
        last = self._message_cache
        if last is not None and not any(self.do_fields_fit(get(last), get(message)) for get in self._field_getters):
            return False
        self._message_cache = message
        return True

    def do_fields_fit(self, field_a: Any, field_b: Any) -> bool:
        """Return whether a message may pass for the sake of a value, of the last message and of this one."""
        raise NotImplementedError(f"{type(self).__name__} does not implement do_fields_fit")


class DeltaCompare(CachedComparisonHandler):
    """Comparison that passes a message when a value has changed."""

    def do_fields_fit(self, field_a: Any, field_b: Any) -> bool:
        """Return whether two values differ.

        Raises
        ------
        TypeError
            When they are no bool, int, float or str.
        """
        if not isinstance(field_a, _BASIC_TYPES) or not isinstance(field_b, _BASIC_TYPES):
            raise TypeError(f"Unable to compare fields of types {type(field_a)} and {type(field_b)}")
        return bool(field_a != field_b)


class ComparisonFilter(SimpleFilter):
    """Filter that passes the messages that fit.

    Parameters
    ----------
    comparison_handler
        Who decides that.
    message_filter
        The filter to listen to.
    """

    def __init__(self, comparison_handler: ComparisonHandler, message_filter: SimpleFilter | None = None) -> None:
        super().__init__()
        self._comparison_handler = comparison_handler
        self.incoming_connection: int | None = None
        if message_filter is not None:
            self.connectInput(message_filter)

    def connectInput(self, message_filter: SimpleFilter) -> None:
        """Listen to a filter.

        Raises
        ------
        RuntimeError
            When it listens to one already.
        """
        if self.incoming_connection is not None:
            raise RuntimeError(f"This instance of {type(self).__name__} already has an incoming connection")
        self.incoming_connection = message_filter.registerCallback(self.add)

    def add(self, message: Any) -> None:
        """Process a message."""
        if self.message_fits(message):
            self.signalMessage(message)

    def message_fits(self, message: Any) -> bool:
        """Return whether a message may pass."""
        return self._comparison_handler.message_fits(message)


class DeltaFilter(ComparisonFilter):
    """Filter that passes the messages in which a value has changed since the last one that passed.

    Parameters
    ----------
    field_getters
        Functions that return the values of a message.
    message_filter
        The filter to listen to.
    """

    def __init__(
        self, field_getters: Iterable[Callable[[Any], Any]], message_filter: SimpleFilter | None = None
    ) -> None:
        super().__init__(DeltaCompare(field_getters), message_filter)


class PathDeltaFilter(DeltaFilter):
    """Filter that passes the messages in which a field has changed since the last one that passed.

    Parameters
    ----------
    field_path_list
        Fields such as ``pose.position.x``.
    message_filter
        The filter to listen to.
    """

    def __init__(self, field_path_list: Iterable[str], message_filter: SimpleFilter | None = None) -> None:
        getters = [partial(self.get_field_by_path, field_path=path) for path in field_path_list]
        super().__init__(getters, message_filter)

    def get_field_by_path(self, message: Any, field_path: str) -> Any:
        """Return a field of a message.

        Raises
        ------
        RuntimeError
            When there is none of that name.
        """

        def field_of(value: Any, name: str) -> Any:
            found = getattr(value, name, None)
            if found is None:
                kind = type(value).__name__
                raise RuntimeError(f"Unable to access field {name!r} of {kind} (full path: {field_path!r})")
            return found

        return reduce(field_of, field_path.split("."), message)
