"""The smallest subscriber. ROS 2 writes it in three ways that do the same."""

EXECUTABLES = {
    "subscriber_lambda": "subscriber",
    "subscriber_member_function": "subscriber",
    "subscriber_old_school": "subscriber",
}
