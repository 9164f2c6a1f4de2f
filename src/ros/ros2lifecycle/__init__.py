"""The package of `ros2 lifecycle`; `api` is what other packages import."""
