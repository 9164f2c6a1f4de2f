"""The package of `ros2 control`; `api` is what other packages import."""
