"""`head_calibration`: guided calibration of a moving head, from the studio's panel or a game pad."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from daidalos_msgs.msg import HeadCalibration as State
from geometry_msgs.msg import Point
from rclpy.node import Node
from sensor_msgs.msg import Joy
from std_msgs.msg import ColorRGBA, String
from visualization_msgs.msg import Marker, MarkerArray

from daidalos.common.parameters import Parameters, parameter
from daidalos.industry.lighting.calibration import PARAMETERS, CalibrationError, expected_errors
from daidalos.industry.lighting.calibration_file import read_points, read_session, write_calibration, write_session
from daidalos.industry.lighting.configuration import DEFAULT, read_configuration
from daidalos.industry.lighting.engine import Engine
from daidalos.industry.lighting.guided_calibration import (
    COLUMNS,
    GuidedCalibration,
    corners,
    session_file,
    table_targets,
)
from daidalos.industry.lighting.show import Show
from daidalos.nodes.parameters import declare
from daidalos.nodes.qos import LATCHED
from daidalos.nodes.runner import UserError, run

_KEYS = {"enter": "\n", "undo": "u"}
_BUTTONS = {0: "enter", 1: "undo", 2: "propose", 3: "write", 4: "-", 5: "+"}
"""What the buttons of a game pad mean."""
_PERIOD_S = 0.05
_PAD_STEPS = 4.0
"""Steps that a stick at its end adds in a second, times the step's angle."""
_DEAD_ZONE = 0.1
_BAD_ERROR = 0.005
"""Expected error that is drawn red [m]."""


@dataclass(frozen=True)
class HeadCalibrationParameters(Parameters):
    """Parameters of ``head_calibration``."""

    config: str = parameter(
        "", "File of heads and outputs, as `daidalos light` reads it; the built-in one where empty."
    )
    head: str = parameter("", "Name of the head; the first of the file where empty.")
    artnet_port: int = parameter(0, "Port of the Art-Net outputs; that of the file where 0.", minimum=0, maximum=65535)
    table: tuple[float, ...] = parameter(
        (-1.0, -0.75, 1.0, 0.75, 0.0), "Two corners of the table, whose corners are the points: x0, y0, x1, y1, z.",
        unit="m", length=5,
    )  # fmt: skip
    points: str = parameter("", "YAML file with a list of known points, in place of the table; none where empty.")
    output: str = parameter(
        "calibration.yaml", "Result; what is confirmed is kept in OUTPUT.session and resumed.", not_empty=True
    )
    world_frame: str = parameter("world", "Frame of the points.", not_empty=True)


class HeadCalibration(Node):
    """Node that takes ``~/command`` and ``joy``, and publishes ``~/state`` and ``~/markers``.

    Commands are ``left``, ``right``, ``up``, ``down``, ``+``, ``-`` (the step), ``enter``, ``undo``, ``propose`` (one
    more point, where it helps most) and ``write``.
    """

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("head_calibration", **kwargs)
        settings = declare(self, HeadCalibrationParameters)
        configuration = read_configuration(Path(settings.config) if settings.config else DEFAULT)
        configuration = configuration.with_artnet_port(settings.artnet_port)
        show = Show(configuration.make_heads())
        head = show.head(settings.head or configuration.heads[0].name)
        self._name, self._frame, self._output = head.name, settings.world_frame, Path(settings.output)
        session = session_file(self._output)
        try:
            points = read_points(Path(settings.points)) if settings.points else corners(settings.table)
            confirmed = read_session(session, head.name) if session.exists() else []
        except (CalibrationError, OSError) as error:
            raise UserError(str(error)) from None
        self._targets = table_targets(points)
        self._guided = GuidedCalibration(points, head.geometry, head.limits, confirmed)
        self._report = f"resumed from {session}" if confirmed else ""
        self._is_written = False
        self._stick, self._pressed = (0.0, 0.0), frozenset[int]()
        self._engine = Engine(show, configuration.make_outputs(), self._warn)
        self._engine.__enter__()
        self._states = self.create_publisher(State, "~/state", LATCHED)
        self._markers = self.create_publisher(MarkerArray, "~/markers", LATCHED)
        self.create_subscription(String, "~/command", lambda message: self._take(message.data), 100)
        self.create_subscription(Joy, "joy", self._take_joy, 10)
        self.create_timer(_PERIOD_S, self._turn)
        self._update()

    def destroy_node(self) -> None:
        """Switch the head dark and destroy the node."""
        self._engine.close()
        super().destroy_node()

    def _warn(self, line: str) -> None:
        self.get_logger().warning(line)

    def _take(self, command: str) -> None:
        """Do what a command asks; say why where it cannot."""
        self._report = ""
        try:
            if command == "propose":
                self._guided.add_proposal(self._targets)
            elif command == "write":
                self._write()
            elif self._guided.press(_KEYS.get(command, command)):
                if command in _KEYS:
                    self._is_written = False
                    write_session(session_file(self._output), self._name, self._guided.observations)
            else:
                self._report = f"'{command[:40]}' means nothing now"
        except (CalibrationError, OSError) as error:
            self._report = str(error)
        self._update()

    def _take_joy(self, message: Joy) -> None:
        """Turn by the first two axes, and take what buttons mean when they are pressed."""
        x, y = (*message.axes, 0.0, 0.0)[:2]
        self._stick = tuple(one if abs(one) > _DEAD_ZONE else 0.0 for one in (x, y))  # type: ignore[assignment]
        pressed = frozenset(number for number, value in enumerate(message.buttons) if value)
        for number in sorted(pressed - self._pressed):
            if number in _BUTTONS:
                self._take(_BUTTONS[number])
        self._pressed = pressed

    def _turn(self) -> None:
        x, y = self._stick
        if (x or y) and self._guided.task is not None:
            by = _PAD_STEPS * _PERIOD_S * self._guided.step
            self._guided.turn_by(-x * by, y * by)  # a stick to the left is positive, the key to the left negative
            self._update()

    def _write(self) -> None:
        if self._guided.result is None:
            raise CalibrationError(self._guided.problem or "there is no result yet")
        worst = float(expected_errors(self._guided.result, self._targets).max())
        write_calibration(self._output, self._name, self._guided.result, self._guided.observations, worst)
        session_file(self._output).unlink(missing_ok=True)
        self._is_written, self._report = True, f"written to {self._output}"

    def _update(self) -> None:
        """Aim, and publish the state and the picture of it."""
        self._engine.command(self._name, lambda head: head.turn(self._guided.angles))
        state = self._state()
        self._states.publish(state)
        self._markers.publish(self._draw(state))

    def _state(self) -> State:
        guided = self._guided
        confirmed, total = guided.progress
        state = State(head=self._name, confirmed=confirmed, total=total, is_complete=guided.task is None)
        if guided.task is not None:
            state.point = Point(**dict(zip("xyz", map(float, guided.task.point), strict=True)))
            state.is_flipped = guided.task.is_flipped
        state.pan, state.tilt, state.step = guided.angles.pan, guided.angles.tilt, guided.step
        state.report, state.is_written = self._report or guided.problem, self._is_written
        found = guided.result
        if found is not None:
            geometry = found.geometry
            state.has_result = True
            state.names = [*PARAMETERS[:3], *PARAMETERS[6:]]
            state.values = [*geometry.pose.position, geometry.tilt_zero, geometry.axis_skew, geometry.beam_skew]
            deviations = [math.sqrt(one) for one in found.covariance.diagonal()]
            state.deviations = [*deviations[:3], *deviations[6:]]
            state.residual, state.condition = found.residual, found.condition
            state.columns = COLUMNS
            state.expected_errors = [float(one) for one in expected_errors(found, self._targets)]
        return state

    def _draw(self, state: State) -> MarkerArray:
        """Return the expected errors as coloured tiles on the table, and the point that is aimed at."""
        markers = [Marker(action=Marker.DELETEALL)]
        errors = list(state.expected_errors)
        if errors:
            tiles = self._marker("expected error", Marker.CUBE_LIST)
            tiles.scale.x = 0.9 * abs(self._targets[1][0] - self._targets[0][0])
            tiles.scale.y = 0.9 * abs(self._targets[COLUMNS][1] - self._targets[0][1])
            tiles.scale.z = 0.002
            tiles.points = [Point(x=x, y=y, z=z) for x, y, z in self._targets]
            tiles.colors = [_color(one) for one in errors]
            markers.append(tiles)
        if not state.is_complete:
            aim = self._marker("point", Marker.SPHERE)
            aim.pose.position = state.point
            aim.scale.x = aim.scale.y = aim.scale.z = 0.04
            aim.color = ColorRGBA(r=1.0, g=1.0, b=1.0, a=1.0)
            markers.append(aim)
        return MarkerArray(markers=markers)

    def _marker(self, name: str, kind: int) -> Marker:
        marker = Marker(ns=name, type=kind, action=Marker.ADD)
        marker.header.frame_id = self._frame
        marker.pose.orientation.w = 1.0
        marker.color.a = 1.0
        return marker


def _color(error: float) -> ColorRGBA:
    """Return green for no error, yellow, and red from `_BAD_ERROR` on."""
    share = min(error / _BAD_ERROR, 1.0)
    return ColorRGBA(r=min(2.0 * share, 1.0), g=min(2.0 - 2.0 * share, 1.0), b=0.1, a=0.8)


def main() -> int:
    """Run the node."""
    return run(HeadCalibration)
