"""Profiles of the simulated sensor and their evaluation: edges, gap, heights and angle despite what disturbs them."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from daidalos.common.errors import UserError
from daidalos.industry.servoing.butt_joint import GAP, SEAMS, ButtJoint, seam_named
from daidalos.industry.servoing.evaluation import evaluate
from daidalos.industry.servoing.profile_sensor import COLUMNS, POINTS, Disturbances, ProfileSensor
from daidalos.industry.servoing.seam_map import SeamMap

CLEAN = Disturbances(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.02e-3)


def test_a_clean_profile() -> None:
    sensor = ProfileSensor(ButtJoint(SEAMS["line"], irregularity=0.0, mismatch=0.3e-3), disturbances=CLEAN)
    found = evaluate(sensor.measure(0.02, lateral=0.5e-3, height=2e-3, roll=0.05))
    assert found is not None
    assert found.centre == pytest.approx(1.0e-3, abs=0.03e-3)
    assert found.gap == pytest.approx(GAP, abs=0.06e-3)
    assert found.mismatch == pytest.approx(0.3e-3, abs=0.02e-3)
    assert found.height == pytest.approx(-2e-3 + 0.15e-3 - 1e-3 * math.tan(0.05), abs=0.02e-3)
    assert found.angle == pytest.approx(-0.05, abs=1e-3)
    assert found.quality > 0.9
    assert found.fp1[0] < found.fp2[0]


def test_ranges_of_the_sensor() -> None:
    sensor = ProfileSensor(ButtJoint(SEAMS["line"], irregularity=0.0), disturbances=CLEAN)
    widths = []
    for height in (0.0, 0.0229, -0.0229):
        seen = np.isfinite(sensor.measure(0.02, 1.5e-3, height))
        widths.append(float(np.ptp(COLUMNS[seen])))
    assert widths == pytest.approx([0.032, 0.039, 0.025], abs=0.1e-3)
    assert not np.isfinite(sensor.measure(0.02, 1.5e-3, 0.0235)).any()


@pytest.mark.parametrize("seed", range(3))
def test_irregular_edges_do_not_move_the_seam(seed: int) -> None:
    joint = ButtJoint(SEAMS["curve"], seed)
    sensor, seam = ProfileSensor(joint, seed), SeamMap()
    single = []
    last = math.nan
    for s in np.arange(0.0, 0.12, 0.06e-3):
        truth = float(joint.seam.lateral(np.array([s]))[0])
        found = evaluate(sensor.measure(float(s), 0.0), expected=last if s else truth)
        if found is None or abs(found.centre - (last if s else truth)) > 0.8e-3:
            continue
        last = found.centre
        single.append(found.centre - truth)
        seam.add(float(s), found.fp1[0], found.fp2[0], found.quality)
    places = np.arange(0.008, seam.known_end, 1e-3)
    errors = seam.seam(places) - joint.seam.lateral(places)
    assert np.std(single) > 0.03e-3
    assert np.std(errors) < 0.015e-3
    assert np.abs(errors).max() < 0.08e-3


def test_where_nothing_is_seen() -> None:
    assert evaluate(np.full(POINTS, math.nan)) is None
    assert evaluate(np.zeros(POINTS)) is None
    assert evaluate(np.zeros(0)) is None
    rng = np.random.default_rng(0)
    assert evaluate(rng.normal(0.0, 1e-3, POINTS), expected=0.0) is None


@given(arrays(np.float64, st.integers(0, 120), elements=st.floats(allow_nan=True, allow_infinity=True, width=32)))
def test_no_profile_breaks_the_evaluation(heights: np.ndarray) -> None:  # type: ignore[type-arg]
    found = evaluate(heights)
    assert found is None or all(math.isfinite(value) for value in (found.centre, found.gap, found.angle, found.height))


def test_an_unknown_seam_is_named() -> None:
    with pytest.raises(UserError, match="there is no seam 'curv'; did you mean 'curve'"):
        seam_named("curv")
