"""Where a robot may be after a motion that its odometry measured."""
