"""The package of `ros2 run`; `api` is what other packages import."""
