import numpy as np
import pytest

from daidalos.common.kernels import KERNELS, warm_up
from daidalos.mapping.slam import Slam

from .worlds import Lidar, arena, drive, room_scan, wheel_odometry


@pytest.mark.slow
def test_nothing_is_left_to_compile_for_slam() -> None:
    """No kernel meets types that it has not met before, in a run with turns, closures and a map."""
    warm_up("daidalos.mapping")
    before = {kernel.py_func.__qualname__: list(kernel.signatures) for kernel in KERNELS}
    rng = np.random.default_rng(0)
    true = drive(np.array([[-3.0, -2.3], [3.0, -2.3], [3.2, 2.2], [-3.0, 2.3], [-3.0, -2.0], [2.0, -2.0]]), rate=5.0)
    odometry = wheel_odometry(true, rng)
    slam = Slam()
    closed = 0
    for k, pose in enumerate(true):
        closed += slam.add_scan(k * 200_000_000, Lidar(beams=240).scan(arena(), pose, rng), odometry[k]).closed
        slam.grid(5)
    slam.add_scan(10**12, room_scan([2.0, -2.0, 0.0]), tuple(odometry[-1]))
    slam.finish()
    assert closed > 0
    assert {kernel.py_func.__qualname__: list(kernel.signatures) for kernel in KERNELS} == before
