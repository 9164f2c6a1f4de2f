"""Nodes written in C++: the Python side of the library ``rclcpp``, which embeds this interpreter."""
