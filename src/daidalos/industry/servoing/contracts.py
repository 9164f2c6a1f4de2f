"""Contract of seam controllers: from what is known of seam and tool to the correction of a cycle."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from daidalos.industry.servoing.loop_design import LoopModel


@dataclass(frozen=True)
class LoopSetup:
    """What a controller is made for.

    Attributes
    ----------
    model : LoopModel
        Plant and filter.
    speed : float
        Along the path [m/s].
    max_step : float
        Greatest correction of a cycle [m].
    max_correction : float
        Greatest sum of the corrections in each direction [m].
    lead : float
        Time by which the controllers of the workshop look ahead [s].
    """

    model: LoopModel = field(default_factory=LoopModel)
    speed: float = 5e-3
    max_step: float = 0.06e-3
    max_correction: float = 5e-3
    lead: float = 0.23


@dataclass(frozen=True)
class Observation:
    """State of a cycle, in the axes of the path.

    Attributes
    ----------
    s, lateral : float
        Place of the tool along the path and to its left, as the robot reports it [m].
    commanded : float
        Sum of the corrections so far [m].
    raw : callable
        From a length to the middle of the edges as one profile shows it [m].
    seam : callable
        From lengths (n,) to the seam by a robust fit through many profiles (n,) [m].
    """

    s: float
    lateral: float
    commanded: float
    raw: Callable[[float], float]
    seam: Callable[[NDArray[np.float64]], NDArray[np.float64]]


class SeamController(ABC):
    """Controller of the tool's place across the seam.

    A subclass keeps the state of its own; one instance follows one seam. The class attribute `names` holds what
    `--controller` calls it.

    Parameters
    ----------
    setup : LoopSetup
    """

    names: ClassVar[tuple[str, ...]] = ()

    def __init__(self, setup: LoopSetup) -> None:
        self.setup = setup

    @abstractmethod
    def step(self, observation: Observation) -> float:
        """Return the correction of this cycle, to the left [m]; the caller limits it."""

    def hold(self) -> None:  # noqa: B027 (many controllers have no state)
        """Forget what a state would do after a time without the seam; called while the correction is held."""
