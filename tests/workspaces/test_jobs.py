"""Job objects: what the system is asked for, and on Windows what it does."""

from __future__ import annotations

import ctypes
import subprocess
import sys
from typing import Any

import psutil
import pytest

from daidalos.workspaces.jobs import BasicLimits, ExtendedLimits, Job, JobGuard

PARENT = """
import subprocess, sys, threading
from daidalos.workspaces.orphans import guard

script = "import threading\\nthreading.Event().wait()"
child = subprocess.Popen([sys.executable, "-S", "-c", script])
guard.watch(child.pid)
print(child.pid, flush=True)
threading.Event().wait()
"""


class Kernel:
    """The functions of ``kernel32`` that jobs use; it notes what is asked, and can refuse a function."""

    def __init__(self, refused: str = "") -> None:
        self.refused = refused
        self.open: list[int] = []
        self.flags = 0
        self.members: list[tuple[int, int]] = []

    def _handle(self, name: str) -> int:
        if name == self.refused:
            return 0
        self.open.append(len(self.open) + 100)
        return self.open[-1]

    def CreateJobObjectW(self, security: Any, name: Any) -> int:
        return self._handle("CreateJobObjectW")

    def SetInformationJobObject(self, job: int, kind: int, limits: Any, size: int) -> int:
        assert (kind, size) == (9, ctypes.sizeof(ExtendedLimits))
        self.flags = limits._obj.basic.limit_flags
        return int(self.refused != "SetInformationJobObject")

    def OpenProcess(self, access: int, inherits: bool, process_id: int) -> int:
        assert (access, inherits) == (0x0101, False)
        return self._handle("OpenProcess")

    def AssignProcessToJobObject(self, job: int, process: int) -> int:
        self.members.append((job, process))
        return int(self.refused != "AssignProcessToJobObject")

    def CloseHandle(self, handle: int) -> int:
        self.open.remove(handle)
        return 1


@pytest.mark.skipif(ctypes.sizeof(ctypes.c_void_p) != 8, reason="the sizes are those of 64 bits")
def test_the_structures_are_as_large_as_those_of_the_system():
    assert ctypes.sizeof(BasicLimits) == 64
    assert ctypes.sizeof(ExtendedLimits) == 144


def test_processes_are_added_to_one_job_that_ends_them_with_its_last_handle():
    kernel = Kernel()
    guard = JobGuard(kernel)
    for target in (10, -11):
        guard.watch(target)
    guard.release(10)
    assert kernel.flags == 0x2800
    assert [job for job, _ in kernel.members] == [100, 100]
    assert kernel.open == [100]  # the job alone: handles of processes are closed again


@pytest.mark.parametrize("refused", ["CreateJobObjectW", "SetInformationJobObject"])
def test_a_job_that_the_system_refuses_leaves_no_handle(refused):
    kernel = Kernel(refused)
    with pytest.raises(OSError, match="job object"):
        Job(kernel)
    assert kernel.open == []
    JobGuard(kernel).watch(10)


@pytest.mark.parametrize("refused", ["OpenProcess", "AssignProcessToJobObject"])
def test_a_process_that_cannot_be_added_is_named_and_only_then_left_alone(refused):
    kernel = Kernel(refused)
    with pytest.raises(OSError, match="process 10"):
        Job(kernel).add(10)
    assert kernel.open == [100]
    JobGuard(Kernel(refused)).watch(10)


@pytest.mark.skipif(sys.platform != "win32", reason="job objects are Windows'")
def test_a_killed_parent_takes_its_children_with_it():
    parent = subprocess.Popen([sys.executable, "-c", PARENT], stdout=subprocess.PIPE, text=True)
    assert parent.stdout is not None
    child = psutil.Process(int(parent.stdout.readline()))
    parent.kill()
    child.wait(60)
    parent.wait()
