"""The package of `ros2 topic`; `api` is what other packages import."""
