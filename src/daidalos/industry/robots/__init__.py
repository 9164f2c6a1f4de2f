"""Industrial robots: dimensions, limits and speeds of arms."""

from daidalos.industry.robots.arm import Arm, Axis
from daidalos.industry.robots.catalogue import ARMS, REDUNDANT_ARMS, arm_named

__all__ = ["ARMS", "REDUNDANT_ARMS", "Arm", "Axis", "arm_named"]
