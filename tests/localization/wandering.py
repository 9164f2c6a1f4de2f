"""A robot that wanders through a flat world with drifting odometry: scans, odometry and truth."""

import math

import numpy as np

from daidalos.common.pose2 import compose
from daidalos.mapping.grid import OccupancyGrid

RESOLUTION = 0.05


def map_of(world, width, height, margin=0.2):
    """Occupancy grid of a world that covers (0, 0) to (width, height)."""
    shape = (round((height + 2 * margin) / RESOLUTION), round((width + 2 * margin) / RESOLUTION))
    occupancy = world.rasterised(RESOLUTION, (-margin, -margin), shape)
    return OccupancyGrid(occupancy, RESOLUTION, (-margin, -margin, 0.0))


class Wanderer:
    """Drives a flat robot ahead and away from what is near; odometry has errors of scale and noise."""

    def __init__(self, robot, seed=0, drift=0.03):
        self.robot = robot
        self.random = np.random.default_rng(seed)
        self.odom = np.zeros(3)
        self.drift = drift
        self.turning = 0.0

    def step(self, duration=0.2):
        """Drive for a while; returns odometry, scan and true pose."""
        v, w = self._command()
        self.robot.drive(np.array([v, 0.0, w]), duration)
        v, w = self.robot.velocity[0], self.robot.velocity[2]
        noise = 1.0 + self.drift * self.random.standard_normal(2)
        step = np.array([v * duration * noise[0], 0.0, w * duration * noise[1]])
        step[2] += 0.3 * self.drift * v * duration
        self.odom = compose(self.odom, step)
        return self.odom.copy(), self.robot.scan(), self.robot.pose.copy()

    def carry(self, pose):
        """Put the robot elsewhere without odometry noticing."""
        self.robot.pose = np.array(pose, dtype=float)
        self.robot.velocity = np.zeros(3)

    def _command(self):
        pose = self.robot.pose
        angles = pose[2] + np.linspace(-0.7, 0.7, 15)
        ahead = self.robot.world.cast(pose[:2], angles, 5.0).min()
        if ahead > 0.55:
            self.turning = 0.0
            return 0.4, 0.3 * math.sin(3.0 * self.random.random())
        if self.turning == 0.0:
            self.turning = self.random.choice([-1.0, 1.0])
        return 0.0, self.turning
