"""Registry of what users add to grinding: force controllers."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from daidalos.common.extensions import Kind, classes_in

if TYPE_CHECKING:
    from daidalos.industry.grinding.force_control import ForceController

FORCE_CONTROLLERS: Kind[ForceController] = Kind(
    "force_controller",
    "daidalos.force_controllers",
    "daidalos.industry.grinding.force_control:ForceController",
    "controls the force of a grinding actuator; named by --controller of `daidalos grind`",
    partial(classes_in, "daidalos.industry.grinding.controllers"),
)
KINDS = (FORCE_CONTROLLERS,)
