"""History of a filter, so that measurements that come late are taken in at their own time."""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass, field

from daidalos.common.arrays import Array
from daidalos.localization.filters.kalman import KalmanFilter, Measurement


@dataclass(frozen=True)
class _Step:
    """A measurement, and the filter after it."""

    source: str
    measurement: Measurement
    time: float
    state: Array
    covariance: Array


@dataclass
class FilterHistory:
    """Measurements of the last seconds in the order of their times, and the filter's state after each.

    Attributes
    ----------
    length : float
        How far back [s] from the newest state.
    """

    length: float
    _steps: list[_Step] = field(default_factory=list)

    def clear(self) -> None:
        """Forget everything."""
        self._steps.clear()

    def record(self, source: str, measurement: Measurement, estimate: KalmanFilter) -> None:
        """Keep a measurement that a filter has just processed, and forget those that are too old.

        Parameters
        ----------
        source : str
            Name of what measured it.
        measurement : Measurement
            Rejected ones are kept as well: a late measurement before them may change that.
        estimate : KalmanFilter
        """
        assert estimate.time is not None
        self._steps.append(_Step(source, measurement, estimate.time, estimate.state.copy(), estimate.covariance.copy()))
        oldest = bisect_right(self._steps, estimate.time - self.length, key=lambda step: step.time)
        del self._steps[: max(0, oldest - 1)]

    def rewind(self, estimate: KalmanFilter, time: float) -> list[tuple[str, Measurement]] | None:
        """Set a filter back to its last state that is not after a time [s].

        Returns
        -------
        list of (str, Measurement), or None
            What was processed since then and has to be processed again, after what was measured at `time`; None where
            the history does not reach back as far, and the filter is as it was.
        """
        kept = bisect_right(self._steps, time, key=lambda step: step.time)
        if kept == 0:
            return None
        last, undone = self._steps[kept - 1], self._steps[kept:]
        del self._steps[kept:]
        estimate.time, estimate.state, estimate.covariance = last.time, last.state.copy(), last.covariance.copy()
        return [(step.source, step.measurement) for step in undone]
