"""The package of `ros2 interface`; `api` is what other packages import."""
