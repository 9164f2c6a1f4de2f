import numpy as np
import pytest

from daidalos.description.errors import DescriptionError
from daidalos.description.markup import parse_markup
from daidalos.simulation.noise import Noise, NoiseVector, read_noise


@pytest.fixture
def random():
    return np.random.default_rng(0)


def test_settings_are_read_in_both_forms():
    new = "<noise type='gaussian'><mean>1</mean><stddev>2</stddev><bias_mean>3</bias_mean>"
    new += "<precision>0.1</precision><dynamic_bias_stddev>4</dynamic_bias_stddev>"
    new += "<dynamic_bias_correlation_time>5</dynamic_bias_correlation_time></noise>"
    assert read_noise(parse_markup(new)) == Noise(1, 2, 3, 0, 4, 5, 0.1)
    assert read_noise(parse_markup("<noise><type>gaussian</type><stddev>2</stddev></noise>")) == Noise(stddev=2)
    assert read_noise(parse_markup("<noise type='none'><stddev>2</stddev></noise>")) == Noise()
    assert read_noise(None) == Noise()
    with pytest.raises(DescriptionError, match="should not be negative"):
        read_noise(parse_markup("<noise><stddev>-1</stddev></noise>"))


def test_statistics(random):
    noisy = Noise(mean=0.5, stddev=0.2).apply(np.full(100_000, 3.0), random)
    assert noisy.mean() == pytest.approx(3.5, abs=0.01)
    assert noisy.std() == pytest.approx(0.2, rel=0.02)
    assert set(np.unique(Noise(stddev=1, precision=0.5).apply(np.zeros(1000), random) * 2)) <= set(range(-20, 20))


def test_biases_have_either_sign(random):
    biases = np.array([NoiseVector([Noise(bias_mean=0.1, bias_stddev=0.01)]).draw_bias(random)[0] for _ in range(2000)])
    assert np.abs(biases).mean() == pytest.approx(0.1, abs=0.002)
    assert np.abs(biases).std() == pytest.approx(0.01, rel=0.1)
    assert (biases > 0).mean() == pytest.approx(0.5, abs=0.05)


def test_wandering_biases_are_stationary_whatever_the_rate(random):
    """Its spread is the given one, and after one correlation time 1/e of it is left."""
    for step in (0.01, 0.2):
        vector = NoiseVector([Noise(dynamic_bias_stddev=0.3, dynamic_bias_correlation_time=1.0)] * 4000)
        bias = np.zeros(4000)
        for _ in range(round(5 / step)):
            bias = vector.wander(bias, step, random)
        assert bias.std() == pytest.approx(0.3, rel=0.05)
        later = bias
        for _ in range(round(1 / step)):
            later = vector.wander(later, step, random)
        assert np.mean(bias * later) / 0.09 == pytest.approx(np.exp(-1), abs=0.05)


def test_vectors_keep_each_numbers_settings(random):
    vector = NoiseVector([Noise(), Noise(mean=5), Noise(stddev=1), Noise(precision=0.5)])
    noisy = np.array([vector.apply(np.full(4, 0.6), np.zeros(4), random) for _ in range(2000)])
    np.testing.assert_allclose(noisy[:, 0], 0.6)
    np.testing.assert_allclose(noisy[:, 1], 5.6)
    assert noisy[:, 2].std() == pytest.approx(1, rel=0.1)
    np.testing.assert_allclose(noisy[:, 3], 0.5)
    np.testing.assert_allclose(vector.variance, [0, 0, 1, 0])
