"""Contract of publishers of samples and receivers of commands."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from daidalos.samples.sensors import Sample


@dataclass(frozen=True)
class Subscription:
    """Class of the commands of a topic, and the callback that takes them."""

    type: type
    take: Callable[[Any], None]


class Endpoint:
    """Publisher of samples and receiver of commands."""

    @property
    def publications(self) -> Mapping[str, type[Sample]]:
        """Topics of its samples, with their classes."""
        return {}

    @property
    def subscriptions(self) -> Mapping[str, Subscription]:
        """Topics of the commands that it takes."""
        return {}
