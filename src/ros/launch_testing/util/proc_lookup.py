"""Processes found by name, action or arguments."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from launch.actions import ExecuteLocal, ExecuteProcess
from launch.substitutions import TextSubstitution

#: For `cmd_args`: only processes without arguments.
NO_CMD_ARGS = object()


class NoMatchingProcessException(Exception):
    """No known process is the one that was asked for."""


def resolveProcesses(
    info_obj: Any,
    *,
    process: ExecuteLocal | str | None = None,
    cmd_args: Any = None,
    strict_proc_matching: bool = True,
) -> list[Any]:
    """Return the actions of processes that fit a description.

    Parameters
    ----------
    info_obj
        An `IoHandler` or a `ProcInfoHandler`, which knows the processes.
    process
        The action, or a part of the process's name; None for all processes.
    cmd_args
        Of processes found by their name only those that have this argument, or all of these arguments;
        NO_CMD_ARGS for those without arguments, None for any.
    strict_proc_matching
        Whether several processes that fit a name are an error.

    Raises
    ------
    NoMatchingProcessException
        If there is none.
    LookupError
        If there are several, but only one may be.
    TypeError
        If `process` is something else.
    """
    known: list[ExecuteProcess] = list(info_obj.processes())
    if process is None:
        if not known:
            raise NoMatchingProcessException("No data recorded for any process")
        return known
    if isinstance(process, ExecuteLocal):
        if process not in known:
            raise NoMatchingProcessException(f"No data recorded for the process {_command_line(process)}")
        return [action for action in known if action is process]
    if not isinstance(process, str):
        raise TypeError(f"a process is given by its name or its action, but this is {process!r}")
    wanted = [cmd_args] if isinstance(cmd_args, str) else cmd_args
    found = [
        action for action in known if process in process_details(action)["name"] and _has_arguments(action, wanted)
    ]
    if found and not (strict_proc_matching and len(found) > 1):
        return found
    described = f"name '{process}' and args '{wanted}'. Procs: {', '.join(sorted(map(_command_line, known))) or 'none'}"
    if found:
        raise LookupError(f"Found multiple processes matching {described}")
    raise NoMatchingProcessException(f"Did not find any processes matching {described}")


def process_details(action: ExecuteLocal) -> dict[str, Any]:
    """Return the details of an action's process.

    Parameters
    ----------
    action
        The action.

    Raises
    ------
    RuntimeError
        Before the action is executed.
    """
    details = action.process_details
    if details is None:
        raise RuntimeError(f"the process of {action.describe()} was not started yet")
    return details


def _has_arguments(action: ExecuteProcess, wanted: Iterable[str] | object | None) -> bool:
    arguments = process_details(action)["cmd"][1:]
    if wanted is NO_CMD_ARGS:
        return not arguments
    return not isinstance(wanted, Iterable) or all(argument in arguments for argument in wanted)


def _command_line(action: ExecuteLocal) -> str:
    """Return a process's name and arguments; before it is executed its command line, where that is plain text."""
    details = action.process_details
    if details is not None:
        return " ".join([details["name"], *details["cmd"][1:]])
    words = action.process_description.cmd
    if not all(isinstance(part, TextSubstitution) for word in words for part in word):
        return "Unknown - Process not launched yet"
    return " ".join("".join(part.text for part in word if isinstance(part, TextSubstitution)) for word in words)
