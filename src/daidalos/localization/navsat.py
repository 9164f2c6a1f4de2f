"""Satellite positions in a robot's world frame."""

from __future__ import annotations

from dataclasses import dataclass

from daidalos.common.pose3 import Pose, Vector, rotate
from daidalos.localization.geodesy import Projection


@dataclass(frozen=True)
class NavsatAlignment:
    """World frame of a robot on the earth.

    Attributes
    ----------
    projection : Projection
        Of places onto a grid.
    grid : Pose
        The grid's frame in the world frame; it is turned about the vertical only.
    """

    projection: Projection
    grid: Pose

    @classmethod
    def of(
        cls,
        projection: Projection,
        place: Vector,
        yaw: float,
        robot: Pose,
        antenna: Vector = (0.0, 0.0, 0.0),
        attitude: tuple[float, float] = (0.0, 0.0),
    ) -> NavsatAlignment:
        """Return the alignment of a robot whose place, heading and pose in its world frame are known.

        Parameters
        ----------
        projection : Projection
        place : tuple of 3 floats
            Latitude, longitude [deg] and altitude [m] of its antenna.
        yaw : float
            Heading, 0 to the east and positive to the north [rad].
        robot : Pose
            In the world frame.
        antenna : tuple of 3 floats
            Position in the robot's frame [m].
        attitude : tuple of 2 floats
            Roll and pitch [rad], which turn the antenna about the robot.
        """
        yaw += projection.convergence(place[0], place[1])
        offset = Pose.from_xyz_rpy((0.0, 0.0, 0.0), (*attitude, yaw)).transform(antenna)
        x, y, z = projection.forward(*place)
        on_grid = Pose.from_xyz_rpy((x - offset[0], y - offset[1], z - offset[2]), (0.0, 0.0, yaw))
        level = Pose.from_xyz_rpy(robot.position, (0.0, 0.0, robot.yaw))
        return cls(projection, level @ on_grid.inverse)

    def to_world(self, latitude: float, longitude: float, altitude: float) -> Vector:
        """Return the point [m] in the world frame of a place [deg, m]."""
        return self.grid.transform(self.projection.forward(latitude, longitude, altitude))

    def to_place(self, point: Vector) -> Vector:
        """Return latitude, longitude [deg] and altitude [m] of a point [m] in the world frame."""
        return self.projection.reverse(*self.grid.inverse.transform(point))

    def robot_position(self, place: Vector, robot: Pose, antenna: Vector = (0.0, 0.0, 0.0)) -> Vector:
        """Return the position of a robot in the world frame.

        Parameters
        ----------
        place : tuple of 3 floats
            Latitude, longitude [deg] and altitude [m] of its antenna.
        robot : Pose
            In the world frame, whose orientation counts.
        antenna : tuple of 3 floats
            Position in the robot's frame [m].
        """
        offset = rotate(robot.orientation, antenna)
        x, y, z = self.to_world(*place)
        return x - offset[0], y - offset[1], z - offset[2]
