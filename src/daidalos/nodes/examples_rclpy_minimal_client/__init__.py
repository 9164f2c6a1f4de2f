"""Minimal service client; ROS 2 has it in four equivalent versions."""

EXECUTABLES = {
    "client": "asker",
    "client_async": "asker",
    "client_async_callback": "asker",
    "client_async_member_function": "asker",
}
