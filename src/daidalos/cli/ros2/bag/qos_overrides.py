"""Files with the quality of service of recorded or played topics."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from daidalos.cli.ros2.bag.arguments import error

if TYPE_CHECKING:
    from rclpy.qos import QoSProfile

_DEPTH = 10


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
            profiles[str(topic)] = _profile(policies)
        except (AttributeError, KeyError, TypeError, ValueError) as fault:
            text = fault.args[0] if fault.args else fault
            raise error(f"{path}: {topic}: {text}") from None
    return profiles


def _profile(policies: Any) -> QoSProfile:
    from rclpy.qos import DurabilityPolicy, HistoryPolicy, LivelinessPolicy, QoSProfile, ReliabilityPolicy

    kinds = {
        "history": HistoryPolicy,
        "reliability": ReliabilityPolicy,
        "durability": DurabilityPolicy,
        "liveliness": LivelinessPolicy,
    }
    if not isinstance(policies, dict):
        raise ValueError("expected a mapping of QoS policies")
    values: dict[str, Any] = {"history": HistoryPolicy.KEEP_LAST, "depth": _DEPTH}
    for name, value in policies.items():
        if name in ("deadline", "lifespan", "liveliness_lease_duration"):
            values[name] = _duration(value)
        elif name in kinds:
            known = kinds[name].short_keys()
            if not isinstance(value, str) or value.lower() not in known:
                raise ValueError(f"{name}: expected one of {', '.join(known)}, found {value!r}")
            values[name] = kinds[name][value.upper()]
        elif name == "depth":
            if not isinstance(value, int) or isinstance(value, bool) or value < 0:
                raise ValueError("`depth` may not be a negative value.")
            values[name] = value
        elif name == "avoid_ros_namespace_conventions":
            values[name] = bool(value)
        else:
            raise ValueError(f"Unexpected key `{name}` for QoS profile.")
    return QoSProfile(**values)


def _duration(value: Any) -> Any:
    from rclpy.duration import Duration

    if not isinstance(value, dict) or not {"sec", "nsec"} <= value.keys():
        raise ValueError("Time overrides must include both seconds (sec) and nanoseconds (nsec).")
    duration = Duration(seconds=int(value["sec"]), nanoseconds=int(value["nsec"]))
    if duration.nanoseconds < 0:
        raise ValueError("Time duration may not be a negative value.")
    return duration
