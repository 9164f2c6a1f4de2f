"""Minimal service server; ROS 2 has it in two equivalent versions."""

EXECUTABLES = {
    "service": "adder",
    "service_member_function": "adder",
}
