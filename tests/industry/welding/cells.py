"""A welding robot and seams for tests."""

import numpy as np

from daidalos.industry.elasticity.deflection import Options
from daidalos.industry.elasticity.elasticity_file import read_elasticity
from daidalos.industry.robots import ARMS
from daidalos.industry.welding.correction import Cell
from daidalos.industry.welding.seam import Seam
from description.robots import SHARE

ARM = ARMS["kr500_2mt"]
ELASTICITY = read_elasticity(SHARE / "kr500_2mt_description/config/elasticity.yaml", "kr500_2mt").with_tool(120.0)
WRENCH = np.array([420.0, -175.0, 8000.0, 0.0, 0.0, 7.0])
SPEED = 0.005


def tool(length=0.8):
    out = np.eye(4)
    out[2, 3] = length
    return out


def cell(options=Options(), length=0.8):  # noqa: B008 - frozen
    return Cell(ARM, ELASTICITY, tool(length), options)


def line(count=100):
    positions = np.column_stack([np.full(count, 2.3), np.linspace(0.2, -0.2, count), np.full(count, 0.9)])
    return Seam(positions, np.tile([0.0, 0.0, 1.0], (count, 1)))


def arc(count=400, radius=0.3):
    angles = np.linspace(0.0, 1.5 * np.pi, count)
    positions = np.column_stack([2.1 + radius * np.cos(angles), radius * np.sin(angles), np.full(count, 0.9)])
    return Seam(positions, np.tile([0.0, 0.0, 1.0], (count, 1)))
