"""All known arms by name."""

from __future__ import annotations

from daidalos.common.suggestions import hint
from daidalos.industry.robots.abb import ABB_ARMS
from daidalos.industry.robots.arm import Arm
from daidalos.industry.robots.kuka import KUKA_ARMS
from daidalos.industry.robots.redundant import RedundantArm
from daidalos.industry.robots.yumi import YUMI_ARM

ARMS = {arm.name: arm for arm in (*ABB_ARMS, *KUKA_ARMS)}
"""Known arms with a spherical wrist by name."""

REDUNDANT_ARMS: dict[str, RedundantArm] = {YUMI_ARM.name: YUMI_ARM}
"""Known arms with seven axes by name."""


def arm_named(name: str) -> Arm:
    """Return a known arm with a spherical wrist.

    Raises
    ------
    ValueError
        Where no arm has this name; the message names the nearest known ones.
    """
    found = ARMS.get(name.lower())
    if found is None and name.lower() in REDUNDANT_ARMS:
        raise ValueError(f"'{name}' has seven axes; an arm with six is needed here, such as irb120")
    if found is None:
        raise ValueError(f"there is no arm '{name}'{hint(name.lower(), (*ARMS, *REDUNDANT_ARMS))}")
    return found
