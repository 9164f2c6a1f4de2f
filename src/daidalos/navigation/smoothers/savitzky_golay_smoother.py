"""Savitzky-Golay smoother: each point moves to where a polynomial through its neighbours passes."""

from dataclasses import dataclass

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.parameters import ParameterError, Parameters, parameter
from daidalos.navigation.contracts import Smoother
from daidalos.navigation.costmap.costmap import Costmap
from daidalos.navigation.smoothers.parts import smooth_parts


@dataclass(frozen=True)
class SavitzkyGolaySmootherParameters(Parameters):
    """Parameters of the smoother, by their Nav2 names."""

    window_size: int = parameter(7, "Number of points that a polynomial is fitted to; odd.", minimum=3)
    poly_order: int = parameter(3, "Degree of the polynomial.", minimum=1)
    do_refinement: bool = parameter(True, "Whether the smoothed path is smoothed again.")
    refinement_num: int = parameter(2, "How often it is smoothed again.", minimum=0)
    enforce_path_inversion: bool = parameter(True, "Whether the places where the robot reverses stay where they are.")

    def check(self) -> None:
        """Check the window and the degree together."""
        if self.window_size % 2 == 0:
            raise ParameterError("window_size", f"must be odd, got {self.window_size}")
        if self.poly_order >= self.window_size:
            raise ParameterError("poly_order", f"must be smaller than window_size {self.window_size}")


class SavitzkyGolaySmoother(Smoother):
    """Smoother by polynomials that are fitted to points in a moving window (Savitzky and Golay 1964).

    Beyond both ends the path continues as its first and last points repeated. The costmap is not looked at: points
    move by less than the waves that are taken out.
    """

    names = ("nav2_smoother::SavitzkyGolaySmoother",)
    Parameters = SavitzkyGolaySmootherParameters
    parameters: SavitzkyGolaySmootherParameters

    def smooth(self, path: Array, costmap: Costmap) -> Array:
        """Implement `Smoother.smooth`."""
        p = self.parameters
        weights = central_weights(p.window_size, p.poly_order)

        def smooth(points: Array) -> Array:
            padded = np.pad(points, ((p.window_size // 2,) * 2, (0, 0)), mode="edge")
            moved = np.stack([np.convolve(axis, weights[::-1], mode="valid") for axis in padded.T], axis=-1)
            moved[[0, -1]] = points[[0, -1]]
            return moved

        times = 1 + p.refinement_num if p.do_refinement else 1
        return smooth_parts(path, smooth, split=p.enforce_path_inversion, times=times)


def central_weights(window_size: int, order: int) -> Array:
    """Return the weights, shape (window_size,), of points whose fitted polynomial's value is at the central one."""
    powers = np.vander(np.arange(window_size) - window_size // 2, order + 1, increasing=True)
    return np.asarray(np.linalg.pinv(powers)[0])
