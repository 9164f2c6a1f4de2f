"""The package of `ros2 multicast`; `api` is what other packages import."""
