"""Compensators of the workshop on the deviation that single profiles show, behind the low-pass filter with a notch."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from daidalos.industry.servoing.contracts import LoopSetup, Observation, SeamController
from daidalos.industry.servoing.loop_design import COMPENSATORS, Compensator


class DigitalFilter:
    """Transfer function in s at a sampling period, by the bilinear transformation s = 2/T (z - 1)/(z + 1).

    Parameters
    ----------
    numerator, denominator : list of float
        Coefficients, of the highest power first.
    period : float
        T [s].
    """

    def __init__(self, numerator: list[float], denominator: list[float], period: float) -> None:
        order = max(len(np.trim_zeros(one, "f")) for one in (numerator, denominator)) - 1
        above, below = (_transformed(one, order, period) for one in (numerator, denominator))
        self._b: NDArray[np.float64] = above / below[0]
        self._a: NDArray[np.float64] = below / below[0]
        self._state: NDArray[np.float64] | None = None

    def step(self, value: float) -> float:
        """Return the output for the next input; the first input counts as having lasted for ever."""
        if self._state is None:
            settled = float(self._b.sum() / self._a.sum()) * value
            self._state = np.cumsum((self._b * value - self._a * settled)[::-1])[-2::-1]
        out = float(self._b[0] * value) + (float(self._state[0]) if len(self._state) else 0.0)
        self._state = np.append(self._state[1:], 0.0)[: len(self._state)] + self._b[1:] * value - self._a[1:] * out
        return out


def _transformed(polynomial: list[float], order: int, period: float) -> NDArray[np.float64]:
    """Return a polynomial in s, times ((z + 1) T/2)^order, as one in z of that order."""
    out = np.zeros(order + 1)
    for power, coefficient in enumerate(polynomial[::-1][: order + 1]):
        term = np.ones(1) * coefficient * (2.0 / period) ** power
        for factor in [[1.0, -1.0]] * power + [[1.0, 1.0]] * (order - power):
            term = np.convolve(term, factor)
        out += term
    return out


class CompensatorController(SeamController):
    """Filter and compensator on the deviation at the tool.

    Parameters
    ----------
    setup : LoopSetup
    compensator : Compensator
    """

    def __init__(self, setup: LoopSetup, compensator: Compensator) -> None:
        super().__init__(setup)
        self._compensator = compensator
        self.hold()

    def step(self, observation: Observation) -> float:
        """Return the compensator's output; see `SeamController.step`."""
        ahead = observation.s + self.setup.speed * self.setup.lead
        deviation = observation.raw(ahead) - observation.lateral
        return self._compensate.step(self._filter.step(deviation))

    def hold(self) -> None:
        """Forget the states of filter and compensator."""
        model, given = self.setup.model, self._compensator
        w, cycle = model.cutoff, model.cycle
        # The bilinear transformation moves the notch; this moves it back.
        notch = 2.0 / cycle * math.tan(0.5 * model.notch * cycle)
        self._filter = DigitalFilter(
            [1.0 / notch**2, 0.0, 1.0], [1.0 / w**2, 2.0 * model.cutoff_damping / w, 1.0], cycle
        )
        self._compensate = DigitalFilter([given.gain * given.zero, given.gain], [given.pole, 1.0], cycle)


class ProportionalController(CompensatorController):
    """The workshop's proportional compensator."""

    names = ("proportional",)

    def __init__(self, setup: LoopSetup) -> None:
        super().__init__(setup, COMPENSATORS["proportional"])


class LeadController(CompensatorController):
    """The workshop's lead compensator."""

    names = ("lead",)

    def __init__(self, setup: LoopSetup) -> None:
        super().__init__(setup, COMPENSATORS["lead"])
