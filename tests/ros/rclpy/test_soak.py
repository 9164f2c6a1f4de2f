"""A short life with all that comes and goes; `benchmarks/soak.py` makes it long."""

import pytest

from benchmarks.soak import soak

KEPT_MB = {"rmw_daidalos_inprocess": 0.0, "rmw_zenoh_cpp": 0.2}
"""What the middleware itself keeps of a round: zenoh's advanced subscriber, of every publisher that it detects."""


@pytest.mark.slow
@pytest.mark.parametrize("middleware", ["rmw_daidalos_inprocess", "rmw_zenoh_cpp"])
def test_nothing_is_left_behind(monkeypatch: pytest.MonkeyPatch, domain: int, middleware: str) -> None:
    monkeypatch.setenv("RMW_IMPLEMENTATION", middleware)
    monkeypatch.setenv("ROS_DOMAIN_ID", str(domain))
    result = soak(15.0)
    assert result["rounds"] > 10
    assert (result["errors"], result["threads_left"], result["endpoints_left"]) == (0, 0, 0)
    assert result["memory_growth_mb"] < 5 + result["rounds"] * KEPT_MB[middleware]
