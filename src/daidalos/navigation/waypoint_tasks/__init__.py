"""Tasks at waypoints, one class each."""
