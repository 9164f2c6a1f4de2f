"""The goals of a trial."""

import numpy as np
import pytest
from scipy import ndimage

from daidalos.description.footprint import Footprint
from daidalos.nodes.daidalos_demo.trial import _CLEARANCE_M, choose_goals


@pytest.fixture
def plan() -> Footprint:
    """A room of 8 m by 6 m with a pillar, and a closed chamber."""
    occupied = np.zeros((120, 160), bool)
    occupied[[0, -1]] = occupied[:, [0, -1]] = True
    occupied[70:80, 100:110] = True
    occupied[90:, 130] = occupied[90, 130:] = True
    return Footprint(occupied, 0.05, np.array([-4.0, -3.0]))


@pytest.mark.parametrize("seed", range(5))
def test_goals_are_reachable_clear_and_spread(plan: Footprint, seed: int) -> None:
    goals = choose_goals(plan, 3, seed)
    clearance = ndimage.distance_transform_edt(~plan.occupied) * plan.resolution
    places = np.array([goal[:2] for goal in goals])
    for x, y in places:
        column, row = ((np.array([x, y]) - plan.origin) / plan.resolution).astype(int)
        assert clearance[row, column] >= _CLEARANCE_M
        assert not (x > 2.5 and y > 1.5), "the closed chamber cannot be reached"
    everywhere = np.vstack([np.zeros(2), places])
    distances = np.linalg.norm(everywhere[:, None] - everywhere[None], axis=-1)
    assert distances[np.triu_indices(4, 1)].min() > 1.5


def test_the_seed_decides(plan: Footprint) -> None:
    np.testing.assert_array_equal(choose_goals(plan, 3, 1), choose_goals(plan, 3, 1))
    assert not np.array_equal(choose_goals(plan, 3, 1), choose_goals(plan, 3, 2))
