"""Conversion of a world's physics settings to MuJoCo's options."""

from __future__ import annotations

import math
from typing import Any

import mujoco

from daidalos.description.world import Physics, World

SLEEP_SPEED = 1e-5
"""Speed [m/s] below which a body that keeps it for ten steps falls asleep."""

MAX_STEP_NS = 1_000_000
"""Longer steps are cut into parts: contacts this stiff need 1 ms."""


def physics_step(physics: Physics) -> tuple[int, int]:
    """Return the world's step in nanoseconds and its number of substeps."""
    step_ns = max(1000, round(physics.max_step_size * 1e9))
    parts = math.ceil(step_ns / MAX_STEP_NS)
    return step_ns // parts * parts, parts


def set_options(spec: Any, world: World, timestep: float) -> None:
    """Set the integration options of a world.

    With implicit integration of velocity servos, elliptic friction cones and a high ratio of friction
    to normal impedance, wheels roll true; see the tests for how true.

    Parameters
    ----------
    spec : MjSpec
    world : World
    timestep : float
        [s].
    """
    spec.modelname = world.name
    spec.compiler.degree = False
    spec.compiler.autolimits = True
    option = spec.option
    option.timestep = timestep
    option.gravity = list(world.gravity)
    option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    option.impratio = 10.0
    option.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_AUTORESET)
    # Bodies at rest are not simulated until something touches them, so that cluttered worlds are cheap.
    option.enableflags |= int(mujoco.mjtEnableBit.mjENBL_SLEEP)
    option.sleep_tolerance = SLEEP_SPEED
