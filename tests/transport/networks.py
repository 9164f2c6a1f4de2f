"""Machines made of network namespaces, joined by a bridge; needs the right to make them."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import uuid
from types import TracebackType
from typing import Self

import pytest


def skip_unless_permitted() -> None:
    """Skip the test, with the reason, where namespaces cannot be made."""
    if not sys.platform.startswith("linux"):
        pytest.skip("network namespaces are Linux's")
    if shutil.which("ip") is None:
        pytest.skip("there is no ip command (iproute2)")
    name = f"dd{uuid.uuid4().hex[:6]}"
    tried = subprocess.run(["ip", "netns", "add", name], capture_output=True, text=True)
    if tried.returncode:
        pytest.skip(f"no network namespaces here: {tried.stderr.strip() or 'not permitted'}")
    subprocess.run(["ip", "netns", "delete", name], check=True)


class Network:
    """Some machines on one wire, ``10.77.0.1`` and up; taken down at the end.

    Parameters
    ----------
    count
        How many machines.
    """

    def __init__(self, count: int) -> None:
        self._mark = f"d{uuid.uuid4().hex[:5]}"
        self._hub = f"{self._mark}h"
        self.machines = [f"{self._mark}{number}" for number in range(count)]

    def __enter__(self) -> Self:
        try:
            self._build()
        except BaseException:
            self._remove()
            raise
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._remove()

    def _build(self) -> None:
        _ip("netns", "add", self._hub)
        _ip("-n", self._hub, "link", "add", "bridge", "type", "bridge", "mcast_snooping", "0")
        _ip("-n", self._hub, "link", "set", "bridge", "up")
        for number, machine in enumerate(self.machines):
            _ip("netns", "add", machine)
            _ip("-n", self._hub, "link", "add", f"to{number}", "type", "veth", "peer", "eth0", "netns", machine)
            _ip("-n", self._hub, "link", "set", f"to{number}", "master", "bridge", "up")
            _ip("-n", machine, "address", "add", f"{self.address(number)}/24", "dev", "eth0")
            _ip("-n", machine, "link", "set", "lo", "up")
            _ip("-n", machine, "link", "set", "eth0", "up")
            _ip("-n", machine, "route", "add", "default", "dev", "eth0")

    def _remove(self) -> None:
        for name in (*self.machines, self._hub):
            subprocess.run(["ip", "netns", "delete", name], capture_output=True)

    def address(self, number: int) -> str:
        """Return a machine's address."""
        return f"10.77.0.{number + 1}"

    def on(self, number: int) -> tuple[str, ...]:
        """Return what a command on that machine begins with."""
        return ("ip", "netns", "exec", self.machines[number])

    def cut(self, number: int) -> None:
        """Pull a machine's cable, at the other end: the machine itself notices nothing."""
        _ip("-n", self._hub, "link", "set", f"to{number}", "nomaster")

    def mend(self, number: int) -> None:
        """Put the cable back."""
        _ip("-n", self._hub, "link", "set", f"to{number}", "master", "bridge")


def _ip(*words: str) -> None:
    done = subprocess.run(["ip", *words], capture_output=True, text=True, env=os.environ)
    if done.returncode:
        raise OSError(f"ip {' '.join(words)}: {done.stderr.strip()}")
