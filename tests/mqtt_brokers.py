"""Mosquitto, as a broker of tests, and free ports for brokers."""

from __future__ import annotations

import shutil
import socket
import subprocess
from pathlib import Path

import pytest


def free_port() -> int:
    """Return a TCP port that is free now."""
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return int(one.getsockname()[1])


class mosquitto:
    """Mosquitto within a ``with`` block; the test is skipped where it is not installed.

    Parameters
    ----------
    port : int
    folder : Path
        For its configuration.
    lines : str
        Of the configuration, beside the port.
    """

    def __init__(self, port: int, folder: Path, lines: str = "") -> None:
        program = shutil.which("mosquitto") or shutil.which("mosquitto", path="/usr/sbin")
        if not program:
            pytest.skip("there is no mosquitto")
        file = folder / "mosquitto.conf"
        file.write_text(f"user root\nlistener {port} 127.0.0.1\n{lines or 'allow_anonymous true'}\n")
        self._command = [program, "-c", str(file)]

    def __enter__(self) -> mosquitto:
        self._process = subprocess.Popen(self._command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        assert self._process.stderr is not None
        for line in self._process.stderr:
            if "running" in line:
                return self
        raise AssertionError("mosquitto did not start")

    def __exit__(self, *error: object) -> None:
        self._process.terminate()
        self._process.communicate()
