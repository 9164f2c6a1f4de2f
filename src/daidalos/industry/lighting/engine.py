"""Thread that sends the frames of a show to its outputs, and takes commands from any other thread."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterable
from typing import TypeVar

from daidalos.industry.lighting.head import Head
from daidalos.industry.lighting.outputs import Output
from daidalos.industry.lighting.show import Show

T = TypeVar("T")


class Engine:
    """Sender of a show; as a context manager it sends from the beginning to the end, which is a blackout.

    Parameters
    ----------
    show : Show
    outputs : iterable of Output
    report : callable, optional
        Called with a line when an output fails, and when it works again.
    """

    def __init__(self, show: Show, outputs: Iterable[Output], report: Callable[[str], None] | None = None) -> None:
        self._show = show
        self._outputs = list(outputs)
        self._report = report or (lambda line: None)
        self._condition = threading.Condition()
        self._is_ending = False
        self._failed: dict[int, str] = {}
        self._thread = threading.Thread(target=self._run, name="lighting", daemon=True)
        self.frames_sent = 0

    def __enter__(self) -> Engine:
        self._thread.start()
        return self

    def __exit__(self, *error: object) -> None:
        self.close()

    def command(self, name: str, action: Callable[[Head], T]) -> T:
        """Run an action on a head, alone, and send its effect as soon as the frame rate allows.

        Raises
        ------
        UserError
            When there is no such head, and whatever the action raises.
        """
        with self._condition:
            head = self._show.head(name)
            result = action(head)
            self._show.mark(head)
            self._condition.notify()
            return result

    def look_at(self, name: str, question: Callable[[Head], T]) -> T:
        """Return the answer to a question about a head, asked while nothing changes it."""
        with self._condition:
            return question(self._show.head(name))

    def blackout(self) -> None:
        """Switch all heads dark."""
        with self._condition:
            self._show.blackout()
            self._condition.notify()

    def close(self) -> None:
        """Send a blackout and end the streams; what is called again does nothing."""
        with self._condition:
            if self._is_ending:
                return
            self._is_ending = True
            self._condition.notify()
        if self._thread.is_alive():
            self._thread.join()
        self._show.blackout()
        for number, data in self._show.frames(float("inf")):
            self._send(number, data)
        for output in self._outputs:
            output.close()

    def _run(self) -> None:
        while True:
            with self._condition:
                while not self._is_ending and (rest := self._show.next_due() - time.monotonic()) > 0.0:
                    self._condition.wait(rest)
                if self._is_ending:
                    return
                frames = self._show.frames(time.monotonic())
            for number, data in frames:
                self._send(number, data)
            self._maintain()

    def _send(self, number: int, data: bytes) -> None:
        for index, output in enumerate(self._outputs):
            if output.universes is not None and number not in output.universes:
                continue
            try:
                output.send(number, data)
            except BlockingIOError:
                continue  # the network is slower than the frames; the next one is newer
            except OSError as error:
                self._fail(index, str(error))
            else:
                self.frames_sent += 1
                if self._failed.pop(index, None) is not None:
                    self._report("the output works again")

    def _fail(self, index: int, problem: str) -> None:
        if self._failed.get(index) != problem:
            self._failed[index] = problem
            self._report(f"cannot send: {problem}")

    def _maintain(self) -> None:
        now = time.monotonic()
        for output in self._outputs:
            output.maintain(now, output.universes or self._show.universes)
