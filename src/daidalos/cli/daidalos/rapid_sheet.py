"""A sheet of paper in the simulator: it lies at a work object, and shows what a pen has drawn."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from daidalos.common.errors import UserError
from daidalos.common.pose3 import Pose
from daidalos.industry.motion.kinematics import forward
from daidalos.industry.rapid.lettering.drawing import drawn_strokes
from daidalos.industry.rapid.lettering.strokes import Stroke

if TYPE_CHECKING:
    from rclpy.node import Node

    from daidalos.industry.motion.orientations import Array
    from daidalos.industry.rapid.runtime.arm_robot import ArmRobot

CONTACT = 0.5
"""Height of the tip above the sheet up to which the simulated pen draws [mm]: a felt tip gives way."""

_WAIT_S = 20.0
_WIDTH, _HEIGHT, _MARGIN = 297.0, 210.0, 60.0
_THICKNESS = 0.5
_SHOWN_WIDTH, _SHOWN_HEIGHT = 1.0, 1.0
"""Size of the lines that are shown [mm]: finer ones are lost from afar."""

_TOLERANCE = 0.02
"""Deviation up to which points are left out of the lines that are shown [mm]."""

_MAX_MODELS = 200


class SimulatedSheet:
    """Sheet in the simulator, whose lines appear as the pen leaves it.

    Parameters
    ----------
    node : Node
        Node that another thread spins.
    robot : ArmRobot
        The arm whose tool is the pen.
    frame : array of shape (4, 4)
        Pose of the sheet in the base [mm].

    Raises
    ------
    UserError
        Where there is no simulator that takes it.
    """

    def __init__(self, node: Node, robot: ArmRobot, frame: Array) -> None:
        from gazebo_msgs.srv import DeleteEntity, SpawnEntity

        self._robot, self._frame = robot, frame
        self._positions: list[Array] = []
        self._is_down = False
        self._begin = 0
        self._count = 0
        self._spawn = node.create_client(SpawnEntity, "/spawn_entity")
        self._delete = node.create_client(DeleteEntity, "/delete_entity")
        if not (self._spawn.wait_for_service(_WAIT_S) and self._delete.wait_for_service(_WAIT_S)):
            raise UserError(
                "there is no simulator with /spawn_entity: ros2 launch irb120_description bringup.launch.py"
            )
        self._remove_old()
        white = _box((_WIDTH / 2 - _MARGIN, _HEIGHT / 2 - _MARGIN, -_THICKNESS / 2), (_WIDTH, _HEIGHT, _THICKNESS), 0.0)
        answer = self._spawn.call(self._request("sheet", [white], "1 1 1 1"), _WAIT_S)
        if answer is None or not answer.success:
            raise UserError(
                f"the sheet cannot be put into the simulator: {answer.status_message if answer else 'no answer'}"
            )

    def _remove_old(self) -> None:
        from gazebo_msgs.srv import DeleteEntity

        for name in ("sheet", *(f"ink_{k}" for k in range(_MAX_MODELS))):
            answer = self._delete.call(DeleteEntity.Request(name=name), _WAIT_S)
            if (answer is None or not answer.success) and name != "sheet":
                return

    def record(self, joints: Array) -> None:
        """Take angles of the arm (6,) [rad]; called in the thread of the node."""
        tip = 1e3 * (forward(self._robot.arm, joints) @ self._robot.tool)[:3, 3]
        self._positions.append(tip)
        is_down = bool((tip - self._frame[:3, 3]) @ self._frame[:3, 2] <= CONTACT)
        if self._is_down and not is_down:
            self._show(self._begin)
        if is_down and not self._is_down:
            self._begin = len(self._positions) - 1
        self._is_down = is_down

    def strokes(self) -> list[Stroke]:
        """Return all strokes that were drawn."""
        return drawn_strokes(np.array(self._positions), self._frame, CONTACT) if self._positions else []

    def _show(self, begin: int) -> None:
        """Put the line from a position on into the simulator."""
        from shapely import LineString

        drawn = drawn_strokes(np.array(self._positions[begin:]), self._frame, CONTACT)
        if not drawn or self._count >= _MAX_MODELS:
            return
        points = np.array(LineString(drawn[0].points).simplify(_TOLERANCE).coords)
        boxes = [_line(*ends) for ends in pairwise(points)]
        self._spawn.call_async(self._request(f"ink_{self._count}", boxes, "0.07 0.23 0.54 1"))
        self._count += 1

    def _request(self, name: str, boxes: list[str], color: str) -> Any:
        from gazebo_msgs.srv import SpawnEntity
        from geometry_msgs.msg import Point, Quaternion
        from geometry_msgs.msg import Pose as PoseMessage

        matrix = self._frame.copy()
        matrix[:3, 3] *= 1e-3
        pose = Pose.from_matrix(matrix)
        material = f"<material><ambient>{color}</ambient><diffuse>{color}</diffuse></material>"
        visuals = "".join(f'<visual name="v{k}">{box}{material}</visual>' for k, box in enumerate(boxes))
        model = f'<model name="{name}"><static>true</static><link name="link">{visuals}</link></model>'
        (x, y, z), (qx, qy, qz, qw) = pose.position, pose.orientation
        return SpawnEntity.Request(
            name=name,
            xml=f'<sdf version="1.6">{model}</sdf>',
            initial_pose=PoseMessage(position=Point(x=x, y=y, z=z), orientation=Quaternion(x=qx, y=qy, z=qz, w=qw)),
        )


def _line(start: Array, end: Array) -> str:
    """Return a piece of a line between two points on the sheet [mm]."""
    (x0, y0), (x1, y1) = start, end
    length = float(np.hypot(x1 - x0, y1 - y0)) + _SHOWN_WIDTH
    size = (length, _SHOWN_WIDTH, _SHOWN_HEIGHT)
    return _box(((x0 + x1) / 2, (y0 + y1) / 2, _SHOWN_HEIGHT / 2), size, float(np.arctan2(y1 - y0, x1 - x0)))


def _box(place: tuple[float, float, float], size: tuple[float, float, float], yaw: float) -> str:
    """Return a box on the sheet, by its middle and size [mm] and its turn [rad]."""
    x, y, z = (1e-3 * one for one in place)
    sides = " ".join(f"{1e-3 * one:.6f}" for one in size)
    pose = f"{x:.6f} {y:.6f} {z:.6f} 0 0 {yaw:.6f}"
    return f"<pose>{pose}</pose><geometry><box><size>{sides}</size></box></geometry>"
