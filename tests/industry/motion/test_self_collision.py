"""Distances of YuMi's links, against MuJoCo's."""

import mujoco
import numpy as np
import pytest

from daidalos.industry.motion.self_collision import closest_links, link_names
from daidalos.industry.robots.yumi import HOME_DEG, YUMI

HOME = np.radians([HOME_DEG["left"], HOME_DEG["right"]])


def model_of(robot):
    """Return the robot's capsules as a model of MuJoCo, with geoms named by link and number."""
    spec = mujoco.MjSpec()
    for number, one in enumerate(robot.body):
        add(spec.worldbody, f"body/{number}", one)
    for side, base in robot.bases.items():
        x, y, z, w = base.orientation
        body = spec.worldbody.add_body(pos=base.position, quat=(w, x, y, z))
        for link in range(1, 8):
            body = body.add_body(pos=robot.arm.offsets[link - 1])
            body.add_joint(name=f"{side}{link}", axis=robot.arm.directions[link - 1])
            for number, one in enumerate(robot.arm.links[link]):
                add(body, f"{side} link {link}/{number}", one)
    return spec.compile()


def add(body, name, capsule):
    is_ball = capsule.start == capsule.end
    kind = mujoco.mjtGeom.mjGEOM_SPHERE if is_ball else mujoco.mjtGeom.mjGEOM_CAPSULE
    place = {"pos": capsule.start} if is_ball else {"fromto": (*capsule.start, *capsule.end)}
    body.add_geom(name=name, type=kind, size=(capsule.radius, 0, 0), mass=0.1, **place)


def test_distances_are_those_of_mujoco():
    model = model_of(YUMI)
    data = mujoco.MjData(model)
    names = link_names(YUMI)
    geoms = {name: [g for g in range(model.ngeom) if model.geom(g).name.split("/")[0] == name] for name in names}
    positions = np.random.default_rng(3).uniform(*YUMI.arm.limits.T, (50, 2, 7))
    closest = closest_links(YUMI, positions)
    for joints, distance, pair in zip(positions, closest.distances, closest.pairs, strict=True):
        data.qpos = joints.ravel()
        mujoco.mj_kinematics(model, data)
        between = [geoms[names[k]] for k in pair]
        found = min(mujoco.mj_geomDistance(model, data, a, b, 1.0, np.zeros(6)) for a in between[0] for b in between[1])
        assert distance == pytest.approx(found, abs=1e-6)


def test_the_beginning_is_free_and_crossed_arms_are_not():
    assert closest_links(YUMI, HOME).distances > 0.02
    crossed = closest_links(YUMI, np.zeros((2, 7)))
    assert crossed.distances < 0.0
    assert {link_names(YUMI)[k].split()[0] for k in crossed.pairs} == {"left", "right"}


def test_the_shape_is_checked():
    with pytest.raises(ValueError, match=r"\(7,\), but \(\.\.\., 2, 7\) is needed"):
        closest_links(YUMI, np.zeros(7))
