"""Effects on pictures, against plain formulas."""

import numpy as np
import pytest

from daidalos.simulation.rendering.image_effects import add_noise


@pytest.mark.parametrize(("size", "start"), [(10, 0), (10, 7), (1000, 999), (5000, 0)])
def test_noise_goes_around_its_table(size: int, start: int) -> None:
    random = np.random.default_rng(3)
    picture = random.integers(0, 256, 1234).astype(np.uint8)
    table = random.normal(0.0, 60.0, size).astype(np.float32)
    values = picture + table[(start + np.arange(len(picture))) % size]
    add_noise(picture, table, start)
    assert np.array_equal(picture, (np.clip(values, 0, 255) + np.float32(0.5)).astype(np.uint8))
