"""Hardware interfaces, controllers and their manager, as ros2_control has them; plain arrays, no middleware."""
