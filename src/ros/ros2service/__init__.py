"""The package of `ros2 service`; `api` is what other packages import."""
