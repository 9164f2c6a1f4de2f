"""The scenario that this process carries out."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from daidalos.testing.scenario import Scenario

_SCENARIOS: list[Scenario] = []


def set_present(scenario: Scenario) -> None:
    """Make a scenario the one that fixtures refer to."""
    _SCENARIOS[:] = [scenario]


def present() -> Scenario | None:
    """Return the scenario that this process carries out; None beside scenarios."""
    return _SCENARIOS[0] if _SCENARIOS else None
