"""`rapid_pendant`: runs a program in RAPID on an arm, and jogs it; the studio's panel is its screen."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from control_msgs.msg import JointJog
from daidalos_msgs.msg import RapidPendant as State
from geometry_msgs.msg import Point, Pose, Quaternion, TwistStamped
from rclpy.node import Node
from scipy.spatial.transform import Rotation
from sensor_msgs.msg import JointState
from std_msgs.msg import String

from daidalos.common.parameters import Parameters, parameter
from daidalos.industry.motion.faults import MotionFault
from daidalos.industry.motion.jogging import FRAMES, Frame, axes_of, jog_axis, jog_tool
from daidalos.industry.motion.kinematics import forward
from daidalos.industry.motion.orientations import Array
from daidalos.industry.rapid.debugging.session import Session, SessionError
from daidalos.industry.rapid.runtime.arm_robot import ArmRobot, matrix_of
from daidalos.industry.rapid.runtime.board import Board
from daidalos.industry.rapid.runtime.errors import FatalError, RapidError
from daidalos.industry.rapid.runtime.loading import choose_programs, load_modules
from daidalos.industry.rapid.runtime.movements import MANUAL_SPEED, set_manual
from daidalos.industry.rapid.runtime.pacing import Pace
from daidalos.industry.rapid.runtime.positions import TOOL0, WOBJ0
from daidalos.industry.rapid.runtime.robot import wobj_pose
from daidalos.industry.rapid.runtime.task import Task
from daidalos.industry.robots import arm_named
from daidalos.nodes.parameters import declare
from daidalos.nodes.qos import LATCHED
from daidalos.nodes.runner import UserError, run

JOINTS = [f"joint_{number}" for number in range(1, 7)]
JOG_TIMEOUT_S = 0.2
"""Time without a message after which jogging from a topic stops."""

_PERIOD_S = 0.02
_STATES_EVERY = 5
_REPEATED_EVERY = 50
"""Turns after which a state that has not changed is published again: once in a second."""

_WINDOW = 15
_TILTED = math.radians(20.0)
"""Greatest rate of rotation while jogging [rad/s]."""

_STEPS = {"small": (1.0, 0.1), "medium": (5.0, 1.0), "large": (20.0, 5.0)}
"""Increments of a press, mm and deg."""


@dataclass(frozen=True)
class RapidPendantParameters(Parameters):
    """Parameters of ``rapid_pendant``."""

    program: str = parameter("", "A module, a program file (.pgf) or a folder.", not_empty=True)
    task: str = parameter("", "Task of a folder with several; the only one where empty.")
    procedure: str = parameter("main", "Procedure that the program begins with.", not_empty=True)
    robot: str = parameter("irb120", "The arm.", not_empty=True)
    frame: str = parameter("base_link", "Frame of the base, for jog_twist in base coordinates.", not_empty=True)


class RapidPendant(Node):
    """Node that takes ``~/command``, ``~/jog_joint`` and ``~/jog_twist``; publishes ``~/state`` and ``joint_states``.

    Commands are ``start``, ``stop``, ``step``, ``main``, ``answer TEXT``, ``mode auto|manual``, ``jog AXIS +|-``,
    ``frame axis|base|tool|wobj``, ``increment small|medium|large``, ``tool NAME``, ``wobj NAME``,
    ``signal NAME VALUE``, ``modpos NAME`` and ``save``.
    """

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("rapid_pendant", **kwargs)
        settings = declare(self, RapidPendantParameters)
        self._settings = settings
        self._board = Board()
        self._session = Session(self._load(), settings.procedure)
        self._arm = self._session.robot.arm
        self._frame: Frame = "axis"
        self._increment = "medium"
        self._tool, self._wobj = "tool0", "wobj0"
        self._report = ""
        self._jog: Callable[[float], Array] | None = None
        self._jog_until = 0
        self._count = 0
        self._sent: State | None = None
        self._states = self.create_publisher(State, "~/state", LATCHED)
        self._joints = self.create_publisher(JointState, "joint_states", 10)
        self.create_subscription(String, "~/command", lambda message: self._take(message.data), 100)
        self.create_subscription(JointJog, "~/jog_joint", self._take_joint_jog, 10)
        self.create_subscription(TwistStamped, "~/jog_twist", self._take_twist, 10)
        self.create_timer(_PERIOD_S, self._turn)

    def destroy_node(self) -> None:
        """End the program and destroy the node."""
        self._session.close()
        super().destroy_node()

    def _load(self) -> Task:
        settings = self._settings
        try:
            programs = choose_programs(Path(settings.program), [settings.task] if settings.task else [])
            name, program = next(iter(programs.items()))
            modules, checker, blocking = load_modules(program)
            for report in blocking:
                raise UserError(report.errors[0].text(report.file))
            robot = ArmRobot(arm_named(settings.robot))
            task = Task(modules, checker, robot, self._board, None, Pace(), self._date(), Path(settings.program).parent)
        except (ValueError, FatalError) as error:
            raise UserError(str(error)) from None
        task.name = name
        task.settings["is_live"] = True
        set_manual(task, True)
        return task

    @staticmethod
    def _date() -> Any:
        from datetime import datetime

        return datetime.now()

    # Commands

    def _take(self, command: str) -> None:
        """Do what a command asks; say why where it cannot."""
        word, _, rest = command.strip().partition(" ")
        commands: dict[str, Callable[[str], None]] = {
            "start": lambda _: self._session.start(),
            "step": lambda _: self._session.start(steps=True),
            "stop": lambda _: self._session.stop(),
            "main": lambda _: self._session.to_main(),
            "answer": self._session.answer,
            "save": lambda _: self._session.save(),
            "mode": self._set_mode,
            "jog": self._press,
            "frame": self._set_frame,
            "increment": self._set_increment,
            "tool": lambda name: self._choose("tooldata", name),
            "wobj": lambda name: self._choose("wobjdata", name),
            "signal": self._set_signal,
            "modpos": lambda name: self._session.modify(name, self._data(self._tool), self._data(self._wobj)),
        }
        self._report = ""
        try:
            if word not in commands:
                raise SessionError(f"there is no command '{word}'; there are {', '.join(commands)}")
            commands[word](rest.strip())
        except (SessionError, MotionFault, RapidError, UserError) as error:
            self._report = str(error)
        except (FatalError, OSError) as error:
            self._report = str(error)

    def _set_mode(self, mode: str) -> None:
        if mode not in ("auto", "manual"):
            raise SessionError(f"the mode is auto or manual, not '{mode}'")
        if self._session.state in ("running", "asking"):
            raise SessionError("the program runs; stop it before the mode changes")
        set_manual(self._session.task, mode == "manual")

    @property
    def _is_manual(self) -> bool:
        return bool(self._session.task.settings.get("is_manual"))

    def _set_frame(self, frame: str) -> None:
        found = next((one for one in FRAMES if one == frame), None)
        if found is None:
            raise SessionError(f"jogging is by {', '.join(FRAMES)}, not '{frame}'")
        self._frame = found

    def _set_increment(self, increment: str) -> None:
        if increment not in _STEPS:
            raise SessionError(f"the increment is {', '.join(_STEPS)}, not '{increment}'")
        self._increment = increment

    def _choose(self, type_: str, name: str) -> None:
        known = self._names(type_)
        found = next((one for one in known if one.lower() == name.lower()), None)
        if found is None:
            raise SessionError(f"there is no {type_} '{name}'; there are {', '.join(known)}")
        if type_ == "tooldata":
            self._tool = found
        else:
            self._wobj = found

    def _names(self, type_: str) -> list[str]:
        default = "tool0" if type_ == "tooldata" else "wobj0"
        data = self._session.task.stored_data()
        return [default, *(one.name for _, one, _ in data if one.type.name == type_ and not one.type.dimensions)]

    def _data(self, name: str) -> list[Any]:
        known = {"tool0": TOOL0, "wobj0": WOBJ0}
        return known[name] if name in known else list(self._session.task.value(name))

    def _set_signal(self, text: str) -> None:
        name, _, value = text.rpartition(" ")
        try:
            number = float(value)
        except ValueError:
            number = math.nan
        if not name or not math.isfinite(number):
            raise SessionError(f"'signal NAME VALUE' takes a finite value, not '{text}'")
        self._board.set(name, number)

    # Jogging

    def _press(self, text: str) -> None:
        axis, _, sign = text.partition(" ")
        if axis not in tuple("123456") or sign not in ("+", "-"):
            raise SessionError(f"'jog AXIS +' or '-' with an axis from 1 to 6, not '{text}'")
        self._check_manual()
        step, turn = _STEPS[self._increment]
        number, size = int(axis) - 1, 1.0 if sign == "+" else -1.0
        if self._frame == "axis":
            moved = jog_axis(self._arm, self._session.joints, number, size * math.radians(turn))
        else:
            ways = np.zeros(6)
            ways[number] = size * (1e-3 * step if number < 3 else math.radians(turn))
            moved = self._moved_tool(self._frame, ways)
        self._session.move(moved)

    def _check_manual(self) -> None:
        if not self._is_manual:
            raise SessionError("jogging needs manual mode")
        self._session.check_jogging()

    def _moved_tool(self, frame: Frame, ways: Array) -> Array:
        tool, wobj = matrix_of(self._data(self._tool)[1]), matrix_of(wobj_pose(self._data(self._wobj)))
        joints = self._session.joints
        return jog_tool(self._arm, joints, tool, axes_of(frame, self._arm, joints, tool, wobj), ways[:3], ways[3:])

    def _take_joint_jog(self, message: JointJog) -> None:
        unknown = [name for name in message.joint_names if name not in JOINTS]
        if unknown or len(message.velocities) != len(message.joint_names):
            self._report = f"jog_joint: a velocity for each of joint_1 to joint_6, not {', '.join(message.joint_names)}"
            return
        rates = np.zeros(6)
        for name, rate in zip(message.joint_names, message.velocities, strict=True):
            rates[JOINTS.index(name)] = rate
        rates = _shortened(rates, _TILTED)
        self._jog_by(rates, lambda seconds: self._turned(rates * seconds))

    def _turned(self, angles: Array) -> Array:
        joints = self._session.joints
        for axis, angle in enumerate(angles):
            joints = jog_axis(self._arm, joints, axis, float(angle))
        return joints

    def _take_twist(self, message: TwistStamped) -> None:
        name = message.header.frame_id
        frame = next(
            (one for one in FRAMES[1:] if one == name or (one == "base" and name == self._settings.frame)), None
        )
        if frame is None:
            self._report = f"jog_twist: the frame is {self._settings.frame}, tool or wobj, not '{name}'"
            return
        linear, angular = message.twist.linear, message.twist.angular
        rates = np.array([linear.x, linear.y, linear.z, angular.x, angular.y, angular.z])
        rates = np.concatenate([_shortened(rates[:3], 1e-3 * MANUAL_SPEED), _shortened(rates[3:], _TILTED)])
        self._jog_by(rates, lambda seconds: self._moved_tool(frame, rates * seconds))

    def _jog_by(self, rates: Array, move: Callable[[float], Array]) -> None:
        """Jog until the messages stop; a rate that is not finite stops at once."""
        self._jog = None
        if not np.isfinite(rates).all():
            self._report = "a rate of jogging is not finite"
            return
        self._jog, self._jog_until = move, self.get_clock().now().nanoseconds + int(JOG_TIMEOUT_S * 1e9)

    def _go_on_jogging(self) -> None:
        if self._jog is None:
            return
        if self.get_clock().now().nanoseconds > self._jog_until:
            self._jog = None
            return
        try:
            self._check_manual()
            moved = self._jog(_PERIOD_S)
            self._session.move(self._limited(moved))
        except (SessionError, MotionFault) as error:
            self._report, self._jog = str(error), None

    def _limited(self, moved: Array) -> Array:
        """Return angles that the arm reaches in a period: no faster than manual mode, tool and axes."""
        before = self._session.joints
        tool = matrix_of(self._data(self._tool)[1])
        tips = [(forward(self._arm, one) @ tool)[:3, 3] for one in (before, moved)]
        way = float(np.linalg.norm(tips[1] - tips[0]))
        shares = [1.0, 1e-3 * MANUAL_SPEED * _PERIOD_S / max(way, 1e-12)]
        shares.append(float((_TILTED * _PERIOD_S / np.maximum(np.abs(moved - before), 1e-12)).min()))
        return np.asarray(before + min(shares) * (moved - before))

    # Publishing

    def _turn(self) -> None:
        self._go_on_jogging()
        now = self.get_clock().now().to_msg()
        message = JointState(name=JOINTS, position=self._session.joints.tolist())
        message.header.stamp = now
        self._joints.publish(message)
        self._count += 1
        if self._count % _STATES_EVERY == 1:
            state = self._state()
            if state != self._sent or self._count % _REPEATED_EVERY == 1:
                self._sent = state
                self._states.publish(state)

    def _state(self) -> State:
        session = self._session
        state = State(state="asking" if session.screen.question else session.state)
        state.report = self._report or session.report
        state.mode = "manual" if self._is_manual else "auto"
        self._show_program(state)
        state.screen, state.question = list(session.screen.lines), session.screen.question
        state.choices = list(session.screen.choices)
        state.joints, state.pose = session.joints.tolist(), self._pose()
        state.frame = self._frame
        state.step, state.turn = _STEPS[self._increment]
        state.tool, state.wobj = self._tool, self._wobj
        state.tools, state.wobjs = self._names("tooldata"), self._names("wobjdata")
        state.positions, state.is_modified = session.positions(), bool(session.modified)
        values = self._board.values()
        state.signals, state.values = list(values), [float(one) for one in values.values()]
        return state

    def _show_program(self, state: State) -> None:
        file, line = self._session.place
        file = file or next(iter(self._session.texts))
        lines: Sequence[str] = self._session.texts[file].text.splitlines()
        first = max(0, min(line - _WINDOW // 2, len(lines) - _WINDOW))
        state.module, state.first_line, state.lines = Path(file).name, first + 1, list(lines[first : first + _WINDOW])
        state.program_pointer = line
        state.motion_pointer = self._session.motion_line

    def _pose(self) -> Pose:
        tool, wobj = matrix_of(self._data(self._tool)[1]), matrix_of(wobj_pose(self._data(self._wobj)))
        at = np.linalg.inv(wobj) @ forward(self._arm, self._session.joints) @ tool
        x, y, z, w = Rotation.from_matrix(at[:3, :3]).as_quat()
        return Pose(position=Point(x=at[0, 3], y=at[1, 3], z=at[2, 3]), orientation=Quaternion(x=x, y=y, z=z, w=w))


def _shortened(rates: Array, greatest: float) -> Array:
    """Return rates no longer than a limit, with the same direction; not finite ones as they are."""
    return rates * min(1.0, greatest / max(float(np.linalg.norm(rates)), 1e-12))


def main() -> int:
    """Run the node."""
    return run(RapidPendant)
