"""Condition nodes on the battery."""

from typing import ClassVar

from py_trees.common import Status

from daidalos.navigation.trees.node import Node, Port, flag

_BATTERY = "sensor_msgs/msg/BatteryState"
_CHARGING = 1


class IsBatteryLow(Node):
    """Condition node that succeeds while the battery's charge, or its voltage [V], is at most `min_battery`."""

    names = ("IsBatteryLow",)
    PORTS: ClassVar[dict[str, Port]] = {
        "min_battery": Port(float),
        "battery_topic": Port(str, "/battery_status"),
        "is_voltage": Port(flag, False),
    }

    def update(self) -> Status:
        """Look at the last message."""
        state = self.services.latest(self.ports.get("battery_topic"), _BATTERY)
        if state is None:
            return Status.FAILURE
        value = state.voltage if self.ports.get("is_voltage") else state.percentage
        return Status.SUCCESS if value <= self.ports.get("min_battery") else Status.FAILURE


class IsBatteryCharging(Node):
    """Condition node that succeeds while the battery is charged."""

    names = ("IsBatteryCharging",)
    PORTS: ClassVar[dict[str, Port]] = {"battery_topic": Port(str, "/battery_status")}

    def update(self) -> Status:
        """Look at the last message."""
        state = self.services.latest(self.ports.get("battery_topic"), _BATTERY)
        is_charging = state is not None and state.power_supply_status == _CHARGING
        return Status.SUCCESS if is_charging else Status.FAILURE
