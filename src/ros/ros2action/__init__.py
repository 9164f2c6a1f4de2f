"""The package of `ros2 action`; `api` is what other packages import."""
