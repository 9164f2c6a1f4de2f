"""The package of `ros2 bag`; `api` is what other packages import."""
