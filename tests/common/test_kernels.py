"""Compilation of kernels: with options, and ahead of the first use for each package that has some."""

import subprocess
import sys

import numpy as np
import pytest

from daidalos.common.kernels import KERNELS, compiled, warm_up

PACKAGES = ("daidalos.mapping", "daidalos.localization", "daidalos.navigation", "daidalos.simulation.rendering")


@pytest.mark.slow
@pytest.mark.parametrize("package", PACKAGES)
def test_progress_of_warming_up_runs_from_nothing_to_all(package: str) -> None:
    told: list[tuple[float, str]] = []
    warm_up(package, lambda share, step: told.append((share, step)))
    shares = [share for share, _ in told]
    assert shares[0] == 0.0
    assert shares == sorted(shares)
    assert told[-1] == (1.0, "ready")
    assert all(step for _, step in told)


@pytest.mark.parametrize("package", PACKAGES)
def test_importing_a_package_imports_no_compiler(package: str) -> None:
    code = f"import sys, {package}, daidalos.common.kernels; sys.exit('numba' in sys.modules or 'scipy' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_a_kernel_divides_by_zero_as_numpy_does() -> None:
    @compiled
    def quotient(dividend: float, divisor: float) -> float:
        return dividend / divisor

    assert quotient(1.0, 0.0) == np.inf


def test_a_kernel_has_the_options_that_it_asks_for() -> None:
    @compiled(fastmath=True)
    def total(values: np.ndarray) -> float:
        result = 0.0
        for value in values:
            result += value
        return result

    assert total(np.ones(5)) == 5.0
    assert KERNELS[-1].targetoptions["fastmath"] is True
