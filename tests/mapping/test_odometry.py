import numpy as np
import pytest

from daidalos.mapping.odometry import MIN_SHARE, Accuracy, Drift, assumed_deviation

STEP = Drift(1.0, 0.0)
ASSUMED = assumed_deviation(1.0, 0.0)[1]


def after(turns: np.ndarray) -> Accuracy:
    accuracy = Accuracy()
    for turn in turns.tolist():
        accuracy = accuracy.after(turn, STEP)
    return accuracy


@pytest.mark.parametrize("deviation", [0.01, 0.05, 0.2])
def test_the_accuracy_of_headings_is_learned(deviation: float) -> None:
    accuracy = after(deviation * np.random.default_rng(0).standard_normal(400))
    assert accuracy.rotation * ASSUMED == pytest.approx(deviation, rel=0.25)
    learned = 1.0 / np.sqrt(accuracy.information(1.0, 0.0)[2, 2])
    assert learned == pytest.approx(accuracy.rotation * ASSUMED)


def test_positions_stay_as_uncertain_as_assumed() -> None:
    information = after(np.zeros(300)).information(2.0, 0.5)
    assert 1.0 / np.sqrt(np.diag(information)[:2]) == pytest.approx(assumed_deviation(2.0, 0.5)[0])


def test_odometry_is_never_taken_for_exact() -> None:
    assert after(np.zeros(3000)).rotation == MIN_SHARE


def test_one_slip_of_a_wheel_changes_little() -> None:
    steps = 0.01 * np.random.default_rng(0).standard_normal(300)
    slipped = np.append(steps, 2.0)
    assert after(slipped).rotation < 1.1 * after(steps).rotation
