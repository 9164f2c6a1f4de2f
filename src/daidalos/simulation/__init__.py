"""Simulator based on MuJoCo, with sensors and plugins.

`Simulation` is the entrance; `samples` lists everything that goes in and out of it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from daidalos.simulation.simulation import Simulation

__all__ = ["Simulation"]


def __getattr__(name: str) -> Any:
    """Import MuJoCo on first use of the simulator."""
    if name == "Simulation":
        from daidalos.simulation.simulation import Simulation

        return Simulation
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
