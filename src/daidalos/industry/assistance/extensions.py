"""Assistance devices that users add."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from daidalos.common.extensions import Kind, classes_in

if TYPE_CHECKING:
    from daidalos.industry.assistance.device import Device

DEVICES: Kind[Device] = Kind(
    "assistance_device",
    "daidalos.assistance_devices",
    "daidalos.industry.assistance.device:Device",
    "points at places and shows contents to a worker; named by the kind of a device of a work sequence",
    partial(classes_in, "daidalos.industry.assistance"),
)
KINDS = (DEVICES,)
