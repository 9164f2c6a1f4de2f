"""The package of `ros2 pkg`; `api` is what other packages import."""
