"""ABB's YuMi: dimensions, ranges and speeds of its arms, and the places of the arms on its body.

Lengths between the axes reproduce poses that RobotStudio prints; the places of the arms' bases are those of the public
description of YuMi by Oerebro University, made symmetrical. Capsules enclose the shapes of `irb14000_description`.
"""

from __future__ import annotations

from daidalos.common.pose3 import Pose, quaternion_from_rpy
from daidalos.industry.robots.arm import Axis
from daidalos.industry.robots.redundant import Capsule, RedundantArm, TwoArmedRobot

_X, _Y, _Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)

YUMI_ARM = RedundantArm(
    name="irb14000",
    title="ABB IRB 14000 YuMi",
    offsets=(
        (0.0, 0.0, 0.0),
        (-0.03, 0.0, 0.1),
        (0.03, 0.0, 0.0),
        (0.0405, 0.0, 0.2515),
        (0.0, 0.0, 0.0405),
        (0.265, 0.0, -0.027),
        (0.0, 0.0, 0.027),
        (0.036, 0.0, 0.0),
    ),
    directions=(_Z, _Y, _Z, _Y, _X, _Y, _X),
    numbers=(1, 2, 7, 3, 4, 5, 6),
    axes=(
        Axis.from_degrees(-168.5, 168.5, 180),
        Axis.from_degrees(-143.5, 43.5, 180),
        Axis.from_degrees(-168.5, 168.5, 180),
        Axis.from_degrees(-123.5, 80, 180),
        Axis.from_degrees(-290, 290, 400),
        Axis.from_degrees(-88, 138, 400),
        Axis.from_degrees(-229, 229, 400),
    ),
    shoulder=(0.0, 0.0, 0.1),
    elbow_axis=3,
    wrist_axis=6,
    links=(
        (),
        (Capsule((0.0, 0.0, 0.0), (0.0, 0.0, 0.08), 0.055),),
        (Capsule((0.03, 0.0, 0.0), (0.03, 0.0, 0.1), 0.055),),
        (Capsule((0.0, 0.0, 0.12), (0.02, 0.0, 0.23), 0.05),),
        (Capsule((0.0, 0.0, 0.02), (0.06, 0.0, 0.0405), 0.05),),
        (Capsule((0.08, 0.0, 0.0), (0.23, 0.0, -0.015), 0.042),),
        (Capsule((-0.02, 0.0, 0.0135), (0.0, 0.0, 0.027), 0.04),),
        (
            Capsule((0.0, 0.0, 0.0), (0.02, 0.0, 0.0), 0.032),
            Capsule((0.075, 0.0, 0.0), (0.08, 0.0, 0.0), 0.046),
            Capsule((0.13, 0.0, 0.0), (0.158, 0.0, 0.0), 0.016),
        ),
    ),
    payload=0.5,
    mass=9.6,
    reach=0.559,
    source="ABB product specification IRB 14000, 3HAC052982-001",
)

YUMI = TwoArmedRobot(
    name="irb14000",
    title="ABB IRB 14000 YuMi",
    arm=YUMI_ARM,
    bases={
        "left": Pose((0.05355, 0.0725, 0.41492), quaternion_from_rpy(-0.9788, 0.5699, -0.8248)),
        "right": Pose((0.05355, -0.0725, 0.41492), quaternion_from_rpy(0.9788, 0.5699, 0.8248)),
    },
    body=(
        Capsule((-0.06, 0.0, 0.1), (-0.03, 0.0, 0.42), 0.1),
        Capsule((-0.05, -0.09, 0.08), (-0.05, 0.09, 0.08), 0.08),
    ),
    free_links=2,
)

HOME_DEG = {"left": (0.0, -130.0, 135.0, 30.0, 0.0, 40.0, 0.0), "right": (0.0, -130.0, -135.0, 30.0, 0.0, 40.0, 0.0)}
"""Angles [deg] with which the arms begin, from the base: those of ABB's synchronisation position."""

GRIPPER_LENGTH = 0.126
"""From tool0 along its z axis to the middle of the fingers' grip [m]."""
