"""The smallest client of a service. ROS 2 writes it in four ways that do the same."""

EXECUTABLES = {
    "client": "asker",
    "client_async": "asker",
    "client_async_callback": "asker",
    "client_async_member_function": "asker",
}
