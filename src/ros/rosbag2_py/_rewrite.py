"""Writing bags anew, as a YAML file says."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from daidalos.bags.compression import FORMATS
from daidalos.bags.convert import Output, convert
from daidalos.bags.errors import BagError
from daidalos.bags.storage import FOREVER_NS
from daidalos.common.documents import DocumentError, read_yaml
from rosbag2_py._options import RecordOptions
from rosbag2_py._storage import StorageOptions

_STORAGE: dict[str, type] = {
    "uri": str,
    "storage_id": str,
    "max_bagfile_size": int,
    "max_bagfile_duration": int,
    "max_cache_size": int,
    "storage_preset_profile": str,
    "storage_config_uri": str,
    "snapshot_mode": bool,
    "start_time_ns": int,
    "end_time_ns": int,
    "custom_data": dict,
}
_RECORD: dict[str, type] = {
    "all": bool,
    "all_topics": bool,
    "all_services": bool,
    "topics": list,
    "topic_types": list,
    "services": list,
    "exclude_topics": list,
    "exclude_topic_types": list,
    "exclude_services": list,
    "exclude_service_events": list,
    "regex": str,
    "exclude_regex": str,
    "exclude": str,
    "rmw_serialization_format": str,
    "compression_mode": str,
    "compression_format": str,
    "compression_queue_size": int,
    "compression_threads": int,
    "compression_threads_priority": int,
    "include_hidden_topics": bool,
    "include_unpublished_topics": bool,
    "is_discovery_disabled": bool,
    "topic_polling_interval": object,
    "topic_qos_profile_overrides": object,
    "node_prefix": str,
    "ignore_leaf_topics": bool,
    "start_paused": bool,
    "use_sim_time": bool,
    "disable_keyboard_controls": bool,
}
_OTHER_NAMES = {"exclude": "exclude_regex", "exclude_services": "exclude_service_events"}


def bag_rewrite(
    input_options: Sequence[StorageOptions],
    output_config_file: str,
    progress: Callable[[int, int], None] | None = None,
) -> list[str]:
    """Write the messages of some bags into others.

    Parameters
    ----------
    input_options
        The bags to read.
    output_config_file
        A YAML file with the list ``output_bags``; each has ``uri`` and more of what `StorageOptions` and
        `RecordOptions` have.
    progress
        Called now and then with the number of messages that were read and that there are.

    Returns
    -------
    list of str
        What was broken in the bags that were read.

    Raises
    ------
    RuntimeError
        When a bag cannot be read or written, or the file is not understood.
    """
    return convert([(one.uri, one.storage_id) for one in input_options], _outputs(Path(output_config_file)), progress)


def _outputs(path: Path) -> list[Output]:
    try:
        document = read_yaml(path)
    except OSError as error:
        raise BagError(path, f"cannot be read: {error}") from None
    except DocumentError as error:
        raise BagError(path, f"not valid YAML: {error.described}") from None
    bags = document.get("output_bags") if isinstance(document, dict) else None
    if not isinstance(bags, list) or not bags or not all(isinstance(one, dict) for one in bags):
        raise BagError(path, "expected a list 'output_bags' with a mapping for every bag")
    return [_output(path, k, values) for k, values in enumerate(bags)]


def _output(path: Path, number: int, values: dict[str, Any]) -> Output:
    known = _STORAGE | _RECORD
    for name, value in values.items():
        if name not in known:
            raise BagError(path, f"output_bags[{number}].{name}: unknown; there are: {', '.join(sorted(known))}")
        kind = known[name]
        if not isinstance(value, kind) or (kind is int and isinstance(value, bool)):
            raise BagError(path, f"output_bags[{number}].{name}: expected {_KINDS[kind]}, found {value!r}")
        if isinstance(value, list) and not all(isinstance(one, str) for one in value):
            raise BagError(path, f"output_bags[{number}].{name}: expected a list of names, found {value!r}")
    if not values.get("uri"):
        raise BagError(path, f"output_bags[{number}]: uri is missing")
    storage = StorageOptions(**{name: values[name] for name in _STORAGE if name in values})
    record = RecordOptions()
    for name in _RECORD:
        if name in values:
            setattr(record, _OTHER_NAMES.get(name, name), values[name])
    if record.compression_mode.upper() not in ("", "NONE") and not record.compression_format:
        record.compression_format = FORMATS[0]
    return Output(
        Path(storage.uri),
        storage.writer_options(record.compression()),
        record.selection(),
        max(storage.start_time_ns, 0),
        storage.end_time_ns if storage.end_time_ns >= 0 else FOREVER_NS,
    )


_KINDS = {int: "a whole number", str: "a text", list: "a list", dict: "a mapping", bool: "true or false"}
