"""The smallest service. ROS 2 writes it in two ways that do the same."""

EXECUTABLES = {
    "service": "adder",
    "service_member_function": "adder",
}
