"""A controller with one task, which is started and stopped from outside while others look at its data and signals."""

from __future__ import annotations

import ctypes
import threading
from collections.abc import Callable
from typing import Any

from daidalos.industry.rapid.runtime.board import Board
from daidalos.industry.rapid.runtime.errors import ProgramEnd
from daidalos.industry.rapid.runtime.task import Outcome, Task

TASK = "T_ROB1"
UNIT = "ROB_1"

LOOK_S = 0.02
"""Robot time between two looks at whether the program is to stop, and between two positions of the robot [s]."""

_LOOKS = 20
_LOOKS_S = 0.05
"""How often, and how long each time [s], a program that is to stop is waited for before it is interrupted."""


class Refused(ValueError):
    """A request that the state of the controller does not allow."""


class VirtualController:
    """A controller whose program runs in a thread of its own.

    Parameters
    ----------
    make_task : callable
        Makes the task with the program anew; takes the function that lets real time pass with the robot's.
    pace : callable
        Waits for a span of robot time [s].
    """

    def __init__(
        self, make_task: Callable[[Callable[[float], None]], Task], pace: Callable[[float], None] | None = None
    ) -> None:
        self._make_task = make_task
        self._real_pace = pace or (lambda seconds: None)
        self._thread: threading.Thread | None = None
        self._may_run = threading.Event()
        self._is_ending = False
        self._is_paused = threading.Event()
        self._lock = threading.Lock()
        self.task = self._new_task()
        self.motors_on = True
        self.mode = "AUTO"
        self.speed_ratio = 100
        self.outcome: Outcome | None = None

    def _new_task(self) -> Task:
        task = self._make_task(self._pace)
        task.settings["is_live"] = True
        # A timer that runs nothing cuts long waits and movements into short pieces.
        number = task.interrupts.connect(lambda: None)
        timer = task.interrupts.find(([number], 0))
        timer.due, timer.period, timer.is_asleep = 0.0, LOOK_S, True
        return task

    @property
    def signals(self) -> Board:
        """Return the board of signals."""
        return self.task.signals

    @property
    def is_running(self) -> bool:
        """Return whether the program runs."""
        return self._may_run.is_set() and self._thread is not None and self._thread.is_alive()

    def start(self) -> None:
        """Start the program, or go on with it.

        Raises
        ------
        Refused
            Where the motors are off, or the controller is not in automatic mode.
        """
        with self._lock:
            if not self.motors_on:
                raise Refused("the motors are off")
            if self.mode != "AUTO":
                raise Refused("the controller is in manual mode")
            if self._thread is None or not self._thread.is_alive():
                if self.outcome is not None:
                    self._renew()
                self._is_ending = False
                self._thread = threading.Thread(target=self._run, daemon=True)
                self._may_run.set()
                self._thread.start()
            self._is_paused.clear()
            self._may_run.set()

    def stop(self) -> None:
        """Stop the program where it is; one that lets no time pass is interrupted, and ends."""
        with self._lock:
            if self._thread is None or not self._may_run.is_set():
                return
            self._is_paused.clear()
            self._may_run.clear()
            if not self._holds(lambda: self._is_paused.wait(_LOOKS_S)):
                self._interrupt()

    def reset(self) -> None:
        """Set the program pointer to main.

        Raises
        ------
        Refused
            While the program runs.
        """
        with self._lock:
            if self.is_running:
                raise Refused("the program runs")
            self._end_thread()
            self._renew()

    def close(self) -> None:
        """End the program."""
        with self._lock:
            self._end_thread()

    def _end_thread(self) -> None:
        if self._thread is not None:
            self._is_ending = True
            self._may_run.set()
            if not self._holds(lambda: False):
                self._interrupt()
        self._may_run.clear()
        self._thread = None

    def _holds(self, is_so: Callable[[], bool]) -> bool:
        """Wait until something is so or the program has ended; return False where it computes on without time."""
        looks = 0
        while looks < _LOOKS:
            if is_so() or self._thread is None:
                return True
            self._thread.join(_LOOKS_S)
            if not self._thread.is_alive():
                return True
            looks = 0 if self.task.is_waiting else looks + 1
        return False

    def _interrupt(self) -> None:
        """Interrupt a program that computes, as Ctrl-C does."""
        if self._thread is not None and self._thread.ident is not None:
            interrupt = ctypes.py_object(KeyboardInterrupt)
            ctypes.pythonapi.PyThreadState_SetAsyncExc(ctypes.c_ulong(self._thread.ident), interrupt)
            self._thread.join(_LOOKS * _LOOKS_S)

    def _renew(self) -> None:
        """Load the program anew; persistents and signals keep their values."""
        kept = {owned.symbol.name: value for owned, _, value in self.task.persistents()}
        signals = self.task.signals.values()
        self.task = self._new_task()
        for name, value in kept.items():
            self.task.set_value(name, value)
        for name, value in signals.items():
            self.task.signals.set(name, value)
        self.outcome = None

    def _run(self) -> None:
        try:
            self.outcome = self.task.run()
        except KeyboardInterrupt:
            self.outcome = Outcome("interrupted", "interrupted at its end", self.task.time)
        self._may_run.clear()
        self._is_paused.set()

    def _pace(self, seconds: float) -> None:
        if not self._may_run.is_set():
            self._is_paused.set()
            self._may_run.wait()
        if self._is_ending:
            raise ProgramEnd("EXIT")
        self._real_pace(seconds * 100.0 / max(self.speed_ratio, 1))

    def set_motors(self, is_on: bool) -> None:
        """Switch the motors; off, the program stops."""
        if not is_on:
            self.stop()
        self.motors_on = is_on

    def set_speed_ratio(self, percent: int) -> None:
        """Set the speed of programs [%].

        Raises
        ------
        Refused
            Where it is not from 0 to 100.
        """
        if not 0 <= percent <= 100:
            raise Refused(f"the speed ratio is {percent}, but must be from 0 to 100")
        self.speed_ratio = percent

    def joint_target(self) -> list[Any]:
        """Return the angles [deg] and external axes."""
        return self.task.robot.jointtarget()

    def robot_target(self, tool: list[Any], wobj: list[Any]) -> list[Any]:
        """Return where a tool is in a work object, in mm."""
        return self.task.robot.robtarget(tool, wobj)
