"""The xacro command, for `ros2 run`."""
