"""`grinding_cell`: a simulated cell that grinds a plate or a clamp, and publishes force, cylinder and height field."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from geometry_msgs.msg import WrenchStamped
from numpy.typing import NDArray
from rclpy.node import Node
from sensor_msgs.msg import JointState, PointCloud2
from std_msgs.msg import Float64, Header, String
from std_srvs.srv import Trigger
from tf2_ros import StaticTransformBroadcaster
from visualization_msgs.msg import Marker

from daidalos.common.errors import UserError
from daidalos.common.extensions import find
from daidalos.common.parameters import Parameters, group, parameter
from daidalos.common.pose3 import Pose
from daidalos.industry.grinding.cell import parse_fault
from daidalos.industry.grinding.extensions import FORCE_CONTROLLERS
from daidalos.industry.grinding.force_control import ForceController
from daidalos.industry.grinding.grinding import Grinding, Phase, Sample
from daidalos.industry.grinding.height_field import deviation
from daidalos.industry.grinding.passes import Line
from daidalos.industry.grinding.records import record_of
from daidalos.industry.grinding.settings import PERIOD, CellParameters
from daidalos.industry.grinding.tasks import JobRun, clamp_job, plate_job
from daidalos.industry.grinding.workpieces import clamp, plate
from daidalos.nodes.daidalos_grinding._messages import (
    disc_marker,
    field_message,
    joint_message,
    transform_message,
    wrench_message,
)
from daidalos.nodes.parameters import declare
from daidalos.nodes.qos import LATCHED
from daidalos.nodes.runner import run

_TICK = 0.01
_MAX_LAG = 0.1
"""Time that is made up for at most in one tick; what the computer is late beyond it is left out [s]."""
_KEEP_EVERY = 5
_JOINTS = tuple(f"joint_{number}" for number in range(1, 7))
_GREY, _RED = ({"r": 0.25, "g": 0.25, "b": 0.28, "a": 0.8}, {"r": 0.9, "g": 0.3, "b": 0.1, "a": 0.9})


@dataclass(frozen=True)
class GrindingCellParameters(Parameters):
    """Parameters of ``grinding_cell``."""

    task: str = parameter("clamp", "What is ground.", choices=("clamp", "plate"))
    controller: str = parameter("pi", "Force controller.", not_empty=True)
    robot: str = parameter("irb8700", "Arm, as `daidalos arm list` names it.", not_empty=True)
    force: float = parameter(30.0, "Force on the workpiece.", unit="N", above=0.0)
    depth: float = parameter(50e-6, "Layer that is removed from a plate.", unit="m", above=0.0, maximum=1e-3)
    spacing: float = parameter(0.012, "Distance of the lines on a plate.", unit="m", above=0.0)
    excess: float = parameter(1e-3, "Mean height of the bead on a clamp.", unit="m", above=0.0, maximum=0.01)
    tolerance: float = parameter(1e-4, "Tolerance about the target of a clamp.", unit="m", minimum=2e-5, maximum=2e-3)
    resolution: float = parameter(5e-4, "Edge of a cell of the height field.", unit="m", minimum=1e-4, maximum=2e-3)
    speed: float = parameter(1.0, "Speed of the process, 1 for real time.", above=0.0, maximum=20.0)
    seed: int = parameter(0, "Of noise and errors.", minimum=0)
    faults: tuple[str, ...] = parameter(
        ("",), "What breaks when: sensor_stops, sensor_nan or valve_stops, such as ``sensor_nan@3.0`` [s]."
    )
    field_period: float = parameter(0.5, "Time between two height fields.", unit="s", above=0.0)
    frame: str = parameter("base_link", "Frame of the robot's base.", not_empty=True)
    cell: CellParameters = group(CellParameters)


class GrindingCell(Node):
    """Node that grinds, and publishes what its sensors and scanner tell.

    ``~/force`` and ``~/wanted_force`` (along the tool), ``~/cylinder`` (position and force of the pressure),
    ``~/spindle`` (speed and torque), ``~/wear``, ``~/height_field`` (coloured by deviation), ``~/disc``, ``~/state``
    and the arm's ``joint_states``. ``~/stop`` lifts the tool off, ``~/start`` begins with a new workpiece.
    """

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("grinding_cell", **kwargs)
        self._settings = settings = declare(self, GrindingCellParameters)
        kind = find(FORCE_CONTROLLERS, settings.controller)
        own = declare(self, kind.settings_class, settings.controller)
        self._make: Callable[[], ForceController] = lambda: kind(own, settings.cell.actuator, PERIOD)
        self._faults = [parse_fault(text) for text in settings.faults if text]
        self._force = self.create_publisher(WrenchStamped, "~/force", 10)
        self._wanted = self.create_publisher(WrenchStamped, "~/wanted_force", 10)
        self._cylinder = self.create_publisher(JointState, "~/cylinder", 10)
        self._spindle = self.create_publisher(JointState, "~/spindle", 10)
        self._wear = self.create_publisher(Float64, "~/wear", 10)
        self._field = self.create_publisher(PointCloud2, "~/height_field", LATCHED)
        self._disc = self.create_publisher(Marker, "~/disc", 1)
        self._arm = self.create_publisher(JointState, "joint_states", 10)
        self._state = self.create_publisher(String, "~/state", LATCHED)
        self.create_service(Trigger, "~/stop", self._stop)
        self.create_service(Trigger, "~/start", self._start)
        self._transforms = StaticTransformBroadcaster(self)
        self._said = ""
        self._begin()
        self._last = self.get_clock().now().nanoseconds
        self.create_timer(_TICK, self._tick)
        self.create_timer(settings.field_period, self._show_field)

    def _begin(self) -> None:
        """Put a new workpiece into the cell."""
        self._job = self._new_job()
        piece = self._job.piece
        self._run: Grinding | None = None
        self._lines: list[Line] = []
        self._samples: list[Sample] = []
        self._steps, self._debt = 0, 0.0
        self._joints: NDArray[np.float64] | None = None
        self._transforms.sendTransform(
            transform_message(Pose.from_matrix(piece.pose), "workpiece", self._header(self._settings.frame))
        )
        self._next_pass()

    def _new_job(self) -> JobRun:
        own = self._settings
        if own.task == "plate":
            piece = plate(depth=own.depth, seed=own.seed, resolution=own.resolution)
            return plate_job(piece, own.cell, self._make, own.force, own.depth, own.spacing, own.seed, self._faults)
        piece = clamp(own.excess, own.seed, own.resolution)
        return clamp_job(piece, own.cell, self._make, own.force, own.tolerance, own.seed, self._faults)

    def _next_pass(self) -> None:
        """Plan the next pass; the job is over where there is none."""
        following = self._job.next_pass(self._settings.robot)
        if following is None:
            self._run = None
            found = deviation(self._job.scan, self._job.tolerance)
            reason = self._job.problem
            self._tell(
                f"stopped: {reason}" if reason else f"done: {100.0 * found.within:.2f} % of the region within tolerance"
            )
            return
        self._lines, self._run = following
        self._samples = []

    def _tick(self) -> None:
        """Advance to the time of the clock, and publish."""
        now = self.get_clock().now().nanoseconds
        passed, self._last = 1e-9 * (now - self._last), now
        if self._run is None:
            return
        # A clock that jumps, forwards or back, does not jump the tool.
        self._debt = min(self._debt + max(passed, 0.0) * self._settings.speed, _MAX_LAG * self._settings.speed)
        sample = None
        while self._debt >= PERIOD and self._run is not None:
            self._debt -= PERIOD
            sample = self._run.step()
            self._steps += 1
            if self._steps % _KEEP_EVERY == 0:
                self._samples.append(sample)
            if self._run.is_over:
                break
        if sample is None:
            return
        self._publish(self._run, sample)
        if self._run.is_over:
            self._job.finish_pass(self._lines, self._run, record_of(self._samples))
            self._next_pass()

    def _publish(self, process: Grinding, sample: Sample) -> None:
        header = self._header("grinder")
        self._force.publish(wrench_message(sample.measured, header))
        self._wanted.publish(wrench_message(sample.wanted, header))
        area = self._settings.cell.actuator.area
        self._cylinder.publish(joint_message(["cylinder"], header, [sample.piston], effort=[area * sample.pressure]))
        self._spindle.publish(joint_message(["spindle"], header, [0.0], [sample.speed], [sample.torque]))
        self._wear.publish(Float64(data=sample.wear))
        if process.phase is Phase.DONE:
            return
        if self._arm.get_subscription_count():
            self._arm.publish(joint_message(_JOINTS, self._header(""), self._arm_joints(process).tolist()))
        if self._disc.get_subscription_count():
            self._disc.publish(self._disc_message(sample))
        self._tell(f"pass {len(self._job.passes) + 1}, line {process.line + 1} of {len(self._lines)}: {sample.phase}")

    def _arm_joints(self, process: Grinding) -> NDArray[np.float64]:
        """Return the arm's angles at the place on the line; between two lines they go over smoothly."""
        index, share = process.place_on_line
        line = self._job.joints[process.line]
        wanted = line[index] + share * (line[index + 1] - line[index])
        before = wanted if self._joints is None else self._joints
        self._joints = before + np.clip(wanted - before, -0.02, 0.02)
        return self._joints

    def _disc_message(self, sample: Sample) -> Marker:
        piece = self._job.piece
        slopes = piece.slopes(sample.x, sample.y)
        lean = self._lines[0].lean
        tilt = self._settings.cell.disc.lean
        axis = np.array([tilt * lean[0] - slopes[0], tilt * lean[1] - slopes[1], 1.0])
        axis /= np.linalg.norm(axis)
        radius = self._settings.cell.disc.radius
        height = float(piece.target[piece.index(sample.x, sample.y)]) + 0.004
        lift = 0.0 if sample.phase is Phase.GRIND else 0.02
        place = np.array([sample.x - lean[0] * radius, sample.y - lean[1] * radius, height]) + lift * axis
        color = _RED if sample.force > 0.0 else _GREY
        return disc_marker(place.tolist(), axis, radius, color, self._header("workpiece"))

    def _show_field(self) -> None:
        if self._field.get_subscription_count():
            piece = self._job.piece
            surface = self._run.cell.surface if self._run is not None else piece.surface
            span = max(2.0 * self._job.tolerance, 1e-6)
            self._field.publish(field_message(piece, surface, span, self._header("workpiece")))

    def _tell(self, text: str) -> None:
        """Publish and log a state that has changed."""
        if text != self._said:
            self._said = text
            self._state.publish(String(data=text))
            log = self.get_logger()
            log.warning(text) if text.startswith("stopped") else log.info(text)

    def _stop(self, request: Any, response: Any) -> Any:
        if self._run is None:
            response.message = "nothing is being ground"
            return response
        self._run.stop("it was asked to stop")
        response.success, response.message = True, "the tool is lifted off"
        return response

    def _start(self, request: Any, response: Any) -> Any:
        if self._run is not None:
            response.message = "it is being ground; stop it before"
            return response
        try:
            self._begin()
        except UserError as error:
            response.message = str(error)
            return response
        response.success, response.message = True, "a new workpiece is being ground"
        return response

    def _header(self, frame: str) -> Header:
        return Header(frame_id=frame, stamp=self.get_clock().now().to_msg())


def main() -> int:
    """Run the node."""
    return run(GrindingCell)
