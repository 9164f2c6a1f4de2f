"""Ages of the latest observations of a layer's sensors."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol

import numpy as np


class Source(Protocol):
    """Parameters of a sensor."""

    @property
    def topic(self) -> str:
        """Topic; empty for the source's name."""
        ...

    @property
    def expected_update_rate(self) -> float:
        """Largest age [s]; 0 for any."""
        ...


def missing_observation(latest: Mapping[str, float], sources: Mapping[str, Source], now: float) -> str:
    """Return which sensor has observed nothing for its `expected_update_rate`; empty where there is none."""
    for name, source in sources.items():
        limit = source.expected_update_rate
        if limit <= 0.0:
            continue
        if name not in latest:
            return f"there is no observation of '{source.topic or name}'"
        age = now - latest[name]
        if not -limit <= age <= limit:  # from the future where time was set back
            return (
                f"the latest observation of '{source.topic or name}' is {age:.3g} s old, "
                f"longer than expected_update_rate {limit:g} s"
            )
    return ""


def age_of_observations(latest: Mapping[str, float], sources: Mapping[str, Source], now: float) -> float:
    """Return the age of the oldest of the latest observations, as a share of what is allowed."""
    ages = (
        (now - latest.get(name, -np.inf)) / source.expected_update_rate
        for name, source in sources.items()
        if source.expected_update_rate > 0.0
    )
    return max(ages, default=0.0)
