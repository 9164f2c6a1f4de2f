"""Questions about processes, for the events that ask something of them."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ...actions.execute_process import ExecuteProcess


def matches_pid(pid: int) -> Callable[[ExecuteProcess], bool]:
    """Return a function that returns whether an action's process has this id."""

    def matcher(action: ExecuteProcess) -> bool:
        details = action.process_details
        return details is not None and details.get("pid") == pid

    return matcher


def matches_name(name: str) -> Callable[[ExecuteProcess], bool]:
    """Return a function that returns whether an action's process has this name in the launch."""

    def matcher(action: ExecuteProcess) -> bool:
        details = action.process_details
        return details is not None and details["name"] == name

    return matcher


def matches_executable(executable: str) -> Callable[[ExecuteProcess], bool]:
    """Return a function that returns whether an action's command line begins with this executable."""

    def matcher(action: ExecuteProcess) -> bool:
        details = action.process_details
        return details is not None and details["cmd"][0] == executable

    return matcher
