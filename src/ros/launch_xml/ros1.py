"""ROS1 placeholder."""


def is_ros1(root):
    return False
