"""Industrial robots: dimensions, limits and speeds of arms with a spherical wrist."""

from daidalos.industry.robots.abb import ARMS, arm_named
from daidalos.industry.robots.arm import Arm, Axis

__all__ = ["ARMS", "Arm", "Axis", "arm_named"]
