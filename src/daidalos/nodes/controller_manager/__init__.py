"""ros2_control's controller manager and what speaks to it."""
