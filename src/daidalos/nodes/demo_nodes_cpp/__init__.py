"""The demonstrations that ROS 2 has in C++, by the same names and with the same words."""

EXECUTABLES = {
    "add_two_ints_client": "add_two_ints_client",
    "add_two_ints_client_async": "add_two_ints_client",
}
