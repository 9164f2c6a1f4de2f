"""The contract of what publishes samples and takes commands on topics."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from daidalos.samples.sensors import Sample


@dataclass(frozen=True)
class Subscription:
    """Class of the commands of a topic, and what takes them."""

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
