"""Registry of seam controllers."""

from __future__ import annotations

from functools import partial

from daidalos.common.extensions import Kind, classes_in
from daidalos.industry.servoing import contracts

SEAM_CONTROLLERS: Kind[contracts.SeamController] = Kind(
    "seam_controller",
    "daidalos.seam_controllers",
    "daidalos.industry.servoing.contracts:SeamController",
    "a controller of a tool across a seam",
    partial(classes_in, "daidalos.industry.servoing.controllers"),
)
KINDS = (SEAM_CONTROLLERS,)
