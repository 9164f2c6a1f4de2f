"""Selection of topics by name, regular expression or type."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

from daidalos.bags.message import SERVICE_EVENTS, is_service_event


@dataclass(frozen=True)
class Selection:
    """Selection of topics and services.

    Attributes
    ----------
    topics, services, types
        Wanted topics, services (their events) and types of topics, by their full names.
    all_topics, all_services
        Whether all are wanted; that outweighs names and the regular expression.
    regex
        Topics and services are wanted in whose name it is found.
    exclude_topics, exclude_services, exclude_types, exclude_regex
        What is not wanted in any case.
    hidden
        Whether all topics means hidden ones as well.
    """

    topics: tuple[str, ...] = ()
    services: tuple[str, ...] = ()
    types: tuple[str, ...] = ()
    all_topics: bool = False
    all_services: bool = False
    regex: str = ""
    exclude_topics: tuple[str, ...] = ()
    exclude_services: tuple[str, ...] = ()
    exclude_types: tuple[str, ...] = ()
    exclude_regex: str = ""
    hidden: bool = False

    def check(self) -> None:
        """Raise ValueError, with the position, for invalid regular expressions."""
        for text in (self.regex, self.exclude_regex):
            compiled(text)

    @property
    def is_empty(self) -> bool:
        """Whether nothing is selected explicitly."""
        asked = (self.topics, self.services, self.types, self.all_topics, self.all_services, self.regex)
        return not any(asked)

    @property
    def names(self) -> tuple[str, ...] | None:
        """Names of the selected topics if they are known beforehand, else None."""
        if self.all_topics or self.all_services or self.regex or self.types:
            return None
        return (*self.topics, *(f"{name}{SERVICE_EVENTS}" for name in self.services))

    def wants(self, name: str, type_name: str) -> bool:
        """Return whether a topic is selected; a topic of service events counts as its service."""
        if is_service_event(name, type_name):
            return self._wants_service(name.removesuffix(SERVICE_EVENTS))
        if name in self.exclude_topics or type_name in self.exclude_types or self._excluded(name):
            return False
        if name in self.topics:
            return True
        if not self.hidden and any(token.startswith("_") for token in name.split("/")):
            return False
        if self.all_topics or type_name in self.types:
            return True
        return self._matches(name) and not self.all_services

    def _wants_service(self, name: str) -> bool:
        if name in self.exclude_services or self._excluded(name):
            return False
        if self.all_services or name in self.services or f"{name}{SERVICE_EVENTS}" in self.topics:
            return True
        return self._matches(name) and not self.all_topics

    def _matches(self, name: str) -> bool:
        return self._regex is not None and self._regex.search(name) is not None

    def _excluded(self, name: str) -> bool:
        return self._exclude_regex is not None and self._exclude_regex.search(name) is not None

    @cached_property
    def _regex(self) -> re.Pattern[str] | None:
        return compiled(self.regex)

    @cached_property
    def _exclude_regex(self) -> re.Pattern[str] | None:
        return compiled(self.exclude_regex)


def compiled(text: str) -> re.Pattern[str] | None:
    """Return a compiled regular expression, None for an empty text.

    Raises
    ------
    ValueError
        When it is none; the position is named.
    """
    try:
        return re.compile(text) if text else None
    except re.error as error:
        raise ValueError(f"invalid regular expression '{text}': {error}") from None


def absolute(names: Iterable[str] | None) -> tuple[str, ...]:
    """Return names with a leading slash."""
    return tuple(name if name.startswith("/") else f"/{name}" for name in names or ())
