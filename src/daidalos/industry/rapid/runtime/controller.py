"""Predefined routines about the controller: its mode, its modules, its configuration and its names."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from daidalos.industry.rapid.runtime.errors import FatalError, RapidError
from daidalos.industry.rapid.runtime.registry import routine
from daidalos.industry.rapid.runtime.values import copied

if TYPE_CHECKING:
    from daidalos.industry.rapid.runtime.task import Task
    from daidalos.industry.rapid.runtime.values import Handle

AUTO, MANUAL = 1.0, 2.0
"""Values of OP_AUTO and OP_MAN_PROG."""

_RUNNING = 1.0
_ORIGIN_NONE, _ORIGIN_CONFIGURED, _ORIGIN_ALIAS = 0.0, 1.0, 2.0
_SYSTEM = (("serialno", "0"), ("swversion", "6.0"), ("swversionname", "6.0"), ("ctrlid", "daidalos"),
           ("lanip", "127.0.0.1"), ("ctrllang", "en"), ("systemname", "daidalos"))  # fmt: skip


@routine("OpMode")
def operating_mode(task: Task) -> float:
    """Return the operating mode: automatic, or manual at reduced speed."""
    return MANUAL if task.settings.get("is_manual") else AUTO


@routine("RunMode")
def run_mode(task: Task, main_: Any = None) -> float:
    """Return how the program runs: continuously."""
    return 5.0


@routine("RobOS")
def is_controller(task: Task) -> bool:
    """Return whether this is a real controller."""
    return False


@routine("IsStopMoveAct", "IsLeadThrough", "IsBrakeCheckActive")
def is_off(task: Task, **rest: Any) -> bool:
    """Return FALSE: what it asks for is off."""
    return False


@routine("EventType", "ExecHandler", "ExecLevel")
def is_normal(task: Task) -> float:
    """Return 0: the program runs as usual."""
    return 0.0


@routine("WarmStart")
def nothing(task: Task, **rest: Any) -> None:
    """Do nothing that the program could see."""


@routine("GetSysInfo")
def system_information(task: Task, robottype_: Any = None, **switches: Any) -> str:
    """Return what a switch asks for; by default the serial number."""
    if robottype_:
        return task.robot.title
    return next((text for name, text in _SYSTEM if switches.get(f"{name}_")), _SYSTEM[0][1])


@routine("IsSysId")
def is_system(task: Task, systemid_: str) -> bool:
    """Return whether the controller has a serial number."""
    return systemid_ == _SYSTEM[0][1]


@routine("ReadCfgData")
def read_configuration(
    task: Task, instancepath_: str, attribute_: str, cfgdata_: Any, listno_: float | None = None
) -> None:
    """Read what WriteCfgData has written; there is no other configuration.

    Raises
    ------
    RapidError
        ERR_CFG_NOTFND
    """
    found = task.settings.get("configuration", {}).get((instancepath_.lower(), attribute_.lower()))
    if found is None:
        raise RapidError("ERR_CFG_NOTFND", f"'{instancepath_}' has no '{attribute_}': the program has written none")
    cfgdata_[0][cfgdata_[1]] = found


@routine("WriteCfgData")
def write_configuration(
    task: Task, instancepath_: str, attribute_: str, cfgdata_: Any, listno_: float | None = None
) -> None:
    """Keep a value of the configuration for ReadCfgData."""
    key = (instancepath_.lower(), attribute_.lower())
    task.settings.setdefault("configuration", {})[key] = cfgdata_


# Modules and data


@routine("ModExist")
def has_module(task: Task, modulename_: str) -> bool:
    """Return whether the task has a module."""
    names = (module.name.key for parsed in task.modules for module in parsed.tree.modules)
    return modulename_.lower() in names


@routine("Save")
def save_module(
    task: Task, modulename_: str, filepath_: str | None = None, file_: str | None = None, **rest: Any
) -> None:
    """Write a module with the present values of its persistents, below the program's folder.

    Raises
    ------
    RapidError
        ERR_MODULE, where there is no such module.
    """
    from daidalos.industry.rapid.runtime.files import resolve
    from daidalos.industry.rapid.runtime.persistence import text_with_values
    from daidalos.industry.rapid.sources import write_source

    for parsed in task.modules:
        if any(module.name.key == modulename_.lower() for module in parsed.tree.modules):
            path = resolve(task, filepath_ or f"HOME:/{modulename_}.mod", file_)
            write_source(path, text_with_values(task, parsed), parsed.source.encoding)
            return
    raise RapidError("ERR_MODULE", f"there is no module '{modulename_}'")


@routine("SetDataSearch")
def set_data_search(task: Task, type_: str, object_: str | None = None, perssym_: Any = None, varsym_: Any = None,
                    constsym_: Any = None, inmod_: str | None = None, **rest: Any) -> None:  # fmt: skip
    """Define which data GetNextSym finds: a type, a pattern of names, kinds and a module."""
    import re

    kinds = {kind for kind, is_on in (("PERS", perssym_), ("VAR", varsym_), ("CONST", constsym_)) if is_on}
    pattern = re.compile(object_ or ".*", re.IGNORECASE)
    task.settings["symbols"] = [
        symbol.name
        for module, symbol, _ in task.stored_data()
        if symbol.type.name == type_.lower()
        and pattern.fullmatch(symbol.name)
        and (not kinds or symbol.kind in kinds)
        and (not inmod_ or module.lower() == inmod_.lower())
    ]


@routine("GetNextSym")
def next_symbol(task: Task, object_: Any, block_: Handle, recursive_: Any = None) -> bool:
    """Return whether there is another name that SetDataSearch asks for, and which."""
    names: list[str] = task.settings.get("symbols", [])
    if not names:
        return False
    object_[0][object_[1]] = names.pop(0)
    return True


@routine("SetSysData")
def set_system_data(task: Task, sourceobject_: list[Any], objectname_: str | None = None) -> None:
    """Make a tool or a work object the one that CRobT and the like take by default."""
    name = "tool" if len(sourceobject_) == _TOOL_PARTS else "wobj"
    task.settings[name] = copied(sourceobject_)


_TOOL_PARTS = 3


# Errors


@routine("ErrLog")
def log_error(task: Task, errorid_: float, w_: Any = None, i_: Any = None, **arguments: Any) -> None:
    """Write an event with five texts into the log."""
    word = "warning" if w_ else "information" if i_ else "error"
    texts = [str(arguments[key]) for key in sorted(arguments) if arguments[key]]
    task.pendant.write(f"{word} {errorid_:g}: {' '.join(texts)}")
    task.pass_time(0.0)


@routine("ErrRaise")
def raise_error(task: Task, errorname_: str, errorid_: float, **arguments: Any) -> None:
    """Write an event into the log, and raise an error of the program's own."""
    log_error(task, errorid_, **arguments)
    value = task.value(errorname_)
    raise RapidError(float(value), f"error '{errorname_}' was raised")


@routine("RemainingRetries")
def remaining_retries(task: Task) -> float:
    """Return how often RETRY may still be used in this error handler."""
    return task.remaining_retries


@routine("ResetRetryCount")
def reset_retries(task: Task) -> None:
    """Count the uses of RETRY anew."""
    task.resets_retries = True


# Units of signals


@routine("IOUnitState")
def unit_state(task: Task, unitname_: str, phys_: Any = None, logic_: Any = None) -> float:
    """Return the state of a unit of signals: running, unless the program has disabled it."""
    is_off = unitname_.lower() in task.settings.get("disabled", ())
    if phys_:
        return 7.0 if is_off else 8.0
    if logic_:
        return 5.0 if is_off else 6.0
    return 3.0 if is_off else _RUNNING


@routine("IODisable")
def disable_unit(task: Task, unitname_: str, maxtime_: float) -> None:
    """Disable a unit of signals."""
    task.settings.setdefault("disabled", set()).add(unitname_.lower())


@routine("IOEnable")
def enable_unit(task: Task, unitname_: str, maxtime_: float) -> None:
    """Enable a unit of signals."""
    task.settings.setdefault("disabled", set()).discard(unitname_.lower())


@routine("GetSignalOrigin")
def signal_origin(task: Task, signal_: Any, signalname_: Any) -> float:
    """Return whether a signal is configured or an alias, and its name."""
    origin, name = task.signals.origin(signal_)
    signalname_[0][signalname_[1]] = name
    return {"alias": _ORIGIN_ALIAS, "board": _ORIGIN_CONFIGURED}.get(origin, _ORIGIN_NONE)


@routine("AliasIOReset")
def reset_alias(task: Task, signal_: Any) -> None:
    """Disconnect a signal of the program's own."""
    task.signals.remove_alias(str(signal_))


@routine("Load", "StartLoad", "UnLoad", "EraseModule", "WaitLoad")
def refuse_loading(task: Task, **rest: Any) -> None:
    """Stop: all modules of a task are loaded before it runs."""
    raise FatalError("modules are not loaded or erased while a program runs; name all of them in its .pgf or folder")
