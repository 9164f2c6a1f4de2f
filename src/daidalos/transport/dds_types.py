"""Names of types in the notation of DDS, which rmw_zenoh uses as well."""

from __future__ import annotations


def dds_type(type_name: str) -> str:
    """Return the DDS name of a type: ``std_msgs/msg/String`` -> ``std_msgs::msg::dds_::String_``."""
    package, kind, name = type_name.split("/")
    return f"{package}::{kind}::dds_::{name}_"


def ros_type(text: str) -> str:
    """Return the ROS name of a DDS type; anything else is returned unchanged."""
    parts = text.split("::")
    if len(parts) == 4 and parts[2] == "dds_":
        return f"{parts[0]}/{parts[1]}/{parts[3].removesuffix('_')}"
    return text
