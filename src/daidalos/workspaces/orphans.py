"""End of started processes when the process that started them is killed and can not end them itself.

A small shell waits at a pipe that only this process holds open. When this process ends, in whatever way, the pipe
closes, and the shell stops the processes that are still watched: by SIGINT, then SIGTERM, then SIGKILL. It works for
programs of any kind and on every POSIX system. (The signal at the parent's death that Linux offers is sent when the
starting thread ends, and reaches neither what a program started itself nor a program that changed its user.) On
Windows a job object ends the processes at once, as there is no SIGINT for a process without a console of its own.
"""

from __future__ import annotations

import os
import subprocess
import threading
from contextlib import suppress
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from daidalos.workspaces.jobs import JobGuard

_TERM_TIMEOUT_S = 5
"""Seconds after SIGINT, and after SIGTERM, before the next harder signal, as in a launch."""

_SCRIPT = """
trap '' INT HUP QUIT PIPE
watched=' '
while read -r change target; do
  case $change in
    +) watched="$watched$target " ;;
    -) case $watched in *" $target "*) watched="${watched%%" $target "*} ${watched#*" $target "}" ;; esac ;;
  esac
done
for signal in INT TERM KILL; do
  for target in $watched; do kill -s $signal -- "$target" 2>/dev/null; done
  count=0
  while [ $count -lt $1 ]; do
    left=
    for target in $watched; do kill -0 -- "$target" 2>/dev/null && left=1; done
    [ "$left" ] || exit 0
    sleep 0.1
    count=$((count + 1))
  done
done
"""


class OrphanGuard:
    """Watch over processes that must end with this one."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._shell: subprocess.Popen[bytes] | None = None
        self._owner = 0

    def watch(self, target: int) -> None:
        """Watch a process, or the group of a negative process id, until `release`."""
        self._send("+", target)

    def release(self, target: int) -> None:
        """End the watch over a process or group that has ended; call it before its id can be used again."""
        self._send("-", target)

    def _send(self, change: str, target: int) -> None:
        with self._lock, suppress(OSError):  # without a shell, nothing watches
            pipe = self._running().stdin
            assert pipe is not None
            pipe.write(f"{change} {target}\n".encode())

    def _running(self) -> subprocess.Popen[bytes]:
        """Return the shell, which belongs to one process: a fork starts its own."""
        if self._shell is None or self._owner != os.getpid():
            self._owner = os.getpid()
            self._shell = subprocess.Popen(
                ["/bin/sh", "-c", _SCRIPT, "orphans", str(_TERM_TIMEOUT_S * 10)],
                bufsize=0,
                stdin=subprocess.PIPE,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                cwd="/",
                start_new_session=True,  # Ctrl-C in a terminal goes to everyone of its session
            )
        return self._shell


def _guard() -> OrphanGuard | JobGuard:
    if os.name == "posix":
        return OrphanGuard()
    from daidalos.workspaces.jobs import JobGuard

    return JobGuard()


guard = _guard()
"""The guard of this process."""
