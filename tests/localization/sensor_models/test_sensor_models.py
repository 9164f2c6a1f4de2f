"""Sensor models against plain formulas, and rays against exact geometry."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from daidalos.common.pose2 import compose
from daidalos.localization.config import AmclConfig
from daidalos.localization.errors import LocalizationError
from daidalos.localization.likelihood_map import LikelihoodMap
from daidalos.localization.sensor_models.beam import BeamModel, cast_ray
from daidalos.localization.sensor_models.likelihood_field import (
    LikelihoodFieldModel,
    LikelihoodFieldProbModel,
    count_agreeing,
)
from daidalos.localization.sensor_models.sensor_model import Beams
from daidalos.mapping.grid import OccupancyGrid
from daidalos.mapping.scan import LaserScanData
from navigation.flat_world import arena
from properties import examples

from ..wandering import map_of

WORLD = arena()
MAP = LikelihoodMap(map_of(WORLD, 8.0, 6.0), 2.0)
CONFIG = AmclConfig()
MAP_CELLS = np.array([[0, 100]], dtype=np.int8)


def beams_at(pose, count=40):
    angles = np.linspace(-math.pi, math.pi, count, endpoint=False)
    sensor = np.array([-0.064, 0.0, 0.1])
    c, s = math.cos(pose[2]), math.sin(pose[2])
    origin = (pose[0] + c * sensor[0], pose[1] + s * sensor[0])
    ranges = np.minimum(WORLD.cast(origin, angles + pose[2] + sensor[2], 12.0), 12.0)
    return Beams(ranges, angles, 12.0, sensor)


def twin(pose, beams, product):
    """The likelihood field, beam by beam."""
    total = 0.0 if product else 1.0
    for distance, angle in zip(beams.ranges, beams.angles, strict=True):
        if distance >= beams.max_range:
            continue
        sx = pose[0] + math.cos(pose[2]) * beams.sensor_pose[0]
        sy = pose[1] + math.sin(pose[2]) * beams.sensor_pose[0]
        heading = pose[2] + beams.sensor_pose[2] + angle
        column = math.floor((sx + distance * math.cos(heading) - MAP.origin[0]) / MAP.resolution)
        row = math.floor((sy + distance * math.sin(heading) - MAP.origin[1]) / MAP.resolution)
        inside = 0 <= column < MAP.distance.shape[1] and 0 <= row < MAP.distance.shape[0]
        away = float(MAP.distance[row, column]) if inside else 2.0
        p = 0.5 * math.exp(-0.5 * (away / 0.2) ** 2) + 0.5 / 12.0
        total += math.log(p) if product else p**3
    return math.exp(total) if product else total


@pytest.mark.slow
@examples(30)
@given(x=st.floats(0.3, 7.7), y=st.floats(0.3, 5.7), yaw=st.floats(-3.1, 3.1), product=st.booleans())
def test_likelihood_fields_follow_their_formula(x, y, yaw, product):
    beams = beams_at((1.5, 1.5, 0.4))
    model = LikelihoodFieldProbModel(CONFIG) if product else LikelihoodFieldModel(CONFIG)
    pose = np.array([x, y, yaw])
    likelihood = model.likelihoods(pose[None], beams, MAP)[0]
    assert likelihood == pytest.approx(twin(pose, beams, product), rel=1e-6)


@pytest.mark.parametrize("model", [LikelihoodFieldModel, LikelihoodFieldProbModel, BeamModel])
@pytest.mark.parametrize("truth", [(1.5, 1.5, 0.4), (6.5, 3.8, -2.0), (4.5, 5.4, 1.5)])
def test_the_truth_is_more_likely_than_other_poses(model, truth):
    generator = np.random.default_rng(0)
    others = MAP.draw_poses(300, generator)
    particles = np.concatenate([np.array([truth]), others])
    likelihoods = model(CONFIG).likelihoods(particles, beams_at(truth), MAP)
    near = np.hypot(*(others[:, :2] - truth[:2]).T) < 0.3
    assert likelihoods[0] > likelihoods[1:][~near].max()


@examples(100)
@given(x=st.floats(0.4, 2.7), y=st.floats(0.3, 2.3), angle=st.floats(-math.pi, math.pi))
def test_rays_end_at_the_first_occupied_cell(x, y, angle):
    along = np.arange(0.0, 10.0, 0.001)
    columns = np.floor((x + along * math.cos(angle) - MAP.origin[0]) / MAP.resolution).astype(int)
    rows = np.floor((y + along * math.sin(angle) - MAP.origin[1]) / MAP.resolution).astype(int)
    inside = (rows >= 0) & (columns >= 0) & (rows < MAP.distance.shape[0]) & (columns < MAP.distance.shape[1])
    hit = np.zeros(along.size, dtype=bool)
    hit[inside] = MAP.distance[rows[inside], columns[inside]] == 0.0
    first = along[np.argmax(hit)]
    # The corner of a cell that the ray is in for less than half of a cell may be stepped over.
    through = np.convolve(hit, np.ones(30), "valid") == 30
    certain = along[np.argmax(through)]
    length = cast_ray(MAP.distance, MAP.resolution, *MAP.to_cells(np.array([[x, y, angle]]))[0], 12.0)
    assert first - 0.002 <= length <= certain + 0.03


def test_a_ray_that_leaves_the_map_is_as_long_as_can_be():
    assert cast_ray(MAP.distance, 0.05, 0.2, 0.2, -2.0, 9.0) == 9.0


def test_beams_are_spread_over_the_scan_and_useless_ones_left_out():
    ranges = np.full(181, 3.0)
    ranges[0], ranges[180], ranges[90], ranges[3] = math.nan, math.inf, 0.01, -1.0
    scan = LaserScanData(ranges, -1.0, 0.01, 0.1, 20.0, 0.0, (0.1, 0.0, 0.0))
    beams = Beams.of_scan(scan, AmclConfig(max_beams=3))
    assert beams.ranges.tolist() == [20.0]
    assert beams.angles.tolist() == pytest.approx([0.8])
    everything = Beams.of_scan(scan, AmclConfig(max_beams=500))
    assert everything.ranges.size == 178
    assert Beams.of_scan(scan, AmclConfig(max_beams=500, laser_max_range=2.5)).ranges.max() == 2.5


def test_beams_of_a_lidar_mounted_upside_down_go_the_other_way_round():
    ranges = np.linspace(1.0, 3.0, 21)
    upright = LaserScanData(ranges, -1.0, 0.1, 0.1, 20.0, 0.0, (0.1, 0.0, 0.5))
    inverted = LaserScanData(ranges, -1.0, 0.1, 0.1, 20.0, 0.0, (0.1, 0.0, 0.5), (math.pi, 0.0))
    assert np.allclose(Beams.of_scan(inverted, CONFIG).angles, -Beams.of_scan(upright, CONFIG).angles)
    pitched = LaserScanData(ranges, -1.0, 0.1, 0.1, 20.0, 0.0, (0.1, 0.0, 0.5), (0.0, 0.2))
    ahead = Beams.of_scan(pitched, CONFIG).ranges[10]
    assert ahead == pytest.approx(2.0 * math.cos(0.2))


def test_a_scan_without_beams():
    empty = Beams.of_scan(LaserScanData(np.zeros(0), 0.0, 0.1), CONFIG)
    assert empty.ranges.size == 0


def grid(value, yaw=0.0):
    return OccupancyGrid(np.full((4, 4), value, dtype=np.int8), 0.1, (0.0, 0.0, yaw))


@pytest.mark.parametrize(("bad", "words"), [(grid(0), "no obstacle"), (grid(100), "no free"), (grid(-1), "no free")])
def test_maps_without_contrast_are_refused(bad, words):
    with pytest.raises(LocalizationError, match=words):
        LikelihoodMap(bad, 2.0)


@pytest.mark.parametrize("model", [LikelihoodFieldModel, LikelihoodFieldProbModel, BeamModel])
def test_a_turned_map_weighs_turned_poses_alike(model):
    straight = map_of(WORLD, 8.0, 6.0)
    turn = np.array([3.0, -1.0, 0.7])
    turned = OccupancyGrid(straight.data, straight.resolution, tuple(compose(turn, np.array(straight.origin))))
    poses = MAP.draw_poses(50, np.random.default_rng(1))
    beams = beams_at((1.5, 1.5, 0.4))
    expected = model(CONFIG).likelihoods(poses, beams, MAP)
    found = model(CONFIG).likelihoods(compose(turn, poses), beams, LikelihoodMap(turned, 2.0))
    # Rounding may put single beams into the next cell.
    assert np.median(np.abs(found / expected - 1.0)) < 0.01
    free = LikelihoodMap(turned, 2.0)
    assert all(free.contains(pose) for pose in free.draw_poses(50, np.random.default_rng(2)))
    assert not free.contains(np.array([0.0, 10.0]))


@pytest.mark.parametrize(
    "bad", [OccupancyGrid(MAP_CELLS, 0.0, (0, 0, 0)), OccupancyGrid(MAP_CELLS, 0.1, (np.nan, 0, 0))]
)
def test_maps_without_a_place_or_scale_are_refused(bad):
    with pytest.raises(LocalizationError, match="resolution above 0"):
        LikelihoodMap(bad, 2.0)


def test_beams_that_most_particles_cannot_explain_are_skipped():
    beams = beams_at((1.5, 1.5, 0.4))
    blocked = Beams(np.where(np.arange(40) < 15, 0.5, beams.ranges), beams.angles, 12.0, beams.sensor_pose)
    generator = np.random.default_rng(0)
    particles = np.array([1.5, 1.5, 0.4]) + generator.normal(0.0, 0.01, (200, 3))
    skipping = AmclConfig(do_beamskip=True)
    seen = Beams(beams.ranges[15:], beams.angles[15:], 12.0, beams.sensor_pose)
    with_skip = LikelihoodFieldProbModel(skipping).likelihoods(particles, blocked, MAP)
    agreeing = count_agreeing(MAP.to_cells(particles), blocked.ends / MAP.resolution, MAP.distance, 0.5) / 200
    assert (agreeing[15:] > 0.3).all()
    kept = agreeing > 0.3
    expected = LikelihoodFieldProbModel(CONFIG).likelihoods(
        particles, Beams(blocked.ranges[kept], blocked.angles[kept], 12.0, beams.sensor_pose), MAP
    )
    assert np.allclose(with_skip, expected)
    # Nothing is left out where nearly everything would be, or where the particles are spread.
    all_blocked = Beams(np.full(40, 0.2), beams.angles, 12.0, beams.sensor_pose)
    config = AmclConfig(do_beamskip=True, beam_skip_distance=0.01, beam_skip_error_threshold=0.5)
    for model_beams, poses in ((all_blocked, particles), (seen, particles * [2.0, 1.0, 1.0])):
        whole = LikelihoodFieldProbModel(CONFIG).likelihoods(poses, model_beams, MAP)
        assert np.allclose(LikelihoodFieldProbModel(config).likelihoods(poses, model_beams, MAP), whole)


def test_a_product_of_many_unlikely_beams_does_not_vanish():
    ranges, angles = np.full(400, 5.0), np.linspace(-3.0, 3.0, 400)
    config = AmclConfig(z_hit=0.99, z_rand=0.01)
    likelihoods = LikelihoodFieldProbModel(config).likelihoods(
        MAP.draw_poses(50, np.random.default_rng(3)), Beams(ranges, angles, 100.0, np.zeros(3)), MAP
    )
    assert np.isfinite(likelihoods).all()
    assert likelihoods.max() > 0.0


def test_poses_are_drawn_in_free_cells():
    data = np.full((4, 5), -1, dtype=np.int8)
    data[1, 2], data[3, 4], data[0, 0] = 0, 0, 100
    world = LikelihoodMap(OccupancyGrid(data, 0.5, (10.0, 20.0, 0.0)), 2.0)
    drawn = world.draw_poses(500, np.random.default_rng(0))
    cells = {(math.floor((x - 10.0) / 0.5), math.floor((y - 20.0) / 0.5)) for x, y, _ in drawn}
    assert cells == {(2, 1), (4, 3)}
    assert drawn[:, 2].std() == pytest.approx(2.0 * math.pi / math.sqrt(12.0), rel=0.1)
