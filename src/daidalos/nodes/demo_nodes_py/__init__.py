"""Demo nodes of rclpy: talker and listener, services, parameters."""

EXECUTABLES = {
    "add_two_ints_client": "add_two_ints_client",
    "add_two_ints_client_async": "add_two_ints_client",
}
