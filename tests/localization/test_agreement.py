"""Agreement of scans with a map: a robot that is carried away is noticed; people around it are not taken for that."""

import dataclasses

import numpy as np
import pytest

from daidalos.localization.agreement import LOST_SCANS, Agreement, LostDetector, agreement_of
from daidalos.localization.amcl import Amcl
from daidalos.localization.config import AmclConfig
from daidalos.localization.likelihood_map import LikelihoodMap
from daidalos.localization.sensor_models.sensor_model import Beams
from daidalos.mapping.grid import OccupancyGrid
from daidalos.mapping.scan import LaserScanData

from .test_amcl import MAP, NEAR, START, wandering_from_start

AGREES, DISAGREES = Agreement(0.95, 0.0), Agreement(0.2, 0.3)


@pytest.fixture
def room():
    """A room of 4 m by 2 m around the origin."""
    data = np.zeros((40, 80), dtype=np.int8)
    data[0], data[-1], data[:, 0], data[:, -1] = 100, 100, 100, 100
    return LikelihoodMap(OccupancyGrid(data, 0.05, (-2.0, -1.0, 0.0)), 2.0)


def beams_of(ranges, max_range=10.0):
    count = len(ranges)
    scan = LaserScanData(np.array(ranges), 0.0, 2 * np.pi / count, 0.05, max_range)
    return Beams.of_scan(scan, AmclConfig(max_beams=count))


@pytest.mark.parametrize(
    ("ranges", "expected"),
    [
        ([1.95, 0.95, 1.95, 0.95], (1.0, 0.0)),
        ([1.0, 0.95, 1.95, 0.95], (0.75, 0.0)),  # something stands in the way
        ([1.95, 0.95, 4.0, 0.95], (0.75, 0.25)),  # through a wall
        ([1.95, 0.95, 10.0, 0.95], (1.0, 0.25)),  # nothing where a wall should be
    ],
)
def test_beams_are_explained_or_contradict(room, ranges, expected):
    agreement = agreement_of(np.zeros(3), beams_of(ranges), room)
    assert (agreement.explained, agreement.contradicted) == expected


def test_a_scan_without_ends_says_nothing(room):
    assert agreement_of(np.zeros(3), beams_of([10.0, 10.0]), room) is None


def test_a_pose_is_lost_only_after_it_was_known():
    detector = LostDetector()
    for _ in range(100):
        detector.add(DISAGREES)
    assert not detector.is_lost
    for _ in range(100):
        detector.add(AGREES)
    for _ in range(LOST_SCANS):
        assert not detector.is_lost
        detector.add(DISAGREES)
    assert detector.is_lost
    detector.add(AGREES)
    assert not detector.is_lost


def test_what_a_narrow_scan_sees_may_be_a_person():
    detector = LostDetector()
    for _ in range(100):
        detector.add(dataclasses.replace(AGREES, is_wide=False))
    for _ in range(100):
        detector.add(Agreement(0.05, 0.0, is_wide=False))
    assert not detector.is_lost


def localized(seed):
    filter_ = Amcl(AmclConfig(), MAP, seed)
    filter_.initialize(START, NEAR)
    wanderer = wandering_from_start(seed)
    return filter_, wanderer


@pytest.mark.slow
@pytest.mark.parametrize("seed", [1, 2])
def test_people_around_a_robot_do_not_make_it_lost(seed):
    filter_, wanderer = localized(seed)
    random = np.random.default_rng(seed)
    for _ in range(150):
        odometry, scan, _ = wanderer.step()
        first = int(random.integers(180))
        around = (np.arange(180) - first) % 180 < 80  # people stand on 160 degrees
        ranges = np.where(around, np.minimum(scan.ranges, 0.6), scan.ranges)
        assert not filter_.update(odometry, dataclasses.replace(scan, ranges=ranges)).lost


@pytest.mark.slow
@pytest.mark.parametrize("seed", [1, 2])
def test_a_robot_that_is_carried_away_is_lost_until_it_is_told_where_it_is(seed):
    filter_, wanderer = localized(seed)
    for _ in range(100):
        odometry, scan, _ = wanderer.step()
        assert not filter_.update(odometry, scan).lost
    wanderer.carry((6.5, 3.8, 2.0))
    states = []
    for _ in range(LOST_SCANS):
        odometry, scan, truth = wanderer.step()
        states.append(filter_.update(odometry, scan).lost)
    assert states == [False] * (LOST_SCANS - 1) + [True]
    filter_.initialize(truth, NEAR)
    odometry, scan, _ = wanderer.step()
    assert not filter_.update(odometry, scan).lost
