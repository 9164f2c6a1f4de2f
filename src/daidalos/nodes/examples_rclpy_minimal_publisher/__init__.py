"""The smallest publisher. ROS 2 writes it in three ways that do the same."""

EXECUTABLES = {
    "publisher_local_function": "publisher",
    "publisher_member_function": "publisher",
    "publisher_old_school": "publisher",
}
