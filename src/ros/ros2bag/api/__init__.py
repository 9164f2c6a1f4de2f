"""Arguments of verbs about bags, and files with the quality of service of topics."""

from __future__ import annotations

import os
from argparse import ArgumentParser, ArgumentTypeError, HelpFormatter
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rclpy.duration import Duration
    from rclpy.qos import QoSProfile

_DEPTH = 10


class SplitLineFormatter(HelpFormatter):
    """Formatter of help texts that keeps their line breaks."""

    def _split_lines(self, text: str, width: int) -> list[str]:
        return [
            part for line in text.splitlines() for part in super(SplitLineFormatter, self)._split_lines(line, width)
        ]


def print_error(string: str) -> str:
    """Return a text as an error of `ros2 bag`."""
    return f"[ERROR] [ros2bag]: {string}"


def print_warn(string: str) -> str:
    """Return a text as a warning of `ros2 bag`."""
    return f"[WARN] [ros2bag]: {string}"


def dict_to_duration(time_dict: Mapping[str, int] | None) -> Duration:
    """Return the duration of ``{"sec": ..., "nsec": ...}``; that of None or an empty one is zero.

    Raises
    ------
    ValueError
        When one of both is missing or the duration is negative.
    """
    from rclpy.duration import Duration

    if not time_dict and (time_dict is None or isinstance(time_dict, dict)):
        return Duration()
    if not isinstance(time_dict, Mapping) or not {"sec", "nsec"} <= time_dict.keys():
        raise ValueError("Time overrides must include both seconds (sec) and nanoseconds (nsec).")
    duration = Duration(seconds=int(time_dict["sec"]), nanoseconds=int(time_dict["nsec"]))
    if duration.nanoseconds < 0:
        raise ValueError("Time duration may not be a negative value.")
    return duration


def interpret_dict_as_qos_profile(qos_profile_dict: Mapping[str, Any]) -> QoSProfile:
    """Return the profile of policies as files name them, such as ``{"history": "keep_last", "depth": 5}``.

    Raises
    ------
    ValueError
        When a policy or its value is not known.
    """
    from rclpy.qos import DurabilityPolicy, HistoryPolicy, LivelinessPolicy, QoSProfile, ReliabilityPolicy

    kinds = {
        "history": HistoryPolicy,
        "reliability": ReliabilityPolicy,
        "durability": DurabilityPolicy,
        "liveliness": LivelinessPolicy,
    }
    if not isinstance(qos_profile_dict, Mapping):
        raise ValueError("expected a mapping of QoS policies")
    values: dict[str, Any] = {"history": HistoryPolicy.KEEP_LAST, "depth": _DEPTH}
    for name, value in qos_profile_dict.items():
        if name in ("deadline", "lifespan", "liveliness_lease_duration"):
            values[name] = dict_to_duration(value)
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


def convert_yaml_to_qos_profile(qos_profile_dict: Mapping[str, Any]) -> dict[str, QoSProfile]:
    """Return the profiles of a file's content by topic; see `interpret_dict_as_qos_profile`."""
    return {topic: interpret_dict_as_qos_profile(policies) for topic, policies in qos_profile_dict.items()}


def create_bag_directory(uri: str) -> str | None:
    """Create a folder; return what is wrong, None on success."""
    try:
        os.makedirs(uri)
    except OSError as error:
        return print_error(f"Could not create bag folder '{uri}': {error.strerror}")
    return None


def check_path_exists(value: str) -> str:
    """Return the path of an existing bag; for argparse."""
    if not os.path.exists(value):
        raise ArgumentTypeError(f"Bag path '{value}' does not exist!")
    return value


def check_positive_float(value: Any) -> float:
    """Return a number above 0; for argparse."""
    number = _float(value)
    if not 0.0 < number < float("inf"):
        raise ArgumentTypeError(f"{value} is not in the valid range (> 0.0)")
    return number


def check_not_negative_float(value: Any) -> float:
    """Return a number of at least 0; for argparse."""
    number = _float(value)
    if not 0.0 <= number < float("inf"):
        raise ArgumentTypeError(f"Value {value} is less than zero.")
    return number


def _float(value: Any) -> float:
    try:
        return float(value)
    except ValueError:
        raise ArgumentTypeError(f"{value} is not the valid type (float)") from None


def check_not_negative_int(arg: str) -> int:
    """Return an integer of at least 0; for argparse."""
    try:
        value = int(arg)
    except ValueError:
        raise ArgumentTypeError(f"{arg} is not the valid type (int)") from None
    if value < 0:
        raise ArgumentTypeError(f"Value {arg} is less than zero.")
    return value


def add_standard_reader_args(parser: ArgumentParser) -> None:
    """Declare the arguments of a bag to read: ``bag_path`` and ``--storage``."""
    import rosbag2_py

    parser.add_argument("bag_path", type=check_path_exists, help="Bag to open")
    parser.add_argument(
        "-s",
        "--storage",
        default="",
        choices=sorted(rosbag2_py.get_registered_readers()),
        help="Storage implementation of bag. By default it is detected from the bag.",
    )


def add_writer_storage_plugin_extensions(parser: ArgumentParser) -> None:
    """Declare the arguments of the storage of a bag to write."""
    parser.add_argument("--storage-config-file", help="Path to a yaml file with settings of the storage")
    parser.add_argument("--storage-preset-profile", default="none", help="Preset configuration of the storage")


def convert_service_to_service_event_topic(services: Iterable[str] | None) -> list[str]:
    """Return the topics with the events of services."""
    return [f"{service}/_service_event" for service in services or ()]
