"""Filters that fuse odometry, poses, velocities and inertial measurements into one state."""
