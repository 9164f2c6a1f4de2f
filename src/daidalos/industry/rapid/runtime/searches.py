"""Predefined routines that move until a signal changes, and tell where: SearchL and SearchC."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from daidalos.industry.rapid.runtime.errors import RapidError
from daidalos.industry.rapid.runtime.movements import FINE, order
from daidalos.industry.rapid.runtime.positions import WOBJ0
from daidalos.industry.rapid.runtime.registry import routine

if TYPE_CHECKING:
    from daidalos.industry.rapid.runtime.task import Task


class _Search:
    """The signal of a search, and where it has changed."""

    def __init__(self, task: Task, signal: str, flanks: tuple[Any, ...], frames: tuple[Any, Any]) -> None:
        self._task, self._signal, self._frames = task, signal, frames
        self._any, self._positive, self._negative, self._high, self._low = map(bool, flanks)
        self.hits: list[list[Any]] = []
        self._before = task.signals.value(signal)
        self.is_active = not (self._any or self._positive or self._negative) and self._before == self._wanted
        if self.is_active and (self._high or self._low):
            self._hit()

    @property
    def _wanted(self) -> float:
        return 0.0 if self._negative or self._low else 1.0

    def look(self) -> None:
        """Take the robot's position where the signal has changed as it should."""
        value = self._task.signals.value(self._signal)
        changed, self._before = value != self._before, value
        if changed and (self._any or value == self._wanted):
            self._hit()

    def _hit(self) -> None:
        self.hits.append(self._task.robot.robtarget(*self._frames))


def _search(
    task: Task,
    instruction: str,
    signal: str,
    point: list[Any],
    target: list[Any],
    speed: list[float],
    tool: list[Any],
    via: list[Any] | None,
    stops: bool,
    is_supervised: bool,
    flanks: tuple[Any, ...],
    rest: dict[str, Any],
) -> None:
    """Move, and stop where the signal changes if that is wanted.

    Raises
    ------
    RapidError
        ERR_SIGSUPSEARCH where the signal has its value from the start, or changes again under supervision;
        ERR_WHLSEARCH where it does not change.
    """
    wobj = rest.get("wobj_")
    task.wait_for_robot(task.robot.remaining)
    search = _Search(task, signal, flanks, (tool, wobj or WOBJ0))
    if search.is_active and not search.hits:
        raise RapidError("ERR_SIGSUPSEARCH", f"'{signal}' has its value before the search begins")
    seen = len(search.hits)

    def on_change(_key: str, _value: float) -> None:
        search.look()
        if stops and len(search.hits) > seen:
            task.robot.stop()

    task.signals.listeners.append(on_change)
    try:
        if not (stops and search.hits):
            v, t = rest.get("v_"), rest.get("t_")
            order(task, instruction, target, speed, FINE, tool, wobj, via, v, t, waits=False)
            _finish(task, stops, search)
    finally:
        task.signals.listeners.remove(on_change)
    if not search.hits:
        raise RapidError("ERR_WHLSEARCH", f"'{signal}' has not changed on the way")
    if is_supervised and len(search.hits) > 1:
        raise RapidError("ERR_SIGSUPSEARCH", f"'{signal}' has changed {len(search.hits)} times")
    point[:] = search.hits[0]


def _finish(task: Task, stops: bool, search: _Search) -> None:
    """Advance time until the robot stands, at the end of the way or where it was stopped."""
    while (left := task.robot.remaining()) > 0.0:
        if stops and search.hits:
            task.pass_time(task.robot.stop())
            task.robot.clear()
            task.robot.resume()
            return
        task.pass_time(min(left, task.robot.next_event() or left))


@routine("SearchL")
def search_l(
    task: Task,
    signal_: str,
    searchpoint_: list[Any],
    topoint_: list[Any],
    speed_: list[float],
    tool_: list[Any],
    stop_: Any = None,
    pstop_: Any = None,
    sstop_: Any = None,
    sup_: Any = None,
    flanks_: Any = None,
    posflank_: Any = None,
    negflank_: Any = None,
    highlevel_: Any = None,
    lowlevel_: Any = None,
    **rest: Any,
) -> None:
    """Search along a line."""
    flanks = (flanks_, posflank_, negflank_, highlevel_, lowlevel_)
    stops = bool(stop_ or pstop_ or sstop_)
    _search(task, "MoveL", signal_, searchpoint_, topoint_, speed_, tool_, None, stops, bool(sup_), flanks, rest)


@routine("SearchC")
def search_c(
    task: Task,
    signal_: str,
    searchpoint_: list[Any],
    cirpoint_: list[Any],
    topoint_: list[Any],
    speed_: list[float],
    tool_: list[Any],
    stop_: Any = None,
    pstop_: Any = None,
    sstop_: Any = None,
    sup_: Any = None,
    flanks_: Any = None,
    posflank_: Any = None,
    negflank_: Any = None,
    highlevel_: Any = None,
    lowlevel_: Any = None,
    **rest: Any,
) -> None:
    """Search along a circle."""
    flanks = (flanks_, posflank_, negflank_, highlevel_, lowlevel_)
    stops = bool(stop_ or pstop_ or sstop_)
    _search(task, "MoveC", signal_, searchpoint_, topoint_, speed_, tool_, cirpoint_, stops, bool(sup_), flanks, rest)
