"""Compilation of kernels: with options, and ahead of the first use for each package that has some."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from daidalos.common.kernels import KERNELS, compiled, warm_up
from daidalos.navigation.planners.navfn_planner import NavfnPlanner

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


def test_processes_that_start_together_compile_a_kernel_once(tmp_path: Path) -> None:
    (tmp_path / "shared_kernel.py").write_text(
        "from daidalos.common.kernels import compiled\n\n"
        "@compiled\ndef inner(x: float) -> float:\n    return x + 1.0\n\n"
        "@compiled\ndef outer(x: float) -> float:\n    return inner(x) * inner(x)\n"
    )
    code = (
        "import sys, threading\nimport shared_kernel as s\nsys.stdin.readline()\n"
        "other = threading.Thread(target=s.outer, args=(1.0,))\n"
        "other.start()\nassert s.outer(1.0) == 4.0\nother.join()\n"
        "print(sum(sum(k.stats.cache_misses.values()) for k in (s.inner, s.outer)))"
    )
    environment = os.environ | {"PYTHONPATH": str(tmp_path), "NUMBA_CACHE_DIR": str(tmp_path / "cache")}
    processes = [
        subprocess.Popen(
            [sys.executable, "-c", code], env=environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )
        for _ in range(3)
    ]
    for one in processes:
        assert one.stdin is not None
        one.stdin.write("\n")
        one.stdin.flush()
    compiled_count = sum(int(one.communicate(timeout=60.0)[0]) for one in processes)
    assert compiled_count == 2
    assert not list(tmp_path.rglob("*.lock"))


def test_a_plugin_warms_its_own_kernels_only() -> None:
    told: list[str] = []
    warm_up("daidalos.navigation", lambda share, step: told.append(step), [NavfnPlanner])
    assert told == ["costmap", "NavfnPlanner", "ready"]
