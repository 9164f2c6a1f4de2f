"""Calibration of tools and work objects: exact data, noise against published figures, and useless poses."""

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from daidalos.industry.calibration import CalibrationError, calibrate_tool, work_object_frame

OFFSET = np.array([0.012, -0.004, 0.183])
POINT = np.array([1.1, 0.3, 0.5])


def touches(tilt_deg: float, noise_m: float, rng: np.random.Generator) -> tuple[NDArray, NDArray]:
    """Four flange poses around the vertical, tilted to all sides, with errors in the positions."""
    headings = rng.uniform(0, 2 * np.pi) + np.arange(4) * np.pi / 2
    axes = np.column_stack([np.cos(headings), np.sin(headings), np.zeros(4)])
    tilts = np.deg2rad(rng.uniform(0.3 * tilt_deg, tilt_deg, 4))
    rotations = (Rotation.from_rotvec(axes * tilts[:, None]) * Rotation.from_euler("x", np.pi)).as_matrix()
    return POINT - rotations @ OFFSET + rng.normal(0, noise_m, (4, 3)), rotations


def test_exact_touches_give_the_exact_offset() -> None:
    found = calibrate_tool(*touches(40, 0.0, np.random.default_rng(1)))
    np.testing.assert_allclose(found.offset, OFFSET, atol=1e-12)
    np.testing.assert_allclose(found.point, POINT, atol=1e-12)
    assert found.residual_m < 1e-12


def test_wider_tilts_give_better_offsets_though_residuals_do_not_tell() -> None:
    rng = np.random.default_rng(2)
    medians, residuals = [], []
    for tilt in (30, 60):
        found = [calibrate_tool(*touches(tilt, 0.0003, rng)) for _ in range(300)]
        medians.append(np.median([np.linalg.norm(one.offset - OFFSET) for one in found]))
        residuals.append(np.median([one.residual_m for one in found]))
    assert medians[1] < 0.75 * medians[0]
    assert 0.0002 < medians[1] < medians[0] < 0.0015
    assert residuals[0] == pytest.approx(residuals[1], rel=0.2)


def test_the_deviation_is_that_of_many_trials() -> None:
    rng = np.random.default_rng(3)
    poses, rotations = touches(45, 0.0, rng)
    found = [calibrate_tool(poses + rng.normal(0, 0.0003, poses.shape), rotations) for _ in range(2000)]
    spread = np.std([one.offset for one in found], axis=0)
    told = np.sqrt(np.mean([one.deviation**2 for one in found], axis=0))
    np.testing.assert_allclose(told, spread, rtol=0.1)


def test_poses_of_one_orientation_are_refused() -> None:
    rotations = np.tile(np.eye(3), (4, 1, 1))
    with pytest.raises(CalibrationError, match="tilt the tool"):
        calibrate_tool(np.zeros((4, 3)), rotations)
    with pytest.raises(CalibrationError, match="too few"):
        calibrate_tool(np.zeros((2, 3)), rotations[:2])
    with pytest.raises(CalibrationError, match="shapes"):
        calibrate_tool(np.zeros((4, 2)), rotations)


def test_a_work_object_is_found_again() -> None:
    rng = np.random.default_rng(4)
    for _ in range(50):
        rotation, origin = Rotation.random(random_state=rng).as_matrix(), rng.normal(size=3)
        x1, x2, y1 = (origin + rotation @ np.array(place) for place in ([0.1, 0, 0], [0.7, 0, 0], [0, 0.4, 0]))
        frame = work_object_frame(x1, x2, y1)
        np.testing.assert_allclose(frame[:3, :3], rotation, atol=1e-12)
        np.testing.assert_allclose(frame[:3, 3], origin, atol=1e-12)


@pytest.mark.parametrize("third", [(0.0, 0.0, 0.0), (2.0, 0.0, 0.0), (0.5, 1e-5, 0.0)])
def test_points_on_a_line_are_refused(third: tuple[float, float, float]) -> None:
    with pytest.raises(CalibrationError, match="on one line"):
        work_object_frame((0, 0, 0), (1, 0, 0), third)
