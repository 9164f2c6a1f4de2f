"""The package of `ros2 param`; `api` is what other packages import."""
