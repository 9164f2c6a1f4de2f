"""Table of the workshop's printed figures of its loops, and of what its missing parameters can reproduce.

The workshop prints neither the cycle Te nor the cutoff w0 of its filter. `reachable` tries both over a grid that covers
RSI's cycles and all sensible filters.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daidalos.industry.servoing.loop_design import COMPENSATORS, Compensator, LoopDesign, LoopModel, step_figures
from daidalos.industry.welding.comparison import Row

CYCLES = np.linspace(0.008, 0.016, 17)
"""Tried for Te [s]; only 0.0095 to 0.0135 come near both printed phase margins, at any w0."""
CUTOFFS = np.logspace(np.log10(10.0), np.log10(200.0), 61)
"""Tried for w0 [rad/s]."""
MARGIN_TOLERANCE = 0.5
"""Difference from the printed phase margins up to which parameters count as the workshop's [deg]."""
_FREQUENCIES = np.logspace(-0.5, 2.0, 1500)


@dataclass(frozen=True)
class Printed:
    """A figure as the workshop prints it.

    Attributes
    ----------
    compensator, figure : str
        Names of the compensator and of the attribute of `LoopFigures`.
    title, unit : str
    value : float
    digits : int
        After the point.
    """

    compensator: str
    figure: str
    title: str
    value: float
    unit: str
    digits: int = 1


PRINTED = (
    Printed("proportional", "settling_time", "response time (2 %)", 0.9, "s"),
    Printed("proportional", "phase_margin", "phase margin", 65.6, "deg"),
    Printed("proportional", "gain_margin", "gain margin", 12.6, "dB"),
    Printed("proportional", "overshoot", "overshoot", 2.2, "%"),
    Printed("lead", "settling_time", "response time (2 %)", 0.5, "s"),
    Printed("lead", "phase_margin", "phase margin", 65.4, "deg"),
    Printed("lead", "gain_margin", "gain margin", 12.4, "dB"),
    Printed("lead", "overshoot", "overshoot", 2.0, "%"),
)


@dataclass(frozen=True)
class Reach:
    """What figures can be while both phase margins are the printed ones.

    Attributes
    ----------
    tried, accepted : int
        Pairs (Te, w0).
    ranges : dict
        Least and greatest value by compensator and figure.
    """

    tried: int
    accepted: int
    ranges: dict[tuple[str, str], tuple[float, float]]


def rows(designs: dict[str, LoopDesign], reach: Reach) -> list[Row]:
    """Return a row for each printed figure, with a remark where no choice of Te and w0 reproduces it."""
    out = []
    for one in PRINTED:
        ours = float(getattr(designs[one.compensator].figures, one.figure))
        low, high = reach.ranges[one.compensator, one.figure]
        half = 0.5 * 10.0**-one.digits
        possible = low - half <= one.value <= high + half
        remark = "" if possible else (
            f"{low:.2f} to {high:.2f} {one.unit} for all Te and w0 with the printed phase margins: "
            f"{one.value:g} {one.unit} can not come out"
        )  # fmt: skip
        out.append(
            Row(f"{one.compensator}: {one.title}", f"{one.value:g} {one.unit}", f"{ours:.2f} {one.unit}", remark)
        )
    return out


def reachable(model: LoopModel) -> Reach:
    """Return what the printed figures can be for all Te and w0 that give both printed phase margins."""
    wanted = {one.compensator: one.value for one in PRINTED if one.figure == "phase_margin"}
    found: dict[tuple[str, str], list[float]] = {(one.compensator, one.figure): [] for one in PRINTED}
    accepted = 0
    for cycle in CYCLES:
        for cutoff in CUTOFFS:
            tried = replace(model, cycle=float(cycle), cutoff=float(cutoff))
            margins = {name: open_loop_margins(tried, COMPENSATORS[name]) for name in wanted}
            if any(abs(margins[name][0] - value) > MARGIN_TOLERANCE for name, value in wanted.items()):
                continue
            accepted += 1
            for name, (phase, gain) in margins.items():
                overshoot, settling = _step(tried, COMPENSATORS[name])
                values = {"phase_margin": phase, "gain_margin": gain, "overshoot": overshoot, "settling_time": settling}
                for figure, value in values.items():
                    found[name, figure].append(value)
    ranges = {key: (min(values), max(values)) for key, values in found.items() if values}
    return Reach(len(CYCLES) * len(CUTOFFS), accepted, ranges)


def open_loop_margins(model: LoopModel, compensator: Compensator) -> tuple[float, float]:
    """Return the phase margin [deg] and the gain margin [dB] from samples of the frequency response."""
    response = open_loop(model, compensator, _FREQUENCIES)
    gain, phase = np.abs(response), np.unwrap(np.angle(response))
    at = int(np.argmax(gain < 1.0))
    crossing = np.interp(0.0, -np.log(gain[at - 1 : at + 1]), phase[at - 1 : at + 1])
    below = int(np.argmax(phase < -np.pi))
    at_180 = np.interp(np.pi, -phase[below - 1 : below + 1], np.log(gain[below - 1 : below + 1]))
    return 180.0 + float(np.degrees(crossing)), float(-20.0 * at_180 / np.log(10.0))


def open_loop(model: LoopModel, compensator: Compensator, frequencies: NDArray[np.float64]) -> NDArray[np.complex128]:
    """Return the open loop's response at frequencies (n,) [rad/s], from the formulas of its parts."""
    s = 1j * frequencies
    robot = 1.0 / (model.cycle * s) / _second_order(s, model.natural_frequency, model.damping)
    filtered = (1.0 + (s / model.notch) ** 2) / _second_order(s, model.cutoff, model.cutoff_damping)
    lead = compensator.gain * (1.0 + compensator.zero * s) / (1.0 + compensator.pole * s)
    out: NDArray[np.complex128] = lead * robot * filtered
    return out


def _second_order(s: Any, frequency: float, damping: float) -> Any:
    return 1.0 + 2.0 * damping * s / frequency + (s / frequency) ** 2


def _step(model: LoopModel, compensator: Compensator) -> tuple[float, float]:
    """Return the overshoot [%] and the settling time [s] of the closed loop, by polynomials and scipy."""
    from scipy.signal import step

    w, v = model.natural_frequency, model.cutoff
    forward = [compensator.gain * compensator.zero, compensator.gain]
    robot = [model.cycle / w**2, model.cycle * 2.0 * model.damping / w, model.cycle, 0.0]
    below = np.polymul(np.polymul([compensator.pole, 1.0], robot), [1.0 / v**2, 2.0 * model.cutoff_damping / v, 1.0])
    numerator = np.polymul(forward, [1.0 / v**2, 2.0 * model.cutoff_damping / v, 1.0])
    denominator = np.polyadd(below, np.polymul(forward, [1.0 / model.notch**2, 0.0, 1.0]))
    times, response = step((np.trim_zeros(numerator, "f"), np.trim_zeros(denominator, "f")), T=np.linspace(0, 3, 1501))
    return step_figures(times, response)
