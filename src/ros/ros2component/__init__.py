"""The package of `ros2 component`; `api` is what other packages import."""
