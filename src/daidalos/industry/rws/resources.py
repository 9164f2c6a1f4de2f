"""What Robot Web Services know of a controller: resources by their paths, and actions on them.

Paths are those of version 1.0; the server maps those of 2.0 to them.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from daidalos.common.suggestions import hint
from daidalos.industry.rapid.runtime.errors import RapidError
from daidalos.industry.rapid.runtime.positions import TOOL0, WOBJ0
from daidalos.industry.rapid.runtime.values import text_of, value_of_text
from daidalos.industry.rapid.symbols import DataSymbol
from daidalos.industry.rws.controller import TASK, UNIT, Refused, VirtualController

_NO_EXTERNAL = "9E+09"


@dataclass(frozen=True)
class Item:
    """One item of a resource: its class, its title, and its values by name."""

    kind: str
    title: str
    values: Mapping[str, str]
    path: str = ""


class Unknown(KeyError):
    """A path or name that there is not."""

    def __str__(self) -> str:
        return str(self.args[0])


class Malformed(ValueError):
    """A request without what it needs, or with what it cannot be."""


class Resources:
    """Resources of a controller."""

    def __init__(self, controller: VirtualController) -> None:
        self.controller = controller

    def get(self, path: str, query: Mapping[str, str] | None = None) -> list[Item]:
        """Return the items of a resource.

        Raises
        ------
        Unknown
            Where there is none.
        """
        parts = [part for part in path.split("/") if part]
        asked = query or {}
        fixed = self._fixed().get("/".join(parts))
        if fixed is not None:
            return fixed()
        if parts[:3] == ["rw", "iosystem", "signals"] and len(parts) > 3:
            return [self._signal(parts[-1])]
        if parts[:4] == ["rw", "rapid", "symbol", "data"] and len(parts) > 5:
            return [self._symbol(parts[4:])]
        if parts[:3] == ["rw", "motionsystem", "mechunits"] and len(parts) == 5:
            return [self._position(parts[3], parts[4], asked)]
        if parts[:3] == ["rw", "rapid", "tasks"] and len(parts) in (4, 5):
            return self._task_items(parts[3:])
        raise Unknown(f"there is no resource '{path}'")

    def _fixed(self) -> dict[str, Callable[[], list[Item]]]:
        controller = self.controller
        state = "running" if controller.is_running else "stopped"
        motors = "motoron" if controller.motors_on else "motoroff"
        return {
            "rw/rapid/execution": lambda: [
                Item("rap-execution", "execution", {"ctrlexecstate": state, "cycle": "forever"})
            ],
            "rw/panel/ctrlstate": lambda: [Item("pnl-ctrlstate", "ctrlstate", {"ctrlstate": motors})],
            "rw/panel/opmode": lambda: [Item("pnl-opmode", "opmode", {"opmode": controller.mode})],
            "rw/panel/speedratio": lambda: [
                Item("pnl-speedratio", "speedratio", {"speedratio": str(controller.speed_ratio)})
            ],
            "rw/iosystem/signals": lambda: [self._signal(name, "-li") for name in controller.signals.values()],
            "rw/rapid/tasks": lambda: self._task_items([TASK]),
            "rw/motionsystem/mechunits": lambda: [
                Item("ms-mechunit-li", UNIT, {"mode": "Activated", "activation-allowed": "true"})
            ],
            "rw/system": lambda: [
                Item("sys-system-li", "system", {"name": "daidalos", "rwversion": "6.08.0", "sysid": "{daidalos}"})
            ],
            "ctrl/identity": lambda: [
                Item("ctrl-identity-info", "identity", {"ctrl-name": "daidalos", "ctrl-type": "Virtual Controller"})
            ],
        }

    def _task_items(self, parts: list[str]) -> list[Item]:
        if parts[0] != TASK:
            raise Unknown(f"there is no task '{parts[0]}', but {TASK}")
        state = "running" if self.controller.is_running else "stopped"
        if len(parts) == 1:
            values = {"name": TASK, "type": "normal", "taskstate": "linked", "excstate": state, "active": "On"}
            return [Item("rap-task-li", TASK, {**values, "motiontask": "TRUE"})]
        if parts[1] != "modules":
            raise Unknown(f"there is no resource '{parts[1]}' of a task, but modules")
        names = [one.name.text for parsed in self.controller.task.modules for one in parsed.tree.modules]
        return [Item("rap-module-info-li", name, {"name": name, "type": "ProgMod"}) for name in names]

    def _signal(self, name: str, ending: str = "") -> Item:
        board = self.controller.signals
        try:
            value = board.value(name)
        except RapidError as error:
            raise Unknown(str(error)) from None
        known = {one.lower(): one for one in board.values()}.get(name.lower(), name)
        kind = _signal_kind(known)
        values = {"name": known, "type": kind, "lvalue": f"{value:g}", "lstate": "simulated"}
        return Item(f"ios-signal{ending}", known, values)

    def _symbol(self, parts: list[str]) -> Item:
        symbol = self._data(parts)
        digits = 9
        text = text_of(self.controller.task.value(symbol.name), digits)
        return Item("rap-data", "/".join(parts), {"value": text, "dattyp": symbol.type.name})

    def _data(self, parts: list[str]) -> DataSymbol:
        """Return the declaration of data by RAPID, task, module and name, or without the module."""
        if parts[0].upper() != "RAPID" or parts[1] != TASK:
            raise Unknown(f"'{'/'.join(parts)}' is no data of RAPID/{TASK}")
        try:
            symbol = self.controller.task.data(parts[-1]).symbol
        except RapidError as error:
            names = [one.name for _, one, _ in self.controller.task.stored_data()]
            raise Unknown(f"{error}{hint(parts[-1], names)}") from None
        assert isinstance(symbol, DataSymbol)
        modules = {one.name.lower(): module for module, one, _ in self.controller.task.stored_data()}
        if len(parts) == 4 and modules[symbol.name.lower()].lower() != parts[2].lower():
            raise Unknown(f"module '{parts[2]}' has no data '{parts[3]}'")
        return symbol

    def _position(self, unit: str, kind: str, query: Mapping[str, str]) -> Item:
        if unit != UNIT:
            raise Unknown(f"there is no mechanical unit '{unit}', but {UNIT}")
        if kind == "jointtarget":
            angles, external = self.controller.joint_target()
            values = {f"rax_{k}": f"{angle:.6g}" for k, angle in enumerate(angles, 1)}
            return Item("ms-jointtarget", UNIT, values | _external(external))
        if kind != "robtarget":
            raise Unknown(f"there is no '{kind}' of a mechanical unit, but jointtarget and robtarget")
        tool, wobj = self._frame(query, "tool", TOOL0), self._frame(query, "wobj", WOBJ0)
        position, orientation, configuration, external = self.controller.robot_target(tool, wobj)
        values = dict(zip("xyz", (f"{one:.6f}" for one in position), strict=True))
        values |= {f"q{k}": f"{one:.9f}" for k, one in enumerate(orientation, 1)}
        names = ("cf1", "cf4", "cf6", "cfx")
        values |= {name: f"{one:g}" for name, one in zip(names, configuration, strict=True)}
        return Item("ms-robtargets", UNIT, values | _external(external))

    def _frame(self, query: Mapping[str, str], name: str, default: list[Any]) -> list[Any]:
        asked = query.get(name, "")
        if asked.lower() in ("", f"{name}0"):
            return default
        try:
            return list(self.controller.task.value(asked))
        except (RapidError, TypeError):
            raise Unknown(f"there is no {name} '{asked}'") from None

    # Actions

    def act(self, path: str, action: str, form: Mapping[str, str]) -> None:
        """Carry out an action on a resource.

        Raises
        ------
        Unknown, Malformed, Refused
            Where there is no such resource or action, something is missing or wrong, or the state does not allow it.
        """
        parts = [part for part in path.split("/") if part]
        place = "/".join(parts)
        simple = {
            ("rw/rapid/execution", "start"): self.controller.start,
            ("rw/rapid/execution", "stop"): self.controller.stop,
            ("rw/rapid/execution", "resetpp"): self.controller.reset,
        }
        if (place, action) in simple:
            simple[place, action]()
        elif (place, action) == ("rw/panel/ctrlstate", "setctrlstate"):
            self._set_motors(_needed(form, "ctrl-state"))
        elif (place, action) == ("rw/panel/speedratio", "setspeedratio"):
            self.controller.set_speed_ratio(_whole(_needed(form, "speed-ratio")))
        elif parts[:3] == ["rw", "iosystem", "signals"] and len(parts) > 3 and action == "set":
            self._set_signal(parts[-1], _needed(form, "lvalue"))
        elif parts[:4] == ["rw", "rapid", "symbol", "data"] and len(parts) > 5 and action == "set":
            self._set_symbol(parts[4:], _needed(form, "value"))
        elif parts[:2] == ["rw", "mastership"]:
            return  # there is one master, who may do everything
        else:
            raise Unknown(f"there is no action '{action}' of '{path}'")

    def _set_motors(self, state: str) -> None:
        if state not in ("motoron", "motoroff"):
            raise Malformed(f"ctrl-state is '{state}', but must be motoron or motoroff")
        self.controller.set_motors(state == "motoron")

    def _set_signal(self, name: str, text: str) -> None:
        try:
            value = float(text)
        except ValueError:
            raise Malformed(f"lvalue is '{text}', but must be a number") from None
        if not abs(value) < 1e300:
            raise Malformed(f"lvalue is {text}, but must be finite")
        try:
            self.controller.signals.set(name, value)
        except RapidError as error:
            raise Unknown(str(error)) from None

    def _set_symbol(self, parts: list[str], text: str) -> None:
        symbol = self._data(parts)
        if symbol.kind == "CONST":
            raise Refused(f"'{symbol.name}' is a constant")
        task = self.controller.task
        try:
            value = value_of_text(text, task.value(symbol.name))
        except (ValueError, RecursionError):
            raise Malformed(f"'{text}' is no {symbol.type.name}") from None
        task.set_value(symbol.name, value)


def _needed(form: Mapping[str, str], name: str) -> str:
    if name not in form:
        raise Malformed(f"'{name}' is missing")
    return form[name]


def _whole(text: str) -> int:
    try:
        return int(text)
    except ValueError:
        raise Malformed(f"'{text}' is no whole number") from None


def _external(values: list[float]) -> dict[str, str]:
    texts = (_NO_EXTERNAL if one > 8e9 else f"{one:g}" for one in values)
    return dict(zip((f"eax_{letter}" for letter in "abcdef"), texts, strict=True))


def _signal_kind(name: str) -> str:
    """Return the kind of a signal by the first letters of its name, as configurations name them."""
    begin = name[:2].lower()
    return begin.upper() if begin in ("di", "do", "ai", "ao", "gi", "go") else "DO"
