"""The base of the events that come from a process."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...event import Event

if TYPE_CHECKING:
    from ...actions.execute_process import ExecuteProcess


class RunningProcessEvent(Event):
    """Event of a process.

    Parameters
    ----------
    action
        The action that runs the process.
    name
        The process's name in this launch, `<executable>-<number>`.
    cmd
        Its command line.
    cwd
        Its working directory, None for that of the launch.
    env
        Its environment, None for that of the launch.
    pid
        Its process id.
    """

    name = "launch.events.process.RunningProcessEvent"

    def __init__(
        self,
        *,
        action: ExecuteProcess,
        name: str,
        cmd: list[str],
        cwd: str | None,
        env: dict[str, str] | None,
        pid: int,
    ) -> None:
        self.__action = action
        self.__process_name = name
        self.__cmd = cmd
        self.__cwd = cwd
        self.__env = env
        self.__pid = pid

    @property
    def action(self) -> ExecuteProcess:
        """The action that runs the process."""
        return self.__action

    @property
    def execute_process_action(self) -> ExecuteProcess:
        """The action that runs the process; an older name of `action`."""
        return self.__action

    @property
    def process_name(self) -> str:
        """The process's name in this launch."""
        return self.__process_name

    @property
    def cmd(self) -> list[str]:
        """The process's command line."""
        return self.__cmd

    @property
    def cwd(self) -> str | None:
        """The process's working directory."""
        return self.__cwd

    @property
    def env(self) -> dict[str, str] | None:
        """The process's environment."""
        return self.__env

    @property
    def pid(self) -> int:
        """The process id."""
        return self.__pid
