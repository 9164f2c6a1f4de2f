"""Nodes of a graph in one process under a stepped clock: one thread runs at a time, in an order that time decides."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from daidalos.lockstep.run import Run

current_run: Run | None = None
"""The run that this process is; None for an ordinary process."""
