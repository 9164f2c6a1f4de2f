"""The package of `ros2 launch`; `api` is what other packages import."""
