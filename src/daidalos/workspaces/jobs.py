"""Job objects of Windows: processes that end when the process that holds the job ends, however that happens.

The structures and constants are those of ``winnt.h``.
"""

from __future__ import annotations

import ctypes
from contextlib import suppress
from typing import Any

_EXTENDED_LIMIT_INFORMATION = 9
_BREAKAWAY_OK, _KILL_ON_JOB_CLOSE = 0x0800, 0x2000
_PROCESS_TERMINATE, _PROCESS_SET_QUOTA = 0x0001, 0x0100


class BasicLimits(ctypes.Structure):
    """``JOBOBJECT_BASIC_LIMIT_INFORMATION``."""

    _fields_ = (
        ("per_process_user_time_limit", ctypes.c_int64),
        ("per_job_user_time_limit", ctypes.c_int64),
        ("limit_flags", ctypes.c_uint32),
        ("minimum_working_set_size", ctypes.c_size_t),
        ("maximum_working_set_size", ctypes.c_size_t),
        ("active_process_limit", ctypes.c_uint32),
        ("affinity", ctypes.c_size_t),
        ("priority_class", ctypes.c_uint32),
        ("scheduling_class", ctypes.c_uint32),
    )


class ExtendedLimits(ctypes.Structure):
    """``JOBOBJECT_EXTENDED_LIMIT_INFORMATION``."""

    _fields_ = (
        ("basic", BasicLimits),
        ("io_counters", ctypes.c_uint64 * 6),
        ("process_memory_limit", ctypes.c_size_t),
        ("job_memory_limit", ctypes.c_size_t),
        ("peak_process_memory_used", ctypes.c_size_t),
        ("peak_job_memory_used", ctypes.c_size_t),
    )


class Job:
    """A job that ends its processes, and what they started, when its last handle is closed: with this process.

    Parameters
    ----------
    kernel
        The library ``kernel32``; the system's where None.

    Raises
    ------
    OSError
        When the system refuses to make a job.
    """

    def __init__(self, kernel: Any = None) -> None:
        self._kernel = kernel if kernel is not None else _kernel32()
        self._handle = self._kernel.CreateJobObjectW(None, None)
        if not self._handle:
            raise OSError("no job object could be made")
        limits = ExtendedLimits()
        # Who asks to leave the job when it is started, such as a daemon, may.
        limits.basic.limit_flags = _KILL_ON_JOB_CLOSE | _BREAKAWAY_OK
        size = ctypes.sizeof(limits)
        if not self._kernel.SetInformationJobObject(
            self._handle, _EXTENDED_LIMIT_INFORMATION, ctypes.byref(limits), size
        ):
            self._kernel.CloseHandle(self._handle)
            raise OSError("a job object takes no limits")

    def add(self, process_id: int) -> None:
        """Add a process.

        Raises
        ------
        OSError
            When it has ended, or belongs to another user.
        """
        process = self._kernel.OpenProcess(_PROCESS_TERMINATE | _PROCESS_SET_QUOTA, False, process_id)
        if not process:
            raise OSError(f"process {process_id} cannot be opened")
        try:
            if not self._kernel.AssignProcessToJobObject(self._handle, process):
                raise OSError(f"process {process_id} cannot be added to a job")
        finally:
            self._kernel.CloseHandle(process)


class JobGuard:
    """Watch over processes by a job, with the functions of `OrphanGuard`."""

    def __init__(self, kernel: Any = None) -> None:
        self._kernel = kernel
        self._job: Job | None = None

    def watch(self, target: int) -> None:
        """Watch a process and what it starts, or those of the group of a negative process id."""
        with suppress(OSError):  # without a job, nothing watches
            if self._job is None:
                self._job = Job(self._kernel)
            self._job.add(abs(target))

    def release(self, target: int) -> None:
        """Do nothing: a process that has ended has left the job."""


def _kernel32() -> Any:
    kernel: Any = ctypes.WinDLL("kernel32", use_last_error=True)  # type: ignore[attr-defined, unused-ignore]
    handle, word, flag = ctypes.c_void_p, ctypes.c_uint32, ctypes.c_int
    for name, result, arguments in (
        ("CreateJobObjectW", handle, (ctypes.c_void_p, ctypes.c_wchar_p)),
        ("SetInformationJobObject", flag, (handle, flag, ctypes.c_void_p, word)),
        ("OpenProcess", handle, (word, flag, word)),
        ("AssignProcessToJobObject", flag, (handle, handle)),
        ("CloseHandle", flag, (handle,)),
    ):
        function = getattr(kernel, name)
        function.restype, function.argtypes = result, arguments
    return kernel
