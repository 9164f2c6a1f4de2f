import numpy as np
import pytest

from daidalos.common.pose2 import move_along_arc
from daidalos.navigation.controllers.teb.band import Band

PATH = np.stack([np.linspace(0.0, 2.0, 41), np.zeros(41), np.zeros(41)], axis=-1)


def test_a_band_along_a_path_has_its_poses_and_the_times_between_them():
    band = Band.along(PATH, 0.5, 1.0, 3)
    assert band.poses == pytest.approx(PATH)
    assert band.times == pytest.approx(np.full(40, 0.1))


def test_a_band_of_one_pose_turns():
    ends = np.array([[1.0, 1.0, 3.0], [1.0, 1.0, -3.0]])
    band = Band.along(ends, 0.5, 0.5, 5)
    assert len(band.poses) == 5
    assert band.times.sum() == pytest.approx((2 * np.pi - 6.0) / 0.5)
    assert band.poses[:, :2] == pytest.approx(np.ones((5, 2)))


def test_backwards_the_poses_look_the_other_way():
    band = Band.along(-PATH, 0.5, 1.0, 3, backward=True)
    assert np.cos(band.poses[:, 2]) == pytest.approx(np.ones(41))


def test_the_number_of_poses_follows_the_times():
    band = Band.along(PATH, 0.5, 1.0, 3)
    band.resize(0.3, 0.1, 3, 100)
    assert band.times.sum() == pytest.approx(4.0)
    assert np.all((band.times >= 0.2 - 1e-9) & (band.times <= 0.4 + 1e-9))
    band.resize(0.03, 0.01, 3, 50)
    assert len(band.poses) == 50
    assert band.times.sum() == pytest.approx(4.0)


def test_what_was_passed_is_dropped():
    band = Band.along(PATH, 0.5, 1.0, 3)
    band.follow(np.array([0.21, 0.02, 0.1]), np.array([2.1, 0.0, 0.0]))
    assert len(band.poses) == 37
    assert len(band.times) == 36
    assert band.poses[0] == pytest.approx([0.21, 0.02, 0.1])
    assert band.poses[-1] == pytest.approx([2.1, 0.0, 0.0])


@pytest.mark.parametrize("velocity", [(0.3, 0.0), (-0.2, 0.5), (0.0, 1.0), (0.4, -0.8)])
def test_the_velocity_leads_to_the_next_pose(velocity):
    speed, turn = velocity
    poses = [np.array([1.0, 2.0, 0.5])]
    for _ in range(4):
        poses.append(move_along_arc(poses[-1], speed * 0.3, turn * 0.3))
    band = Band(np.array(poses), np.full(4, 0.3))
    for ahead in (1, 3):
        assert band.velocity(ahead, exact=True) == pytest.approx([speed, 0.0, turn], abs=1e-9)
