"""Signals: values over simulated time, and the assertions on them."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from daidalos.testing.conditions import Condition, condition, read_field
from daidalos.testing.scenario import ScenarioFailure

if TYPE_CHECKING:
    from daidalos.testing.scenario import Scenario

_KEPT = 2000
"""Number of values that are kept for messages and pictures."""

_SHOWN = 5
FIRST_S = 10.0
"""Time [s] that a first value may take to come where nothing else is said."""


class Requirement:
    """Condition that has to hold for every value from now on.

    Parameters
    ----------
    signal : Signal
    wanted : Condition
    is_negated : bool
        Whether it is the condition that must not hold.
    """

    def __init__(self, signal: Signal, wanted: Condition, is_negated: bool) -> None:
        self._signal = signal
        self._wanted = wanted
        self._is_negated = is_negated
        self._values: list[tuple[float, Any]] = []
        self.is_broken = False
        self.count = 0
        signal.listen(self._on_value)

    def stop(self) -> None:
        """Require it no longer."""
        self._signal.ignore(self._on_value)

    def _on_value(self, when: float, value: Any) -> None:
        self.count += 1
        if self.is_broken or self._wanted.holds(value) is not self._is_negated:
            return
        self.is_broken = True
        self.stop()
        word = "never" if self._is_negated else "always"
        self._signal.scenario.fail(
            f"{self._signal.name} should {word} be {self._wanted.text}, but at {when:.3f} s it was "
            f"{describe(value)}\n{self._signal.history()}"
        )


class Signal:
    """Values over simulated time.

    Parameters
    ----------
    scenario : Scenario
    name : str
        For messages.

    Attributes
    ----------
    values : deque of (float, value)
        The last ones, with the simulated times [s] at which they came.
    """

    def __init__(self, scenario: Scenario, name: str) -> None:
        self.scenario = scenario
        self.name = name
        self.values: deque[tuple[float, Any]] = deque(maxlen=_KEPT)
        self._listeners: list[Callable[[float, Any], None]] = []
        scenario.signals.append(self)

    # What comes.

    def push(self, value: Any) -> None:
        """Add a value that comes now."""
        when = self.scenario.now
        self.values.append((when, value))
        for listener in tuple(self._listeners):
            listener(when, value)
        self.scenario.notify()

    def listen(self, listener: Callable[[float, Any], None]) -> None:
        """Call a function with the time [s] and the value whenever one comes."""
        self._listeners.append(listener)

    def ignore(self, listener: Callable[[float, Any], None]) -> None:
        """Call a function no longer."""
        if listener in self._listeners:
            self._listeners.remove(listener)

    def field(self, path: str) -> Signal:
        """Return the signal of a part of the values, such as ``pose.pose.position.x`` or ``ranges[0]``."""
        return self.map(lambda value: read_field(value, path), path)

    def map(self, function: Callable[[Any], Any], name: str = "") -> Signal:
        """Return the signal of a function's results.

        Parameters
        ----------
        function : callable
            Of a value.
        name : str, optional
            For messages; the function's own where empty.
        """
        return _Mapped(self, function, f"{self.name} {name or getattr(function, '__name__', '')}")

    # Reading.

    @property
    def value(self) -> Any:
        """The last value; where none has come yet, the first one is waited for.

        Raises
        ------
        ScenarioFailure
            When none comes within `FIRST_S`.
        """
        __tracebackhide__ = True
        if not self.values:
            self.wait(FIRST_S)
        return self.values[-1][1]

    def wait(self, within: float = FIRST_S) -> Any:
        """Wait for the next value and return it.

        Raises
        ------
        ScenarioFailure
            When none comes in time.
        """
        __tracebackhide__ = True
        return self._first(Condition("", lambda value: True), within, is_next=True)

    def rate(self, during: float) -> float:
        """Return the number of values a second [Hz] that come during some time [s]."""
        before: list[float] = []
        listener: Callable[[float, Any], None] = lambda when, value: before.append(when)  # noqa: E731
        self.listen(listener)
        self.scenario.sleep(during)
        self.ignore(listener)
        return len(before) / during

    # Assertions.

    def eventually(self, test: Any = None, *, within: float, **wanted: Any) -> Any:
        """Require that a value comes for which a condition holds; return it. The present value counts.

        Parameters
        ----------
        test
            See `condition`.
        within : float
            Simulated time [s].
        **wanted
            See `condition`.

        Raises
        ------
        ScenarioFailure
            With the values that did not fulfil it.
        """
        __tracebackhide__ = True
        return self._first(condition(test, **wanted), within)

    def always(self, test: Any = None, *, during: float | None = None, **wanted: Any) -> Requirement:
        """Require that a condition holds for every value.

        Parameters
        ----------
        test
            See `condition`.
        during : float, optional
            Wait for so long [s]; without it the test goes on, and the condition has to hold until its end.
        **wanted
            See `condition`.

        Raises
        ------
        ScenarioFailure
            At the first value that does not fulfil it, or when no value comes at all.
        """
        __tracebackhide__ = True
        return self._require(condition(test, **wanted), during, is_negated=False)

    def never(self, test: Any = None, *, during: float | None = None, **wanted: Any) -> Requirement:
        """Require that a condition holds for no value; see `always`."""
        __tracebackhide__ = True
        return self._require(condition(test, **wanted), during, is_negated=True)

    def stays(self, test: Any = None, *, within: float, during: float, **wanted: Any) -> None:
        """Require that a condition comes to hold within some time [s], and then holds for some time [s]."""
        __tracebackhide__ = True
        self.eventually(test, within=within, **wanted)
        self.always(test, during=during, **wanted)

    def _first(self, wanted: Condition, within: float, *, is_next: bool = False) -> Any:
        __tracebackhide__ = True
        found: list[Any] = []
        seen: list[tuple[float, Any]] = []
        if self.values and not is_next:
            seen.append(self.values[-1])
            if wanted.holds(self.values[-1][1]):
                return self.values[-1][1]

        def look(when: float, value: Any) -> None:
            seen.append((when, value))
            if not found and wanted.holds(value):
                found.append(value)

        self.listen(look)
        begun = self.scenario.now
        try:
            came = self.scenario.wait(lambda: bool(found), within)
        finally:
            self.ignore(look)
        if came:
            return found[0]
        span = f"within {within:g} s (from {begun:.3f} s to {self.scenario.now:.3f} s)"
        if not seen:
            raise ScenarioFailure(f"{self.name}: no value came {span}{self.explain()}")
        raise ScenarioFailure(f"{self.name} should be {wanted.text} {span}, but was\n{_table(seen, wanted)}")

    def _require(self, wanted: Condition, during: float | None, *, is_negated: bool) -> Requirement:
        __tracebackhide__ = True
        if self.values and wanted.holds(self.values[-1][1]) is is_negated:
            word = "never" if is_negated else "always"
            raise ScenarioFailure(f"{self.name} should {word} be {wanted.text}, but it is\n{self.history()}")
        requirement = Requirement(self, wanted, is_negated)
        if during is not None:
            try:
                self.scenario.sleep(during)
            finally:
                requirement.stop()
            if not requirement.count and not self.values:
                raise ScenarioFailure(f"{self.name}: no value came within {during:g} s{self.explain()}")
        return requirement

    # Messages.

    def explain(self) -> str:
        """Return why there may be no value, as the end of a message."""
        return ""

    def history(self) -> str:
        """Return the last values as lines of a table."""
        return _lines(list(self.values)[-_SHOWN:])


class _Mapped(Signal):
    """Results of a function of another signal's values."""

    def __init__(self, source: Signal, function: Callable[[Any], Any], name: str) -> None:
        super().__init__(source.scenario, name)
        self._source = source
        self._function = function
        self.values.extend((when, function(value)) for when, value in source.values)
        source.listen(self._on_value)

    def _on_value(self, when: float, value: Any) -> None:
        self.push(self._function(value))

    def explain(self) -> str:
        """Return why the source has no value."""
        return self._source.explain()


def describe(value: Any) -> str:
    """Return a value in one line that is not too long."""
    text = f"{value:.6g}" if isinstance(value, float) else str(value) if isinstance(value, str) else repr(value)
    text = " ".join(text.split())
    return text if len(text) <= 160 else f"{text[:157]}..."


def _table(values: list[tuple[float, Any]], wanted: Condition) -> str:
    """Return the first and the last values, and the nearest to what was wanted."""
    shown = values if len(values) <= _SHOWN + 1 else [*values[:2], *values[-(_SHOWN - 2) :]]
    lines = _lines(shown[:2]) if len(shown) < len(values) else _lines(shown)
    if len(shown) < len(values):
        lines += f"\n  ... {len(values) - len(shown)} more\n" + _lines(shown[2:])
    if wanted.miss is not None and len(values) > 1:
        when, value = min(values, key=lambda pair: wanted.miss(pair[1]))  # type: ignore[misc]
        lines += f"\n  nearest: {describe(value)} at {when:.3f} s"
    return lines


def _lines(values: list[tuple[float, Any]]) -> str:
    return "\n".join(f"  {when:9.3f} s  {describe(value)}" for when, value in values)
