"""The package of `ros2 doctor`; `api` is what other packages import."""
