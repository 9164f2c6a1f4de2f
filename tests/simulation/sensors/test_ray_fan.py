"""Rays cast sector by sector."""

import mujoco
import numpy as np
import pytest

from daidalos.common.pose3 import Pose, quaternion_from_rpy, rotation_matrix
from daidalos.description import sdf
from daidalos.simulation import Simulation
from daidalos.simulation.conversion.geometry import RAY_GROUPS
from daidalos.simulation.sensors.ray_fan import BODIES_PER_SECTOR, RayFan

SHAPES = (
    "<box><size>0.4 0.2 1.0</size></box>",
    "<sphere><radius>0.3</radius></sphere>",
    "<cylinder><radius>0.2</radius><length>0.8</length></cylinder>",
)
GROUND = "<plane><normal>0 0 1</normal></plane>"
FANS = {
    "scan": (np.linspace(-np.pi, np.pi, 360), np.zeros(1)),
    "rings": (np.linspace(-2.0, 2.5, 90), np.linspace(-0.6, 0.4, 8)),
    "one ray": (np.zeros(1), np.zeros(1)),
    "two turns": (np.linspace(-2 * np.pi, 2 * np.pi, 200), np.zeros(1)),
}


def model(geometry: str, static: bool = False) -> str:
    return (
        f"<sdf version='1.9'><model name='m'><static>{str(static).lower()}</static><link name='l'>"
        f"<collision name='c'><geometry>{geometry}</geometry></collision></link></model></sdf>"
    )


@pytest.fixture(scope="module")
def crowd() -> Simulation:
    """Return a world of bodies at random places, with a ground."""
    random = np.random.default_rng(7)
    simulation = Simulation()
    simulation.spawn(sdf.parse_model(model(GROUND, static=True)), "ground")
    for number in range(4 * BODIES_PER_SECTOR):
        x, y, z = random.uniform((-6, -6, -1), (6, 6, 2)).tolist()
        turn = quaternion_from_rpy(*random.uniform(-3, 3, 3).tolist())
        simulation.spawn(sdf.parse_model(model(SHAPES[number % 3])), f"m{number}", Pose((x, y, z), turn))
    simulation.physics.refresh_positions()
    return simulation


@pytest.mark.parametrize("name", FANS)
@pytest.mark.parametrize("seed", range(5))
def test_sectors_see_what_all_rays_at_once_see(crowd: Simulation, name: str, seed: int) -> None:
    random = np.random.default_rng(seed)
    physics = crowd.physics
    fan = RayFan(*FANS[name])
    fan.bind(physics.model)
    origin = random.uniform(-4, 4, 3)
    level = 0.0 if seed == 0 else 1.0
    rotation = rotation_matrix(quaternion_from_rpy(*(random.uniform(-3, 3, 3) * (level, level, 1.0)).tolist()))
    before = physics.model.body_geomnum.copy(), physics.model.body_bvhadr.copy()
    distances, geoms = fan.cast(physics, origin, rotation, 0, 8.0)
    assert np.array_equal(physics.model.body_geomnum, before[0])
    assert np.array_equal(physics.model.body_bvhadr, before[1])
    rays = np.ascontiguousarray(fan.directions @ rotation.T)
    expected, hit = np.empty(len(rays)), np.empty(len(rays), dtype=np.int32)
    mujoco.mj_multiRay(
        physics.model, physics.data, origin, rays.ravel(), RAY_GROUPS, True, 0, hit, expected, None, len(rays), 8.0
    )
    assert np.array_equal(distances, expected)
    assert np.array_equal(geoms, hit)
    assert name == "one ray" or seed == 0 or (geoms >= 0).any()
