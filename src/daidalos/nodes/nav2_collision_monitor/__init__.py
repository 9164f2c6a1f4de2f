"""Collision monitor between what commands a robot and what drives it."""

COMPONENTS = {"CollisionMonitor": "collision_monitor:CollisionMonitorNode"}
