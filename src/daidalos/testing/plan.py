"""Plans of fleets: which seed and which parameters each run has."""

from __future__ import annotations

import hashlib
import random
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from daidalos.common.documents import parse_yaml
from daidalos.common.errors import UserError


@dataclass(frozen=True)
class Variation:
    """Values that a parameter takes.

    Parameters
    ----------
    name : str
    values : tuple
        One of which is drawn; empty for a range.
    low, high : float
        Range from which it is drawn evenly.
    is_whole : bool
        Whether only whole numbers of the range are.
    """

    name: str
    values: tuple[Any, ...] = ()
    low: float = 0.0
    high: float = 0.0
    is_whole: bool = False

    @classmethod
    def parse(cls, text: str) -> Variation:
        """Return the variation of ``NAME=LOW..HIGH`` or ``NAME=A,B,C``.

        Raises
        ------
        UserError
        """
        name, separator, given = text.partition("=")
        if not separator or not name or not given:
            raise UserError(f"expected NAME=LOW..HIGH or NAME=A,B,C, got '{text}'")
        if ".." in given:
            ends = [parse_yaml(end) for end in given.split("..", 1)]
            if not all(isinstance(end, int | float) and not isinstance(end, bool) for end in ends) or ends[0] > ends[1]:
                raise UserError(f"expected a range of two rising numbers such as {name}=0.2..1.0, got '{text}'")
            is_whole = all(isinstance(end, int) for end in ends)
            return cls(name, (), float(ends[0]), float(ends[1]), is_whole)
        return cls(name, tuple(parse_yaml(value) for value in given.split(",")))

    def draw(self, stream: random.Random) -> Any:
        """Return a value."""
        if self.values:
            return stream.choice(self.values)
        if self.is_whole:
            return stream.randint(int(self.low), int(self.high))
        return round(stream.uniform(self.low, self.high), 9)

    def __str__(self) -> str:
        if self.values:
            return f"{self.name}={','.join(map(str, self.values))}"
        return f"{self.name}={self.low:g}..{self.high:g}"


@dataclass(frozen=True)
class Run:
    """Run of a plan: its number, seed and parameters."""

    number: int
    seed: int
    parameters: Mapping[str, Any]


@dataclass(frozen=True)
class Plan:
    """Plan of a fleet.

    Parameters
    ----------
    scenario : Path
    count : int
        Number of runs.
    seed : int
        Of the first run; each one after it has the next.
    variations : tuple of Variation
    """

    scenario: Path
    count: int
    seed: int = 0
    variations: tuple[Variation, ...] = ()

    def runs(self) -> Sequence[Run]:
        """Return all runs. A run depends on its seed alone, not on how many there are."""
        return [self._run(number) for number in range(self.count)]

    def _run(self, number: int) -> Run:
        seed = self.seed + number
        drawn = {}
        for variation in self.variations:
            stream = random.Random(f"{seed} {variation.name}")
            drawn[variation.name] = variation.draw(stream)
        return Run(number, seed, drawn)

    def identity(self) -> dict[str, Any]:
        """Return what makes results belong to this plan, as plain data; more runs may be added to it."""
        digest = hashlib.sha256(self.scenario.read_bytes()).hexdigest()
        return {
            "scenario": self.scenario.name,
            "sha256": digest,
            "seed": self.seed,
            "vary": [str(variation) for variation in self.variations],
        }
