"""Contract of the subjects of checks and reports."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

from daidalos.transport.graph import Graph


@dataclass
class Findings:
    """Results of a check: `errors` make it fail, `warnings` only on request."""

    errors: list[str] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)


@dataclass(frozen=True)
class Report:
    """Titled list of names and values."""

    title: str
    items: tuple[tuple[str, Any], ...]

    def __str__(self) -> str:
        width = max((len(name) for name, _ in self.items), default=0) + 4
        return "\n".join((f"\n   {self.title}", *(f"{name:<{width}}: {value}" for name, value in self.items)))


class Subject:
    """Subject of checks and reports.

    Attributes
    ----------
    category
        Its name among the failed ones.
    checked
        Whether it can fail; what cannot is only reported.
    """

    category: str
    checked = True

    def check(self, graph: Graph) -> Findings:
        """Run the checks."""
        raise NotImplementedError

    def reports(self, graph: Graph) -> Iterable[Report]:
        """Return the reports."""
        raise NotImplementedError
