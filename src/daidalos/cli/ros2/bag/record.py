"""`ros2 bag record`."""

from __future__ import annotations

import time
from argparse import ArgumentParser, Namespace
from datetime import datetime, timedelta
from pathlib import Path
from typing import TYPE_CHECKING

from ros2bag.api import check_not_negative_float, check_not_negative_int

from daidalos.bags.compression import FORMATS
from daidalos.bags.errors import BagError
from daidalos.bags.storage import DEFAULT, PROFILES
from daidalos.cli.ros2.bag import arguments as common
from daidalos.cli.ros2.bag.qos_overrides import read_overrides
from daidalos.cli.ros2.extension import Status, Verb

if TYPE_CHECKING:
    from rosbag2_py import Recorder, RecordOptions, StorageOptions

_CACHE = 100 * 1024 * 1024
_STATUS_HZ = 3


class RecordVerb(Verb):
    """Record ROS data to a bag."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the verb's arguments."""
        add_recorder_arguments(parser)

    def main(self, *, args: Namespace) -> Status:
        """Record until Ctrl-C."""
        from rosbag2_py import Recorder

        uri = args.output or datetime.now().strftime("rosbag2_%Y_%m_%d-%H_%M_%S")
        fault = validate_parsed_arguments(args, uri)
        if fault is not None:
            raise common.error(fault)
        storage, options = _storage_options(args, uri), _record_options(args)
        try:
            recorder = Recorder(storage, options, args.log_level, args.node_name)
        except (BagError, ValueError) as fault:
            raise common.error(str(fault)) from None
        return _run(recorder)


def add_recorder_arguments(parser: ArgumentParser) -> None:
    """Declare the arguments of a program that records."""
    parser.add_argument("-o", "--output", help="Destination of the bag; by default a folder with the time in its name")
    parser.add_argument(
        "-s", "--storage", default=DEFAULT, choices=common.STORAGES, help="Storage (default: %(default)s)"
    )
    _add_selection(parser)
    _add_discovery(parser)
    _add_files(parser)
    _add_running(parser)
    _add_compression(parser)


def _add_selection(parser: ArgumentParser) -> None:
    add = parser.add_argument
    add("topics_positional", nargs="*", default=[], metavar="Topic", help="Topics to record (deprecated: --topics)")
    add("--topics", default=[], metavar="Topic", nargs="+", help="Topics to record")
    add("--services", default=[], metavar="ServiceName", nargs="+", help="Services to record")
    add("--topic-types", default=[], metavar="TopicType", nargs="+", help="Types of topics to record")
    add("-a", "--all", action="store_true", help="Record all topics and services (hidden topics excluded)")
    add("--all-topics", action="store_true", help="Record all topics (hidden topics excluded)")
    add("--all-services", action="store_true", help="Record all services by their events")
    add(
        "-e",
        "--regex",
        default="",
        help="Record topics and services whose names contain the regular expression; --all, --all-topics and "
        "--all-services override it",
    )
    add("--exclude-regex", default="", help="Exclude topics and services that contain the regular expression")
    add("--exclude-topic-types", default=[], metavar="TopicType", nargs="+", help="Types of topics not to record")
    add("--exclude-topics", default=[], metavar="Topic", nargs="+", help="Topics not to record")
    add("--exclude-services", default=[], metavar="ServiceName", nargs="+", help="Services not to record")


def _add_discovery(parser: ArgumentParser) -> None:
    add = parser.add_argument
    add("--include-unpublished-topics", action="store_true", help="Record topics without publishers as well")
    add("--include-hidden-topics", action="store_true", help="Record hidden topics as well")
    add("--no-discovery", action="store_true", help="Record only topics that are there at the start")
    add(
        "-p",
        "--polling-interval",
        type=check_not_negative_int,
        default=100,
        metavar="MS",
        help="Has no effect: new topics are noticed when they appear",
    )
    add("--ignore-leaf-topics", action="store_true", help="Ignore topics without subscribers")
    add(
        "--qos-profile-overrides-path",
        type=common.existing_file,
        metavar="FILE",
        help="Path to a YAML file that defines overrides of the QoS profile for specific topics",
    )


def _add_files(parser: ArgumentParser) -> None:
    add = parser.add_argument
    add("-f", "--serialization-format", default="", choices=["cdr"], help="How messages are saved")
    add(
        "-b",
        "--max-bag-size",
        type=check_not_negative_int,
        default=0,
        metavar="BYTES",
        help="Size at which another file is begun; 0 for no limit (default: %(default)s)",
    )
    add(
        "-d",
        "--max-bag-duration",
        type=check_not_negative_float,
        default=0,
        metavar="SECONDS",
        help="Duration after which another file is begun; 0 for no limit (default: %(default)s)",
    )
    add(
        "--max-cache-size",
        type=check_not_negative_int,
        default=_CACHE,
        metavar="BYTES",
        help="How much may wait to be written; 0 for no limit (default: %(default)s)",
    )
    add("--storage-config-file", type=common.existing_file, metavar="FILE", help="Settings of the storage, as YAML")
    profiles = sorted({name for names in PROFILES.values() for name in names})
    add(
        "--storage-preset-profile",
        default="none",
        choices=profiles,
        help="; ".join(f"{storage}: {', '.join(names)}" for storage, names in PROFILES.items()),
    )
    add(
        "--custom-data",
        metavar="KEY=VALUE",
        nargs="*",
        default=[],
        help="Pairs that are kept in the bag's description as 'custom_data'",
    )
    add(
        "--snapshot-mode",
        action="store_true",
        help="Keep the last messages, as far as --max-cache-size goes, and write them when the service "
        "~/snapshot is called",
    )


def _add_running(parser: ArgumentParser) -> None:
    add = parser.add_argument
    add("--disable-keyboard-controls", action="store_true", help="Disables keyboard controls for the recorder")
    add("--start-paused", action="store_true", help="Start paused")
    add(
        "--use-sim-time",
        action="store_true",
        help="Take the times of messages from /clock; nothing is written before its first message",
    )
    add("--node-name", default="rosbag2_recorder", help="Name of the node (default: %(default)s)")
    add(
        "--log-level",
        default="info",
        choices=["debug", "info", "warn", "error", "fatal"],
        help="Logging level (default: %(default)s)",
    )


def _add_compression(parser: ArgumentParser) -> None:
    add = parser.add_argument
    add(
        "--compression-queue-size",
        type=check_not_negative_int,
        default=1,
        metavar="N",
        help="Has no effect: nothing is dropped while it waits for compression",
    )
    add(
        "--compression-threads",
        type=check_not_negative_int,
        default=0,
        metavar="N",
        help="How many files may be compressed at the same time; 0: one for each processor",
    )
    add("--compression-threads-priority", type=int, default=0, metavar="N", help="Has no effect")
    add(
        "--compression-mode",
        default="none",
        choices=["none", "file", "message"],
        help="What is compressed (default: %(default)s)",
    )
    add("--compression-format", default="", choices=list(FORMATS), help="By what it is compressed")


def validate_parsed_arguments(args: Namespace, uri: str) -> str | None:
    """Return what contradicts itself in the arguments, or None; warn of what has no effect.

    Topics given without ``--topics`` become those of ``--topics``.

    Parameters
    ----------
    args
        What `add_recorder_arguments` declared.
    uri
        Where the bag will be.
    """
    if args.topics_positional:
        common.warn('Positional "topics" argument deprecated. Please use optional "--topics" argument instead.')
        if args.topics:
            return 'Only one of positional "topics" or "--topics" may be given.'
        args.topics = args.topics_positional
    fault = _selection_fault(args)
    if fault is not None:
        return fault
    _warn_of_overridden(args)
    if Path(uri).exists():
        return f"Output folder '{uri}' already exists."
    if args.use_sim_time and args.no_discovery:
        return (
            "--use-sim-time and --no-discovery both set, but are incompatible settings. "
            "The /clock topic needs to be discovered to record with sim time."
        )
    if args.compression_format and args.compression_mode == "none":
        return "Invalid choice: Cannot specify compression format without a compression mode."
    if args.compression_mode != "none" and not args.compression_format:
        return "Invalid choice: Cannot specify compression mode without a compression format."
    if args.snapshot_mode and args.max_cache_size == 0:
        return "In snapshot mode, the max_cache_size shall not be set to zero."
    return None


def _selection_fault(args: Namespace) -> str | None:
    """Return what is wrong with the choice of topics and services, or None."""
    everything = args.all or args.all_topics
    if not (everything or args.all_services or args.services or args.topics or args.topic_types or args.regex):
        return (
            "Need to specify at least one option out of --all, --all-topics, --all-services, --services, --topics, "
            "--topic-types or --regex"
        )
    if args.exclude_regex and not (everything or args.topic_types or args.all_services or args.regex):
        return "--exclude-regex argument requires either --all, --all-topics, --topic-types, --all-services or --regex"
    if args.exclude_topics and not (everything or args.topic_types or args.regex):
        return "--exclude-topics argument requires either --all, --all-topics, --topic-types or --regex"
    if args.exclude_topic_types and not (everything or args.regex):
        return "--exclude-topic-types argument requires either --all, --all-topics or --regex"
    if args.exclude_services and not (args.all or args.all_services or args.regex):
        return "--exclude-services argument requires either --all, --all-services or --regex"
    return None


def _warn_of_overridden(args: Namespace) -> None:
    everything = args.all or args.all_topics
    if (args.all or args.all_services) and args.services:
        common.warn("--all or --all-services will override --services")
    if everything and args.topics:
        common.warn("--all or --all-topics will override --topics")
    if (everything or args.all_services) and args.regex:
        common.warn("--all, --all-topics or --all-services will override --regex")


def _storage_options(args: Namespace, uri: str) -> StorageOptions:
    from rosbag2_py import StorageOptions

    custom = {}
    for pair in args.custom_data:
        key, sign, value = pair.partition("=")
        if not key or not sign:
            raise common.error(f"--custom-data: '{pair}' is not a pair; expected such as key=value")
        custom[key] = value
    return StorageOptions(
        uri,
        args.storage,
        args.max_bag_size,
        args.max_bag_duration,
        args.max_cache_size,
        args.storage_preset_profile,
        args.storage_config_file or "",
        args.snapshot_mode,
        custom_data=custom,
    )


def _record_options(args: Namespace) -> RecordOptions:
    from rosbag2_py import RecordOptions

    everything = args.all or args.all_topics
    return RecordOptions(
        all_topics=everything,
        all_services=args.all or args.all_services,
        is_discovery_disabled=args.no_discovery,
        topics=args.topics,
        topic_types=args.topic_types,
        services=args.services,
        exclude_topics=args.exclude_topics,
        exclude_topic_types=args.exclude_topic_types,
        exclude_service_events=args.exclude_services,
        rmw_serialization_format=args.serialization_format,
        topic_polling_interval=timedelta(milliseconds=args.polling_interval),
        regex=args.regex,
        exclude_regex=args.exclude_regex,
        compression_mode=args.compression_mode,
        compression_format=args.compression_format,
        compression_queue_size=args.compression_queue_size,
        compression_threads=args.compression_threads,
        compression_threads_priority=args.compression_threads_priority,
        topic_qos_profile_overrides=read_overrides(args.qos_profile_overrides_path),
        include_hidden_topics=args.include_hidden_topics,
        include_unpublished_topics=args.include_unpublished_topics,
        ignore_leaf_topics=args.ignore_leaf_topics,
        start_paused=args.start_paused,
        use_sim_time=args.use_sim_time,
        disable_keyboard_controls=args.disable_keyboard_controls,
    )


def _run(recorder: Recorder) -> Status:
    """Record until Ctrl-C or a request to end, and complete the bag."""
    from rosbag2_py._progress import StatusLine

    status = StatusLine(_Progress(recorder).text, _STATUS_HZ)
    with common.ShutdownRequest() as ending:
        try:
            recorder.start_spin()
            recorder.record()
            status.start()
            while not (ending.asked or recorder.wait(common.POLL_S)):
                continue
        except (BagError, ValueError) as fault:
            raise common.error(str(fault)) from None
        finally:
            status.stop()
            recorder.stop()
            recorder.stop_spin()
    return 1 if recorder.failed else 0


class _Progress:
    """Progress of a recording: duration and size."""

    def __init__(self, recorder: Recorder) -> None:
        self._node = recorder.node
        self._begin = time.monotonic()
        self._text = ""

    def text(self) -> str:
        """Return the progress as a line."""
        bag = self._node.bag
        if bag is not None:
            state = "P" if self._node.is_paused else "R"
            passed = time.monotonic() - self._begin
            self._text = f"Recorded {bag.message_count} messages in {passed:.1f} s [{state}]"
        return self._text
