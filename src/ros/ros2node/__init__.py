"""The package of `ros2 node`; `api` is what other packages import."""
