"""What the public modules of rclpy are built on."""
