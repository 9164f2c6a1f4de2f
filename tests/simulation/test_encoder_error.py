import numpy as np
import pytest

from daidalos.simulation.encoder_error import EncoderError


@pytest.mark.parametrize("pieces", [10, 1000])
def test_encoder_noise_does_not_depend_on_the_rate(pieces):
    random = np.random.default_rng(0)
    error = EncoderError(noise=0.01)
    ends = sum(error.measure(np.full(4000, 4.0 / pieces), random) for _ in range(pieces))
    assert ends.mean() == pytest.approx(4, abs=0.002)
    assert ends.std() == pytest.approx(0.01 * 2, rel=0.05)


def test_slip_scales_and_rest_is_silent():
    random = np.random.default_rng(0)
    assert EncoderError(slip=0.1).measure(np.array([2.0]), random) == pytest.approx([2.2])
    assert EncoderError(noise=1.0).measure(np.zeros(2), random).tolist() == [0, 0]
