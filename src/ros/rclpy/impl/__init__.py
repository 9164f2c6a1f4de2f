"""Internal modules of rclpy."""
