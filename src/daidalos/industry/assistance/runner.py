"""Runs of work sequences: each step is shown, waited for and timed."""

from __future__ import annotations

import csv
import queue
import threading
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from daidalos.common.pose3 import Vector
from daidalos.industry.assistance.device import Device, DeviceError
from daidalos.industry.assistance.sequence import AFTER, Confirmation, Sequence, Showing, Step

ABORTED = Confirmation("aborted")


@dataclass(frozen=True)
class TargetArrival:
    """Event that a topic which devices follow has a newer point."""

    topic: str


@dataclass(frozen=True)
class StepTime:
    """When a step began [s from the sequence's beginning], how long it took [s], and what ended it."""

    number: int
    name: str
    began: float
    seconds: float
    confirmed_by: str


class Runner:
    """Run of a sequence; `confirm`, `follow` and `abort` may be called from any thread.

    Parameters
    ----------
    sequence : Sequence
    devices : mapping of str to Device
    clock : callable
        Returns the time [s].
    announce : callable
        Called with the number from 1 and the step, before it is shown; with 0 and None at the end.
    report : callable
        Called with a line when a device fails; the sequence goes on without it.
    """

    def __init__(
        self,
        sequence: Sequence,
        devices: Mapping[str, Device],
        clock: Callable[[], float],
        announce: Callable[[int, Step | None], None],
        report: Callable[[str], None],
    ) -> None:
        self._sequence, self._devices, self._clock = sequence, devices, clock
        self._announce, self._report = announce, report
        self._events: queue.SimpleQueue[Confirmation | TargetArrival] = queue.SimpleQueue()
        self._lock = threading.Lock()
        self._arrived: dict[str, Vector] = {}
        self._targets: dict[str, Vector] = {}

    def confirm(self, event: Confirmation) -> None:
        """Pass on what has happened; it ends the step that waits for it."""
        self._events.put(event)

    def follow(self, topic: str, place: Vector) -> None:
        """Point the devices that follow a topic at its newest point [m]; of many that come at once, at the last."""
        with self._lock:
            is_first = topic not in self._arrived
            self._arrived[topic] = place
        if is_first:
            self._events.put(TargetArrival(topic))

    def abort(self) -> None:
        """End the run."""
        self._events.put(ABORTED)

    def run(self) -> list[StepTime]:
        """Lead through all steps and return their times; those of the steps before where it was aborted."""
        times: list[StepTime] = []
        start = self._clock()
        try:
            for number, step in enumerate(self._sequence.steps, 1):
                began = self._clock()
                self._discard_events()
                self._announce(number, step)
                self._show(step)
                if not self._wait(step, began):
                    break
                confirmed = step.confirmation
                by = f"{confirmed.kind} {confirmed.name}".strip()
                times.append(StepTime(number, step.name, began - start, self._clock() - began, by))
        finally:
            for name, device in self._devices.items():
                self._try(name, device.clear)
            self._announce(0, None)
        return times

    def _discard_events(self) -> None:
        """Forget confirmations of the step before, such as a button pressed twice."""
        while not self._events.empty():
            event = self._events.get()
            if isinstance(event, TargetArrival):
                self._take_target(event.topic)
            elif event is ABORTED:
                self._events.put(event)
                return

    def _show(self, step: Step) -> None:
        shown = {one.device for one in step.showings}
        for name, device in self._devices.items():
            if name not in shown:
                self._try(name, device.clear)
        for one in step.showings:
            self._carry_out(one)

    def _carry_out(self, showing: Showing) -> None:
        """Show a content; a device that follows a topic is dark until a point has come."""
        device = self._devices[showing.device]
        if showing.follow and showing.follow not in self._targets:
            self._try(showing.device, device.clear)
            return
        if showing.follow:
            showing = replace(showing, place=self._targets[showing.follow])
        self._try(showing.device, lambda: carry_out(device, showing))

    def _take_target(self, topic: str) -> None:
        with self._lock:
            self._targets[topic] = self._arrived.pop(topic)

    def _try(self, name: str, act: Callable[[], None]) -> None:
        try:
            act()
        except DeviceError as error:
            self._report(f"{name}: {error}")

    def _wait(self, step: Step, began: float) -> bool:
        """Wait for a step's confirmation; return whether it has come, False where the run was aborted."""
        wanted = step.confirmation
        while True:
            rest = began + wanted.seconds - self._clock() if wanted.kind == AFTER else None
            if rest is not None and rest <= 0.0:
                return True
            try:
                event = self._events.get(timeout=rest)
            except queue.Empty:
                continue
            if isinstance(event, TargetArrival):
                self._take_target(event.topic)
                for one in step.showings:
                    if one.follow == event.topic:
                        self._carry_out(one)
                continue
            if event is ABORTED:
                return False
            if event.kind == wanted.kind and event.name == wanted.name and wanted.payload in ("", event.payload):
                return True


def carry_out(device: Device, showing: Showing) -> None:
    """Show a content on a device, at its place where it has one.

    Raises
    ------
    DeviceError
        When the device cannot.
    """
    if showing.place is None:
        device.show(showing.content)
    else:
        device.point(showing.place, showing.content)


def write_times(path: Path, times: list[StepTime]) -> None:
    """Write times as CSV; a file that exists is not written over.

    Raises
    ------
    OSError
        When it exists, or cannot be written.
    """
    with path.open("x", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["step", "name", "began_s", "seconds", "confirmed_by"])
        for one in times:
            writer.writerow([one.number, one.name, f"{one.began:.3f}", f"{one.seconds:.3f}", one.confirmed_by])
