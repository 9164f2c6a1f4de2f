"""Files with the quality of service of recorded or played topics."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros2bag.api import interpret_dict_as_qos_profile

from daidalos.cli.ros2.bag.arguments import error
from daidalos.common.documents import DocumentError, read_yaml

if TYPE_CHECKING:
    from rclpy.qos import QoSProfile


def read_overrides(path: str | None) -> dict[str, QoSProfile]:
    """Return the profiles of a file by topic, none without a file; CliError for an invalid file."""
    if path is None:
        return {}
    try:
        document = read_yaml(path)
    except OSError as fault:
        raise error(f"{path}: cannot be read: {fault}") from None
    except DocumentError as fault:
        raise error(f"{path}: {fault.described}") from None
    if not isinstance(document, dict):
        raise error(f"{path}: expected a mapping of topics to their QoS policies")
    profiles = {}
    for topic, policies in document.items():
        try:
            profiles[str(topic)] = interpret_dict_as_qos_profile(policies)
        except (AttributeError, KeyError, OverflowError, TypeError, ValueError) as fault:
            text = fault.args[0] if fault.args else fault
            raise error(f"{text} (topic {topic} in {path})") from None
    return profiles
