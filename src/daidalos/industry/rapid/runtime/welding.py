"""Predefined routines of arc welding: movements at the speed of the weld, which start and end a process.

Without a power source, the process is a state that a program can see by its speed only. Weaving and tracking do not
change the path.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from daidalos.industry.rapid.runtime.errors import RapidError
from daidalos.industry.rapid.runtime.movements import FINE, order
from daidalos.industry.rapid.runtime.registry import routine

if TYPE_CHECKING:
    from daidalos.industry.rapid.runtime.task import Task


def _weld(name: str, instruction: str, starts: bool = False, ends: bool = False) -> None:
    @routine(name)
    def move(
        task: Task,
        topoint_: list[Any],
        speed_: list[float],
        weld_: list[Any],
        zone_: list[Any],
        tool_: list[Any],
        cirpoint_: list[Any] | None = None,
        wobj_: list[Any] | None = None,
        id_: float | None = None,
        **rest: Any,
    ) -> None:
        is_on = bool(task.settings.get("is_welding"))
        if not (is_on or starts):
            raise RapidError("ERR_PATH", f"{name} comes behind ArcLStart or ArcCStart, which starts the process")
        v = float(weld_[0]) if is_on and weld_[0] else None
        zone = FINE if starts or ends else zone_
        order(task, instruction, topoint_, speed_, zone, tool_, wobj_, cirpoint_, v, number=id_)
        task.settings["is_welding"] = not ends

    move.__doc__ = f"Carry out {name}."


for _number in ("", "1", "2"):
    for _letter, _instruction in (("L", "MoveL"), ("C", "MoveC")):
        _weld(f"Arc{_letter}{_number}Start", _instruction, starts=True)
        _weld(f"Arc{_letter}{_number}", _instruction)
        _weld(f"Arc{_letter}{_number}End", _instruction, ends=True)


@routine("ArcRefresh")
def refresh(task: Task, **rest: Any) -> None:
    """Take changed data of the weld: movements read it anew each time."""
