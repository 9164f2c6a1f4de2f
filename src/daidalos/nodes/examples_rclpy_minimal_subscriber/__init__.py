"""Minimal subscriber; ROS 2 has it in three equivalent versions."""

EXECUTABLES = {
    "subscriber_lambda": "subscriber",
    "subscriber_member_function": "subscriber",
    "subscriber_old_school": "subscriber",
}
