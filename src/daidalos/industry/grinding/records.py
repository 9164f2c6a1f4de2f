"""Records of grinding over time, with their figures, files and comparison."""

from __future__ import annotations

import io
import itertools
import math
import zipfile
from collections.abc import Iterable
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daidalos.common.errors import UserError
from daidalos.industry.grinding.grinding import STEADY_TIME, Grinding, Phase, Sample

SMOOTHING = 0.02
"""Length of the moving mean in which forces are judged; what is faster is vibration [s]."""
_NUMBERS = tuple(field.name for field in fields(Sample) if field.name != "phase")
_PHASES = tuple(Phase)


@dataclass(frozen=True)
class Record:
    """What was measured at each period, arrays of shape (n,), as in `Sample`; `phase` is the number of the phase."""

    time: NDArray[np.float64]
    phase: NDArray[np.int64]
    wanted: NDArray[np.float64]
    force: NDArray[np.float64]
    measured: NDArray[np.float64]
    piston: NDArray[np.float64]
    offset: NDArray[np.float64]
    pressure: NDArray[np.float64]
    speed: NDArray[np.float64]
    torque: NDArray[np.float64]
    wear: NDArray[np.float64]
    x: NDArray[np.float64]
    y: NDArray[np.float64]

    @property
    def is_grinding(self) -> NDArray[np.bool_]:
        """Return at which times the force was controlled (n,)."""
        grinding: NDArray[np.bool_] = self.phase == _PHASES.index(Phase.GRIND)
        return grinding

    @property
    def smooth_force(self) -> NDArray[np.float64]:
        """Return the moving mean of the force on the workpiece over `SMOOTHING` (n,) [N]."""
        if len(self.time) < 2:
            return self.force
        count = max(round(SMOOTHING / float(np.median(np.diff(self.time)))), 1)
        return np.convolve(self.force, np.ones(count) / count, mode="same")

    def thinned(self, count: int = 20_000) -> Record:
        """Return every n-th sample, at most so many."""
        every = -(-len(self.time) // count) or 1
        return Record(**{field.name: getattr(self, field.name)[::every] for field in fields(self)})


@dataclass(frozen=True)
class ForceFigures:
    """Figures of the force on the workpiece.

    Attributes
    ----------
    steady_error : float
        Greatest mean error of a wanted force after it was reached [N].
    moving_rms : float
        Root mean square of the error after a wanted force was reached, in a moving mean of 20 ms [N].
    overshoot : float
        Greatest overshoot of a step upwards between two such forces, as a share of the step; 0 without steps.
    vibration : float
        Root mean square of what is faster than the moving mean [N].
    greatest, least : float
        Of the moving mean after a wanted force was reached [N].
    """

    steady_error: float
    moving_rms: float
    overshoot: float
    vibration: float
    greatest: float
    least: float

    @property
    def is_within_goals(self) -> bool:
        """Return whether steady error, moving rms and overshoot are within 1 N, 3 N and 10 %."""
        return self.steady_error <= 1.0 and self.moving_rms <= 3.0 and self.overshoot <= 0.1

    def as_json(self) -> dict[str, float | None]:
        """Return the figures in newtons and percent; None where no wanted force lasted long enough."""
        values = {
            "steady_error_n": self.steady_error,
            "moving_rms_n": self.moving_rms,
            "overshoot_percent": 100.0 * self.overshoot,
            "vibration_rms_n": self.vibration,
            "greatest_n": self.greatest,
            "least_n": self.least,
        }
        return {name: round(value, 3) if math.isfinite(value) else None for name, value in values.items()}


def recorded(run: Grinding) -> Record:
    """Step a run to its end, and return what was measured."""
    samples = []
    while not run.is_over:
        samples.append(run.step())
    return record_of(samples)


def record_of(samples: Iterable[Sample]) -> Record:
    """Return samples as arrays."""
    rows = list(samples)
    numbers = np.array([[getattr(row, name) for name in _NUMBERS] for row in rows], dtype=np.float64)
    numbers = numbers.reshape(len(rows), len(_NUMBERS))
    phases = np.array([_PHASES.index(row.phase) for row in rows], dtype=np.int64)
    return Record(phase=phases, **{name: numbers[:, index] for index, name in enumerate(_NUMBERS)})


def force_figures(record: Record) -> ForceFigures:
    """Return the figures of the force while it was controlled."""
    force, grinding = record.smooth_force, record.is_grinding
    bounds = np.flatnonzero(np.diff(grinding.astype(np.int8), prepend=0, append=0))
    errors: list[NDArray[np.float64]] = []
    kept: list[NDArray[np.float64]] = []
    overshoots = [0.0]
    for begin, end in zip(bounds[::2], bounds[1::2], strict=True):
        for first, last, step in _levels(record.wanted[begin:end], record.time[begin:end]):
            wanted = record.wanted[begin + last - 1]
            part, times = force[begin + first : begin + last], record.time[begin + first : begin + last]
            settled = (times > times[0] + STEADY_TIME) & (times < times[-1] - SMOOTHING)
            if settled.any():
                errors.append(part[settled] - wanted)
                kept.append(part[settled])
            if step > 0.0:
                overshoots.append(float(part[times < times[-1] - SMOOTHING].max(initial=wanted) - wanted) / step)
    fast = (record.force - force)[grinding]
    vibration = float(np.sqrt((fast**2).mean())) if fast.size else 0.0
    if not errors:
        return ForceFigures(float("nan"), float("nan"), max(overshoots), vibration, float("nan"), float("nan"))
    everything, forces = np.concatenate(errors), np.concatenate(kept)
    return ForceFigures(
        max(abs(float(part.mean())) for part in errors),
        float(np.sqrt((everything**2).mean())),
        max(overshoots),
        vibration,
        float(forces.max()),
        float(forces.min()),
    )


def _levels(wanted: NDArray[np.float64], time: NDArray[np.float64]) -> list[tuple[int, int, float]]:
    """Return begin, end and the step before it [N] of each stretch of one wanted force that is longer than 0.6 s.

    The step is 0 where no such stretch is right before it: a ramp is none.
    """
    changes = np.flatnonzero(np.abs(np.diff(wanted)) > 1e-9) + 1
    bounds = [0, *changes.tolist(), len(wanted)]
    found: list[tuple[int, int, float]] = []
    for first, last in itertools.pairwise(bounds):
        if time[last - 1] - time[first] > 1.2 * STEADY_TIME:
            is_step = bool(found) and found[-1][1] == first
            found.append((first, last, float(wanted[first] - wanted[first - 1]) if is_step else 0.0))
    return found


def record_bytes(record: Record) -> bytes:
    """Return the content of an ``.npz`` file that `read_record` reads."""
    stream = io.BytesIO()
    np.savez_compressed(stream, **{field.name: getattr(record, field.name) for field in fields(record)})
    return stream.getvalue()


def read_record(path: Path) -> Record:
    """Return the record in an ``.npz`` file.

    Raises
    ------
    UserError
        Where it is none.
    """
    if not path.is_file():
        raise UserError(f"{path}: there is no such file")
    try:
        with np.load(path, allow_pickle=False) as file:
            content: dict[str, Any] = {name: file[name] for name in file.files}
    except (OSError, ValueError, zipfile.BadZipFile, EOFError, AttributeError, TypeError) as error:
        raise UserError(f"{path}: is no record (.npz): {str(error).splitlines()[0]}") from None
    names = [field.name for field in fields(Record)]
    for name in names:
        if name not in content:
            raise UserError(f"{path}: has no array '{name}'")
        array = content[name]
        if array.ndim != 1 or array.shape != content[names[0]].shape or array.dtype.kind not in "fi":
            raise UserError(f"{path}: '{name}' is no row of numbers as long as '{names[0]}'")
    return Record(**{name: content[name] for name in names})
