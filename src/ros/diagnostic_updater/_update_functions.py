"""Ready-made tasks: how often something happens, whether stamps make sense, and whether the node is alive."""

from __future__ import annotations

import threading
from typing import Any

from diagnostic_msgs.msg import DiagnosticStatus
from rclpy.clock import Clock, ROSClock

from ._diagnostic_status_wrapper import DiagnosticStatusWrapper
from ._diagnostic_updater import DiagnosticTask


class FrequencyStatusParam:
    """Accepted frequencies.

    Parameters
    ----------
    freq_bound
        A dictionary with "min" and, if there is one, "max", in hertz; it may be changed later.
    tolerance
        By how large a part of them the frequency may lie beyond the bounds.
    window_size
        Over how many updates to count.
    """

    def __init__(self, freq_bound: dict[str, float], tolerance: float = 0.1, window_size: int = 5) -> None:
        self.freq_bound = freq_bound
        self.tolerance = tolerance
        self.window_size = window_size


class FrequencyStatus(DiagnosticTask):
    """Task that warns when something happens too often or too seldom; an error when it does not happen at all.

    Parameters
    ----------
    params
        What is right.
    name
        Of the task.
    clock
        By which to measure; ROS time by default.
    """

    def __init__(self, params: FrequencyStatusParam, name: str = "FrequencyStatus", clock: Clock | None = None) -> None:
        super().__init__(name)
        self.params = params
        self.lock = threading.Lock()
        self._clock = clock or ROSClock()
        self.clear()

    def clear(self) -> None:
        """Reset the counts."""
        with self.lock:
            self.count = 0
            self.times = [self._clock.now()] * self.params.window_size
            self.seq_nums = [0] * self.params.window_size
            self.hist_indx = 0

    def tick(self) -> None:
        """Count an event."""
        with self.lock:
            self.count += 1

    def run(self, stat: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
        """Fill in a status."""
        events, window, total = self._measure()
        frequency = events / window if window > 0.0 else float("inf") if events else 0.0
        bound, tolerance = self.params.freq_bound, self.params.tolerance
        low = bound["min"] * (1.0 - tolerance)
        high = bound["max"] * (1.0 + tolerance) if "max" in bound else None
        if events == 0:
            stat.summary(DiagnosticStatus.ERROR, "No events recorded.")
        elif frequency < low:
            stat.summary(DiagnosticStatus.WARN, "Frequency too low.")
        elif high is not None and frequency > high:
            stat.summary(DiagnosticStatus.WARN, "Frequency too high.")
        else:
            stat.summary(DiagnosticStatus.OK, "Desired frequency met")
        stat.add("Events in window", str(events))
        stat.add("Events since startup", str(total))
        stat.add("Duration of window (s)", f"{window:f}")
        stat.add("Actual frequency (Hz)", f"{frequency:f}")
        if bound.get("max") == bound["min"]:
            stat.add("Target frequency (Hz)", f"{bound['min']:f}")
        if bound["min"] > 0:
            stat.add("Minimum acceptable frequency (Hz)", f"{low:f}")
        if high is not None:
            stat.add("Maximum acceptable frequency (Hz)", f"{high:f}")
        return stat

    def _measure(self) -> tuple[int, float, int]:
        """Return the events since the window began, its length in seconds, and all events; move the window on."""
        with self.lock:
            now = self._clock.now()
            place = self.hist_indx
            events = self.count - self.seq_nums[place]
            window = (now - self.times[place]).nanoseconds * 1e-9
            self.seq_nums[place], self.times[place] = self.count, now
            self.hist_indx = (place + 1) % self.params.window_size
            return events, window, self.count


class TimeStampStatusParam:
    """Accepted delays of stamps [s]; stamps of the future have a negative delay."""

    def __init__(self, min_acceptable: float = -1, max_acceptable: float = 5) -> None:
        self.max_acceptable = max_acceptable
        self.min_acceptable = min_acceptable


class TimeStampStatus(DiagnosticTask):
    """Task that reports an error when a stamp is zero, or lies too far in the past or the future.

    Parameters
    ----------
    params
        What is right.
    name
        Of the task.
    clock
        To compare with; ROS time by default.
    """

    def __init__(
        self,
        params: TimeStampStatusParam | None = None,
        name: str = "Timestamp Status",
        clock: Clock | None = None,
    ) -> None:
        super().__init__(name)
        self.params = params or TimeStampStatusParam()
        self.lock = threading.Lock()
        self._clock = clock or ROSClock()
        self.early_count = 0
        self.late_count = 0
        self.zero_count = 0
        self._forget()

    def _forget(self) -> None:
        self.zero_seen = False
        self.max_delta = 0.0
        self.min_delta = 0.0
        self.deltas_valid = False

    def tick(self, stamp: Any) -> None:
        """Record a stamp: a time, a message or seconds."""
        seconds = _seconds(stamp)
        with self.lock:
            if seconds == 0:
                self.zero_seen = True
                return
            delta = (self._clock.now().nanoseconds - seconds * 1e9) * 1e-9
            self.max_delta = max(delta, self.max_delta) if self.deltas_valid else delta
            self.min_delta = min(delta, self.min_delta) if self.deltas_valid else delta
            self.deltas_valid = True

    def run(self, stat: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
        """Fill in a status about the stamps since the last time."""
        with self.lock:
            self._summarise(stat)
            stat.add("Earliest timestamp delay:", f"{self.min_delta:f}")
            stat.add("Latest timestamp delay:", f"{self.max_delta:f}")
            stat.add("Earliest acceptable timestamp delay:", f"{self.params.min_acceptable:f}")
            stat.add("Latest acceptable timestamp delay:", f"{self.params.max_acceptable:f}")
            stat.add("Late diagnostic update count:", str(self.late_count))
            stat.add("Early diagnostic update count:", str(self.early_count))
            stat.add("Zero seen diagnostic update count:", str(self.zero_count))
            self._forget()
        return stat

    def _summarise(self, stat: DiagnosticStatusWrapper) -> None:
        stat.summary(DiagnosticStatus.OK, "Timestamps are reasonable.")
        if not self.deltas_valid and not self.zero_seen:
            stat.summary(DiagnosticStatus.WARN, "No data since last update.")
            return
        if self.deltas_valid and self.min_delta < self.params.min_acceptable:
            stat.summary(DiagnosticStatus.ERROR, "Timestamps too far in future seen.")
            self.early_count += 1
        if self.deltas_valid and self.max_delta > self.params.max_acceptable:
            stat.summary(DiagnosticStatus.ERROR, "Timestamps too far in past seen.")
            self.late_count += 1
        if self.zero_seen:
            stat.summary(DiagnosticStatus.ERROR, "Zero timestamp seen.")
            self.zero_count += 1


def _seconds(stamp: Any) -> float:
    if isinstance(stamp, (int, float)):
        return float(stamp)
    nanoseconds = getattr(stamp, "nanoseconds", None)
    return float(stamp.sec + stamp.nanosec * 1e-9 if nanoseconds is None else nanoseconds * 1e-9)


class Heartbeat(DiagnosticTask):
    """Task that reports that the node is alive."""

    def __init__(self) -> None:
        super().__init__("Heartbeat")

    def run(self, stat: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
        """Fill in a status."""
        stat.summary(DiagnosticStatus.OK, "Alive")
        return stat
