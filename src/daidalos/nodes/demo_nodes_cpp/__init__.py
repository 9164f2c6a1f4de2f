"""ROS 2's C++ demo nodes, with the same names and texts."""

EXECUTABLES = {
    "add_two_ints_client": "add_two_ints_client",
    "add_two_ints_client_async": "add_two_ints_client",
}
