"""Minimal publisher; ROS 2 has it in three equivalent versions."""

EXECUTABLES = {
    "publisher_local_function": "publisher",
    "publisher_member_function": "publisher",
    "publisher_old_school": "publisher",
}
