"""Files with the quality of service of recorded or played topics."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from ros2bag.api import interpret_dict_as_qos_profile

from daidalos.cli.ros2.bag.arguments import error

if TYPE_CHECKING:
    from rclpy.qos import QoSProfile


def read_overrides(path: str | None) -> dict[str, QoSProfile]:
    """Return the profiles of a file by topic, none without a file; CliError for an invalid file."""
    if path is None:
        return {}
    import yaml

    try:
        document = yaml.safe_load(Path(path).read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError) as fault:
        raise error(f"{path}: cannot be read: {fault}") from None
    except yaml.YAMLError as fault:
        mark = getattr(fault, "problem_mark", None)
        where = f"line {mark.line + 1}, column {mark.column + 1}: " if mark else ""
        raise error(f"{path}: {where}{getattr(fault, 'problem', None) or fault}") from None
    if not isinstance(document, dict):
        raise error(f"{path}: expected a mapping of topics to their QoS policies")
    profiles = {}
    for topic, policies in document.items():
        try:
            profiles[str(topic)] = interpret_dict_as_qos_profile(policies)
        except (AttributeError, KeyError, TypeError, ValueError) as fault:
            text = fault.args[0] if fault.args else fault
            raise error(f"{path}: {topic}: {text}") from None
    return profiles
