"""The commands `ros2` and `daidalos`."""
