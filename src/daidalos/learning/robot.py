"""Robot of an environment: its commands, its sensors and its motion in a simulation."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.errors import UserError
from daidalos.common.pose3 import Pose, rotation_matrix
from daidalos.nodes.description_files import read_description
from daidalos.nodes.gazebo_ros._descriptions import read_entity, read_world
from daidalos.nodes.gazebo_ros.built_in import find_model_file, find_world_file
from daidalos.samples.commands import TwistCommand
from daidalos.simulation import Simulation
from daidalos.simulation.sensors.camera import Camera
from daidalos.simulation.sensors.lidar import Lidar
from daidalos.simulation.sensors.ray_fan import RayFan

_GROUND = ("ground_plane", "ground")
_SETTLE_NS = 100_000_000


class SimulatedRobot:
    """Robot in a world.

    Parameters
    ----------
    world : str or Path
        File or name of the world; an empty one where empty.
    robot : str or Path
        File of the robot or its name: ``waffle`` or ``burger``.
    rays : int
        How many rays of its lidar are cast, evenly spread; 0 for none.
    joints : sequence of str
        Joints that are driven and observed.
    camera : bool
        Whether its first camera is used.
    kinematic : bool
        Whether the base moves exactly as commanded, without physics.

    Raises
    ------
    UserError
        When there is no such world, robot, sensor or joint.
    """

    def __init__(
        self, world: str | Path, robot: str | Path, rays: int, joints: Sequence[str], camera: bool, kinematic: bool
    ) -> None:
        described = read_world(find_world_file(str(world)) if str(world) else None)
        self.simulation = Simulation(described, has_subscribers=self._is_wanted)
        self._wanted: frozenset[str] = frozenset()
        model = read_entity(read_description(find_model_file(str(robot))))
        self.name = self.simulation.spawn(model, "robot", Pose((0.0, 0.0, 0.01)))
        self.simulation.advance(_SETTLE_NS)
        self.simulation.physics.refresh()
        self._instance = self.simulation.instance(self.name)
        self._kinematic = kinematic
        self._height = self._instance.pose.position[2]
        self._lidar = self._find(Lidar, "lidar") if rays else None
        self._camera = self._find(Camera, "camera") if camera else None
        self._command = next((t for t, kind in self.simulation.subscriptions.items() if kind is TwistCommand), None)
        self.joints = [self._instance.joint(name) for name in joints]
        self.extent = self._extent_of_world()
        """Half of the world's extent [m], of its collisions."""
        self._begin = self.simulation.save()
        self._velocity = (0.0, 0.0)
        self._pose = self._instance.pose
        self._bind(rays)

    @property
    def range_max(self) -> float:
        """Greatest range of the lidar [m]."""
        return self._lidar.range_max if self._lidar is not None else 0.0

    @property
    def has_base(self) -> bool:
        """Whether it takes velocities."""
        return self._command is not None

    def image_shape(self) -> tuple[int, ...]:
        """Return the shape of the camera's images."""
        image = self.image()
        return tuple(np.asarray(image).shape)

    def _extent_of_world(self) -> float:
        """Return half of the extent of the collisions without the robot's [m]: it shall not depend on where that is."""
        corners = [self.simulation.bounds(name) for name in self.simulation.models if name != self.name]
        return max((float(np.abs(corner[:, :2]).max()) for corner in map(np.array, corners)), default=1.0)

    def _find(self, kind: type, word: str) -> Any:
        found = next((c for c in self._instance.components if isinstance(c, kind)), None)
        if found is None:
            raise UserError(f"the robot has no {word}")
        return found

    def _bind(self, rays: int) -> None:
        physics = self.simulation.physics
        self._mine = np.zeros(physics.model.ngeom, dtype=bool)
        self._solid = np.zeros(physics.model.ngeom, dtype=bool)
        for geom, (owner, _) in physics.geoms.items():
            self._mine[geom] = owner == self.name
            self._solid[geom] = owner != self.name and owner not in _GROUND
        if self._lidar is not None:
            angles = self._lidar.horizontal.angles
            chosen = np.linspace(0, len(angles), min(rays, len(angles)), endpoint=False).astype(int)
            self._fan = RayFan(angles[chosen], np.zeros(1))
            self._fan.bind(physics.model)
            mount = self._lidar.pose
            self._mount = np.array(mount.position), rotation_matrix(mount.orientation)

    def _is_wanted(self, topic: str) -> bool:
        return topic in self._wanted

    # Motion.

    def reset(self, x: float, y: float, yaw: float, stream: np.random.Generator) -> None:
        """Restart at a pose, with noise from a stream."""
        self.simulation.restore(self._begin)
        for component in self._instance.components:
            component.random = np.random.default_rng(stream.integers(1 << 62))
        self._velocity = (0.0, 0.0)
        self._place(x, y, yaw)

    def _place(self, x: float, y: float, yaw: float) -> None:
        self._pose = Pose.from_xyz_rpy((x, y, self._height), (0.0, 0.0, yaw))
        self._instance.set_pose(self._pose)
        self.simulation.physics.changed()

    def drive(self, linear: float, angular: float, seconds: float) -> None:
        """Move for some time [s] with a commanded velocity [m/s, rad/s]."""
        if self._kinematic:
            self._velocity = (linear, angular)
            x, y, _ = self._pose.position
            half = 0.5 * angular * seconds
            middle, yaw = self._pose.yaw + half, self._pose.yaw + 2.0 * half
            chord = linear * seconds * (math.sin(half) / half if half else 1.0)
            self._place(x + chord * math.cos(middle), y + chord * math.sin(middle), yaw)
            return
        twist = TwistCommand(np.array([linear, 0.0, 0.0]), np.array([0.0, 0.0, angular]))
        if self._command is not None:
            self.simulation.command(self._command, twist)
        self.advance(seconds)

    def push_joints(self, efforts: Array, seconds: float) -> None:
        """Apply efforts [N m, N] to the joints for some time [s]."""
        for joint, effort in zip(self.joints, efforts, strict=True):
            self.simulation.push_joint(self.name, joint.name, float(effort), duration_ns=round(1e9 * seconds))
        self.advance(seconds)

    def advance(self, seconds: float) -> None:
        """Simulate for some time [s]."""
        self.simulation.advance(round(1e9 * seconds))
        self.simulation.physics.refresh_positions()

    # What is measured.

    @property
    def pose(self) -> Pose:
        """True pose in the world."""
        return self._pose if self._kinematic else self._instance.pose

    @property
    def velocity(self) -> tuple[float, float]:
        """True velocity: forwards [m/s], to the left [rad/s]."""
        if self._kinematic:
            return self._velocity
        linear, angular = self.simulation.velocity(self.name)
        yaw = self.pose.yaw
        return float(linear[0] * math.cos(yaw) + linear[1] * math.sin(yaw)), float(angular[2])

    @property
    def collided(self) -> bool:
        """Whether it touches anything but the ground."""
        physics = self.simulation.physics
        if self._kinematic:
            physics.refresh_contacts()
        contact = physics.data.contact
        first, second = contact.geom.T
        here = (self._mine[first] & self._solid[second]) | (self._mine[second] & self._solid[first])
        return bool(np.any(here & (contact.dist < 0)))

    def ranges(self) -> Array:
        """Return what the lidar measures [m], its greatest range where it sees nothing."""
        lidar = self._lidar
        if lidar is None:
            return np.zeros(0)
        physics, link = self.simulation.physics, lidar.link
        turn = link.rotation
        offset, tilt = self._mount
        origin = physics.data.xpos[link.body] + turn @ offset
        ranges, geoms = self._fan.cast(physics, origin, turn @ tilt, link.body, lidar.range_max)
        seen = (geoms >= 0) & (ranges <= lidar.range_max) & ~self._mine[geoms]
        measured: Array = np.full(len(ranges), lidar.range_max)
        measured[seen] = lidar.noise.apply(ranges[seen], lidar.random)
        np.clip(measured, 0.0, lidar.range_max, out=measured)
        return measured

    def image(self) -> Any:
        """Return the picture of the camera; None without one."""
        if self._camera is None:
            return None
        topics = [t for t in self._camera.publications if t.endswith(("image_raw", "image", "depth_image"))]
        self._wanted = frozenset(topics or self._camera.publications)
        for sample in self._camera.measure(self.simulation.time_ns):
            if hasattr(sample, "pixels"):
                return sample.pixels
        raise UserError("the robot's camera has no pictures")
