"""`image_bridge`: bridge of images; it renames topics by remapping."""

from __future__ import annotations

from daidalos.nodes.ros_gz_bridge.parameter_bridge import ParameterBridge
from daidalos.nodes.runner import UserError, program_arguments, run


def _bridge(topics: list[str]) -> ParameterBridge:
    if not topics:
        raise UserError("name the topics of images that are to be bridged")
    return ParameterBridge([f"{topic}@sensor_msgs/msg/Image[gz.msgs.Image" for topic in topics])


def main() -> int:
    """Run the node."""
    return run(lambda: _bridge(program_arguments()))
