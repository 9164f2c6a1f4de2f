"""Behaviour that watches a battery."""

from __future__ import annotations

import py_trees
from rclpy.qos import QoSProfile
from sensor_msgs.msg import BatteryState

from py_trees_ros import subscribers

_HYSTERESIS = 5.0


class ToBlackboard(subscribers.ToBlackboard):
    """Behaviour that stores the state of a battery as ``battery``, and whether it is low as ``battery_low_warning``.

    The warning ends 5 % above the threshold.

    Parameters
    ----------
    name, topic_name, qos_profile
        See `subscribers.Handler`.
    threshold
        Charge below which it is low [%].
    """

    def __init__(self, name: str, topic_name: str, qos_profile: QoSProfile, threshold: float = 30.0) -> None:
        super().__init__(
            name,
            topic_name,
            BatteryState,
            qos_profile,
            {"battery": None},
            clearing_policy=py_trees.common.ClearingPolicy.NEVER,
        )
        self.threshold = threshold
        self.blackboard.register_key(key="battery_low_warning", access=py_trees.common.Access.WRITE)
        self.blackboard.battery = BatteryState(
            percentage=0.0, power_supply_status=BatteryState.POWER_SUPPLY_STATUS_UNKNOWN
        )
        self.blackboard.battery_low_warning = False

    def update(self) -> py_trees.common.Status:
        """Store the state of the battery."""
        status = super().update()
        if status != py_trees.common.Status.RUNNING:
            charge = self.blackboard.battery.percentage
            charge *= 100.0 if charge <= 1.0 else 1.0
            if charge > self.threshold + _HYSTERESIS:
                self.blackboard.battery_low_warning = False
            elif charge < self.threshold:
                self.blackboard.battery_low_warning = True
            self.feedback_message = (
                "Battery level is low" if self.blackboard.battery_low_warning else "Battery level is ok"
            )
        return status
