"""ABB's arms: the dimensions, ranges and speeds of the product specifications that each names."""

from __future__ import annotations

from daidalos.industry.robots.arm import Arm, Axis

ABB_ARMS = (
    Arm(
        name="irb120",
        title="ABB IRB 120-3/0.6",
        base_height=0.29,
        shoulder_offset=0.0,
        lower_arm=0.27,
        elbow_offset=0.07,
        forearm=0.302,
        flange=0.072,
        axes=(
            Axis.from_degrees(-165, 165, 250),
            Axis.from_degrees(-110, 110, 250),
            Axis.from_degrees(-110, 70, 250),
            Axis.from_degrees(-160, 160, 320),
            Axis.from_degrees(-120, 120, 320),
            Axis.from_degrees(-400, 400, 420),
        ),
        payload=3.0,
        mass=25.0,
        reach=0.58,
        source="ABB product specification IRB 120, 3HAC035960-001",
    ),
    Arm(
        name="irb1600",
        title="ABB IRB 1600-6/1.45",
        base_height=0.4865,
        shoulder_offset=0.15,
        lower_arm=0.7,
        elbow_offset=0.0,
        forearm=0.6,
        flange=0.065,
        axes=(
            Axis.from_degrees(-180, 180, 150),
            Axis.from_degrees(-90, 120, 160),
            Axis.from_degrees(-245, 65, 170),
            Axis.from_degrees(-200, 200, 320),
            Axis.from_degrees(-115, 115, 400),
            Axis.from_degrees(-400, 400, 460),
        ),
        payload=6.0,
        mass=250.0,
        reach=1.45,
        source="ABB product specification IRB 1600, 3HAC023604-001",
    ),
    Arm(
        name="irb6700",
        title="ABB IRB 6700-150/3.20",
        base_height=0.78,
        shoulder_offset=0.32,
        lower_arm=1.28,
        elbow_offset=0.2,
        forearm=1.5925,
        flange=0.2,
        axes=(
            Axis.from_degrees(-170, 170, 100),
            Axis.from_degrees(-65, 85, 90),
            Axis.from_degrees(-180, 70, 90),
            Axis.from_degrees(-300, 300, 170),
            Axis.from_degrees(-130, 130, 120),
            Axis.from_degrees(-360, 360, 190),
        ),
        payload=150.0,
        mass=1280.0,
        reach=3.20,
        source="ABB product specification IRB 6700, 3HAC044265-001",
    ),
)
