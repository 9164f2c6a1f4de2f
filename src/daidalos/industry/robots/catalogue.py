"""All known arms by name."""

from __future__ import annotations

from daidalos.common.suggestions import hint
from daidalos.industry.robots.abb import ABB_ARMS
from daidalos.industry.robots.arm import Arm
from daidalos.industry.robots.kuka import KUKA_ARMS

ARMS = {arm.name: arm for arm in (*ABB_ARMS, *KUKA_ARMS)}
"""Known arms by name."""


def arm_named(name: str) -> Arm:
    """Return a known arm.

    Raises
    ------
    ValueError
        Where no arm has this name; the message names the nearest known ones.
    """
    found = ARMS.get(name.lower())
    if found is None:
        raise ValueError(f"there is no arm '{name}'{hint(name.lower(), ARMS)}")
    return found
