"""A program at a pendant: started, stopped on the path, stepped, its positions modified; the arm jogged meanwhile."""

from __future__ import annotations

import queue
import threading
import time
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from daidalos.common.suggestions import hint
from daidalos.industry.motion.orientations import Array
from daidalos.industry.rapid import tree
from daidalos.industry.rapid.debugging.debugger import Debugger
from daidalos.industry.rapid.parsing import parse
from daidalos.industry.rapid.runtime.arm_robot import ArmRobot
from daidalos.industry.rapid.runtime.errors import ProgramEnd, RapidError
from daidalos.industry.rapid.runtime.task import Task
from daidalos.industry.rapid.runtime.values import text_of
from daidalos.industry.rapid.sources import Source, write_source

SCREEN_LINES = 12
_BRAKING_STEP = 0.01
_DIGITS = 9


class SessionError(ValueError):
    """Command that cannot be carried out now; the message says why."""


class ScreenPendant:
    """Operator's screen: the latest lines, and a question until it is answered."""

    def __init__(self) -> None:
        self.lines: list[str] = []
        self.question = ""
        self.choices: tuple[str, ...] = ()
        self.answers: queue.Queue[str | None] = queue.Queue()

    def write(self, text: str) -> None:
        """Show a line."""
        self.lines = [*self.lines, text][-SCREEN_LINES:]

    def erase(self) -> None:
        """Clear the screen."""
        self.lines = []

    def ask(self, text: str, choices: Sequence[str] = ()) -> str:
        """Return what the operator answers."""
        self.question, self.choices = text, tuple(choices)
        answer = self.answers.get()
        self.question, self.choices = "", ()
        if answer is None:
            raise RapidError("ERR_TP_NO_CLIENT", "the program was ended while it asked")
        return answer


class Session:
    """A task that an operator runs.

    Parameters
    ----------
    task
        The task; its robot is an arm, and its pendant is replaced.
    procedure
        The procedure that it begins with.
    """

    def __init__(self, task: Task, procedure: str = "main") -> None:
        assert isinstance(task.robot, ArmRobot)
        self.task, self.robot, self.procedure = task, task.robot, procedure
        self.screen = ScreenPendant()
        task.pendant = self.screen
        self.report = ""
        self.state = "idle"
        self.motion_line = 0
        """Line of the movement that the arm is in, 0 where it rests."""
        self.texts = {one.source.file: one.source for one in task.modules}
        self.modified: set[str] = set()
        self._debugger = Debugger(task, self._on_stop)
        self._thread: threading.Thread | None = None
        self._goes_on = threading.Event()
        self._wants_stop = False
        self._is_ending = False
        self.is_interrupted = False
        """Whether the arm is stopped within a movement."""
        self.joints = self.robot.planner.joints.copy()
        """Present angles (6,) [rad]."""
        self.robot.watch(self._look)

    @property
    def place(self) -> tuple[str, int]:
        """Return the file and the line of the program pointer; line 0 where there is none."""
        return self._debugger.place

    # Commands

    def start(self, steps: bool = False) -> None:
        """Run the program, from its beginning or from where it was stopped; or carry out its next instruction.

        Raises
        ------
        SessionError
            Where it runs already.
        """
        if self.state in ("running", "asking"):
            raise SessionError("the program runs already")
        self.report = ""
        self._wants_stop = False
        if self._thread is None or not self._thread.is_alive():
            self._debugger.run(stops_on_entry=steps)
            self._is_ending = False
            self.task.reset()
            self.state = "running"
            self._thread = threading.Thread(target=self._run, daemon=True)
            self._thread.start()
            return
        self.state = "running"
        if self.is_interrupted:
            if steps:
                self._debugger.pause()
            self._goes_on.set()
        else:
            self._debugger.resume("over" if steps else "continue")

    def stop(self) -> None:
        """Stop the program, and the arm on its path."""
        if self.state == "running":
            self._wants_stop = True
            self._debugger.pause()

    def to_main(self) -> None:
        """End the program, so that the next start is from its beginning; the rest of a path is forgotten."""
        self._is_ending = True
        self.screen.answers.put(None) if self.screen.question else None
        self._debugger.resume("end")
        self._goes_on.set()
        if self._thread is not None:
            self._thread.join(5.0)
        self.robot.clear()
        self.robot.resume()
        self.state, self.report, self.is_interrupted = "idle", "", False
        self.motion_line, self._debugger.place = 0, ("", 0)

    def answer(self, text: str) -> None:
        """Answer what the program asks.

        Raises
        ------
        SessionError
            Where it asks nothing.
        """
        if not self.screen.question:
            raise SessionError("the program asks nothing")
        self.screen.answers.put(text)

    def check_jogging(self) -> None:
        """Check that the arm may be jogged.

        Raises
        ------
        SessionError
            While the program runs, or the arm is stopped within a movement.
        """
        if self.state in ("running", "asking"):
            raise SessionError("the program runs; stop it before jogging")
        if self.is_interrupted:
            raise SessionError("a movement is interrupted; start goes on, and main forgets it")

    def move(self, joints: Array) -> None:
        """Put the arm to other angles (6,) [rad], by a small step.

        Raises
        ------
        SessionError
            As `check_jogging`.
        """
        self.check_jogging()
        self.robot.planner.joints = joints
        self.joints = joints

    def modify(self, name: str, tool: list[object], wobj: list[object]) -> None:
        """Store where the arm is in a robtarget or jointtarget, in memory: `save` writes the module.

        Raises
        ------
        SessionError
            While the program runs, or where there is no such position that is written as a value.
        """
        if self.state in ("running", "asking"):
            raise SessionError("the program runs; stop it before modifying positions")
        for file, source in self.texts.items():
            node = next((one for one in _positions(source) if one.name.key == name.lower()), None)
            if node is None:
                continue
            assert node.value is not None
            present = self.robot.jointtarget()
            value = self.robot.robtarget(tool, wobj) if node.type.key == "robtarget" else present
            text = f"{source.text[: node.value.start]}{text_of(value, _DIGITS)}{source.text[node.end - 1 :]}"
            self.texts[file] = Source(file, text, source.encoding)
            self.modified.add(file)
            self.task.set_value(name, value)
            self.report = f"{node.name.text} is modified; save writes it"
            return
        raise SessionError(f"there is no position '{name}'{hint(name, self.positions())}")

    def save(self) -> None:
        """Write the modules whose positions were modified."""
        for file in sorted(self.modified):
            write_source(Path(file), self.texts[file].text, self.texts[file].encoding)
        self.report = f"saved {', '.join(sorted(self.modified))}" if self.modified else "nothing was modified"
        self.modified.clear()

    def positions(self) -> list[str]:
        """Return the names of the positions that can be modified."""
        return [one.name.text for source in self.texts.values() for one in _positions(source)]

    def close(self) -> None:
        """End the program."""
        self.to_main()

    # In the thread of the program

    def _run(self) -> None:
        outcome = self.task.run(self.procedure)
        self._take_joints()
        self.motion_line = 0
        if outcome.reason == "error":
            self.state, self.report = "error", outcome.message
            self.robot.clear()
        else:
            self.state = "idle"
            self.report = "" if self._is_ending else f"{self.procedure} ended after {outcome.time:.3f} s"
        self.robot.resume()

    def _on_stop(self, _reason: str, text: str) -> None:
        self.task.wait_for_robot(self.robot.remaining)
        self._take_joints()
        call = self._debugger.top()
        self._debugger.place = (call.file, call.line)
        self.motion_line, self.report, self.state = 0, text, "stopped"
        self._wants_stop = False

    def _look(self) -> None:
        """Stop the arm on its path where that is wanted, until the operator goes on."""
        planner = self.robot.planner
        self.motion_line = int(planner.label_at(np.array([planner.now]))[0].rpartition(":")[2] or 0)
        self._take_joints()
        if not self._wants_stop:
            return
        self._wants_stop = False
        left = self.robot.stop()
        while left > 0.0:
            step = min(left, _BRAKING_STEP)
            time.sleep(step)
            self.robot.advance(step)
            self._take_joints()
            left -= step
        self.is_interrupted, self.state = True, "stopped"
        self._debugger.unpause()
        self._goes_on.clear()
        self._goes_on.wait()
        self.is_interrupted = False
        if self._is_ending:
            raise ProgramEnd("main")
        self.robot.resume()

    def _take_joints(self) -> None:
        planner = self.robot.planner
        self.joints = planner.joints_at(np.array([planner.now]))[0]


def _positions(source: Source) -> list[tree.Data]:
    parsed = parse(source)
    return [
        one
        for module in parsed.tree.modules
        for one in module.items
        if isinstance(one, tree.Data)
        and one.type.key in ("robtarget", "jointtarget")
        and not one.dimensions
        and isinstance(one.value, tree.Literals)
    ]
