"""Assertions about exit codes."""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import Any

from launch.events.process import ProcessExited

from ..util.proc_lookup import resolveProcesses

EXIT_OK = 0
EXIT_SIGINT = 130
EXIT_SIGQUIT = 131
EXIT_SIGKILL = 137
EXIT_SIGSEGV = 139
# Windows ends processes with this code.
EXIT_FORCED = 1 if os.name == "nt" else EXIT_SIGKILL


def assertExitCodes(
    proc_info: Any,
    allowable_exit_codes: Iterable[int] = (EXIT_OK,),
    process: Any = None,
    cmd_args: Any = None,
    *,
    strict_proc_matching: bool = True,
) -> None:
    """Assert that processes ended with one of some exit codes.

    Parameters
    ----------
    proc_info
        Knows what became of the processes.
    allowable_exit_codes
        The codes. A process that a signal ended has both the shell's code (128 plus the signal's number) and
        that of Python (minus the number).
    process, cmd_args, strict_proc_matching
        Which processes, as for `launch_testing.util.resolveProcesses`.

    Raises
    ------
    AssertionError
        If one did not end, or with another code.
    """
    allowed = [int(code) for code in allowable_exit_codes]
    for action in resolveProcesses(
        proc_info, process=process, cmd_args=cmd_args, strict_proc_matching=strict_proc_matching
    ):
        info = proc_info[action]
        assert isinstance(info, ProcessExited), f"Proc {info.process_name} has not exited"
        code = info.returncode
        accepted = code in allowed or (code < 0 and 128 - code in allowed)
        assert accepted, f"Proc {info.process_name} exited with code {code}, expected one of {allowed}"
