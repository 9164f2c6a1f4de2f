"""Industrial robots: dimensions, limits and speeds of arms with a spherical wrist."""

from daidalos.industry.robots.arm import Arm, Axis
from daidalos.industry.robots.catalogue import ARMS, arm_named

__all__ = ["ARMS", "Arm", "Axis", "arm_named"]
