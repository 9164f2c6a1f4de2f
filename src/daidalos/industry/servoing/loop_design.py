"""Design of the servo loop in the frequency domain: margins, step responses, Bode and Nyquist curves.

The plant is the robot, which adds each correction to those before (1 / Te s) and follows their sum as a system of
second order; the measurement passes a low-pass filter with a notch at the spindle's frequency.
"""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from daidalos.common.errors import UserError
from daidalos.common.suggestions import hint

if TYPE_CHECKING:
    from control import TransferFunction

FREQUENCIES = np.logspace(-1.0, 3.0, 2000)
"""Of the Bode and Nyquist curves [rad/s]."""
STEP_TIME = 3.0
STEP_PERIOD = 5e-4
SETTLING_BAND = 0.02
"""Deviation from the final value at which a step response counts as settled."""


@dataclass(frozen=True)
class LoopModel:
    """Parameters of the plant and of the filter in the feedback.

    Attributes
    ----------
    cycle : float
        Time between two corrections, Te [s].
    natural_frequency, damping : float
        Of the robot [rad/s, 1].
    cutoff, cutoff_damping : float
        Of the low-pass filter [rad/s, 1].
    notch : float
        Frequency that the filter removes, that of the spindle [rad/s].
    """

    cycle: float = 0.012
    natural_frequency: float = 10.0
    damping: float = 0.7
    cutoff: float = 22.6
    cutoff_damping: float = 0.7
    notch: float = 2.0 * math.pi * 800.0 / 60.0


@dataclass(frozen=True)
class Compensator:
    """Gain (1 + zero s) / (1 + pole s), from the measured deviation to the correction of a cycle.

    Attributes
    ----------
    name : str
    gain : float
    zero, pole : float
        Time constants [s].
    """

    name: str
    gain: float
    zero: float = 0.0
    pole: float = 0.0


COMPENSATORS = {
    "proportional": Compensator("proportional", 0.025),
    "lead": Compensator("lead", 0.036, 0.0702, 0.0032),
}
"""Those of the workshop."""


@dataclass(frozen=True)
class LoopFigures:
    """Figures of a closed loop.

    Attributes
    ----------
    phase_margin, gain_margin : float
        [deg], [dB]
    crossover, phase_crossover : float
        Frequencies at which the loop's gain is 1, and its phase -180 deg [rad/s].
    overshoot : float
        Of the step response [%].
    settling_time : float
        After which the step response stays within 2 % of its final value [s].
    """

    phase_margin: float
    gain_margin: float
    crossover: float
    phase_crossover: float
    overshoot: float
    settling_time: float


@dataclass(frozen=True)
class LoopDesign:
    """A designed loop: what it is made of, its figures and its curves.

    Attributes
    ----------
    model, compensator, figures : LoopModel, Compensator, LoopFigures
    response : array of shape (len(FREQUENCIES),)
        Of the open loop, complex.
    times, step : arrays of shape (n,)
        Step response of the closed loop [s, 1].
    """

    model: LoopModel
    compensator: Compensator
    figures: LoopFigures
    response: NDArray[np.complex128]
    times: NDArray[np.float64]
    step: NDArray[np.float64]

    def as_json(self) -> dict[str, Any]:
        """Return the parameters and figures."""
        return {
            "compensator": asdict(self.compensator),
            "model": asdict(self.model),
            "figures": {name: round(value, 5) for name, value in asdict(self.figures).items()},
        }


def compensator_named(name: str) -> Compensator:
    """Return a compensator of the workshop.

    Raises
    ------
    UserError
        Where there is none of that name.
    """
    if name not in COMPENSATORS:
        raise UserError(f"there is no compensator '{name}'{hint(name, COMPENSATORS)}")
    return COMPENSATORS[name]


def plant(model: LoopModel) -> TransferFunction:
    """Return the robot's transfer function from corrections to positions."""
    control = control_library()
    w = model.natural_frequency
    return control.tf([1.0], [model.cycle / w**2, model.cycle * 2.0 * model.damping / w, model.cycle, 0.0])


def feedback_filter(model: LoopModel) -> TransferFunction:
    """Return the transfer function of the low-pass filter with its notch."""
    w = model.cutoff
    return control_library().tf([1.0 / model.notch**2, 0.0, 1.0], [1.0 / w**2, 2.0 * model.cutoff_damping / w, 1.0])


def transfer_function(compensator: Compensator) -> TransferFunction:
    """Return a compensator's transfer function."""
    numerator = [compensator.gain * compensator.zero, compensator.gain]
    return control_library().tf(numerator, [compensator.pole, 1.0] if compensator.pole else [1.0])


def design(model: LoopModel, compensator: Compensator) -> LoopDesign:
    """Compute the figures and the curves of a loop.

    Raises
    ------
    UserError
        Where the closed loop is not stable.
    """
    control = control_library()
    forward, backward = transfer_function(compensator) * plant(model), feedback_filter(model)
    loop, closed = forward * backward, control.feedback(forward, backward)
    fastest = max(closed.poles().real)
    if fastest >= 0.0:
        raise UserError(f"{compensator.name}: the closed loop is not stable, it has a pole at {fastest:+.4g} rad/s")
    gain_margin, phase_margin, phase_crossover, crossover = control.margin(loop)
    times = np.arange(0.0, STEP_TIME, STEP_PERIOD)
    step = np.asarray(control.step_response(closed, times).outputs, dtype=np.float64)
    overshoot, settling = step_figures(times, step)
    figures = LoopFigures(
        float(phase_margin),
        20.0 * math.log10(gain_margin),
        float(crossover),
        float(phase_crossover),
        overshoot,
        settling,
    )
    response = np.asarray(loop(1j * FREQUENCIES), dtype=np.complex128)
    return LoopDesign(model, compensator, figures, response, times, step)


def step_figures(times: NDArray[np.float64], step: NDArray[np.float64]) -> tuple[float, float]:
    """Return the overshoot [%] and the settling time [s] of a step response that ends at 1."""
    outside = np.flatnonzero(np.abs(step - 1.0) > SETTLING_BAND)
    settling = float(times[min(int(outside[-1]) + 1, len(times) - 1)]) if len(outside) else 0.0
    return 100.0 * max(float(step.max()) - 1.0, 0.0), settling


def control_library() -> Any:
    """Return python-control.

    Raises
    ------
    UserError
        Where it is not installed.
    """
    try:
        import control
    except ImportError:
        raise UserError("python-control is missing: pip install 'daidalos[industry]'") from None
    return control
