"""Processes found by name, action or arguments."""

from __future__ import annotations

from typing import Any

from launch.actions import ExecuteProcess

#: For `cmd_args`: only processes without arguments.
NO_CMD_ARGS = object()


class NoMatchingProcessException(Exception):
    """No known process is the one that was asked for."""


def resolveProcesses(
    info_obj: Any,
    *,
    process: ExecuteProcess | str | None = None,
    cmd_args: Any = None,
    strict_proc_matching: bool = True,
) -> list[ExecuteProcess]:
    """Return the actions of processes that fit a description.

    Parameters
    ----------
    info_obj
        An `IoHandler` or a `ProcInfoHandler`, which knows the processes.
    process
        The action, or a part of the process's name; None for all processes.
    cmd_args
        A text that is among the arguments, or NO_CMD_ARGS for no arguments at all; None for any.
    strict_proc_matching
        Whether several processes that fit a name are an error.

    Raises
    ------
    NoMatchingProcessException
        If there is none.
    LookupError
        If there are several, but only one may be.
    """
    known = list(info_obj.processes())
    if process is None:
        found = known
    elif isinstance(process, str):
        found = [action for action in known if process in process_details(action)["name"]]
    elif isinstance(process, ExecuteProcess):
        found = [action for action in known if action is process]
    else:
        raise TypeError(f"a process is given by its name or its action, but this is {process!r}")
    found = [action for action in found if _has_arguments(action, cmd_args)]
    if not found and not (process is None and cmd_args is None):
        names = ", ".join(process_details(action)["name"] for action in known) or "none"
        raise NoMatchingProcessException(
            f"Did not find any process matching name '{process}' and args '{cmd_args}'. Procs: {names}"
        )
    if isinstance(process, str) and strict_proc_matching and len(found) > 1:
        names = ", ".join(process_details(action)["name"] for action in found)
        raise LookupError(f"Found multiple processes matching name '{process}' and cmd_args '{cmd_args}': {names}")
    return found


def process_details(action: ExecuteProcess) -> dict[str, Any]:
    """Return the details of an action's process.

    Parameters
    ----------
    action
        The action.

    Raises
    ------
    RuntimeError
        Before the process is started.
    """
    details = action.process_details
    if details is None:
        raise RuntimeError(f"the process of {action.describe()} was not started yet")
    return details


def _has_arguments(action: ExecuteProcess, cmd_args: Any) -> bool:
    arguments = process_details(action)["cmd"][1:]
    if cmd_args is None:
        return True
    if cmd_args is NO_CMD_ARGS:
        return not arguments
    return cmd_args in " ".join(arguments) if isinstance(cmd_args, str) else False
