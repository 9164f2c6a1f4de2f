"""Filters of odometry, poses, velocities and inertial measurements, with robot_localization's interface."""
