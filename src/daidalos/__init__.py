"""ROS 2 without installing ROS: the layers behind the drop-in packages."""

__version__ = "0.1.0"
