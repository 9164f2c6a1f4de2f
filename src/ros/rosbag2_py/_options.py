"""Options of recording and playing."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from datetime import timedelta
from enum import IntEnum

from rclpy.logging import LoggingSeverity, get_logging_severity_from_string
from rclpy.qos import QoSProfile

from daidalos.bags.compression import Compression
from daidalos.bags.selection import Selection, absolute

_EVENTS = "/_service_event"


class ServiceRequestsSource(IntEnum):
    """Whose events tell of the requests that are sent again: the service's or the client's."""

    SERVICE_INTROSPECTION = 0
    CLIENT_INTROSPECTION = 1


@dataclass
class PlayOptions:
    """Options of playing; times in seconds unless a name says otherwise, negative for no limit.

    `node_prefix` and `disable_loan_message` are there for programs that set them; they change nothing.
    """

    read_ahead_queue_size: int = 1000
    node_prefix: str = ""
    rate: float = 1.0
    topics_to_filter: Sequence[str] = ()
    services_to_filter: Sequence[str] = ()
    regex_to_filter: str = ""
    exclude_regex_to_filter: str = ""
    exclude_topics_to_filter: Sequence[str] = ()
    exclude_service_events_to_filter: Sequence[str] = ()
    topic_qos_profile_overrides: dict[str, QoSProfile] = field(default_factory=dict)
    loop: bool = False
    topic_remapping_options: Sequence[str] = ()
    clock_publish_frequency: float = 0.0
    clock_publish_on_topic_publish: bool = False
    clock_topics: Sequence[str] = ()
    delay: float = 0.0
    playback_duration: float = -1.0
    playback_until_timestamp: int = -1
    start_paused: bool = False
    start_offset: float = 0.0
    disable_keyboard_controls: bool = False
    wait_acked_timeout: int = -1
    disable_loan_message: bool = False
    publish_service_requests: bool = False
    service_requests_source: ServiceRequestsSource = ServiceRequestsSource.SERVICE_INTROSPECTION
    progress_bar_update_rate: int = 3

    def selection(self) -> Selection:
        """Return what is played."""
        everything = not (self.topics_to_filter or self.services_to_filter or self.regex_to_filter)
        return Selection(
            topics=absolute(self.topics_to_filter),
            services=_services(self.services_to_filter),
            all_topics=everything,
            all_services=everything,
            regex=self.regex_to_filter,
            exclude_topics=absolute(self.exclude_topics_to_filter),
            exclude_services=_services(self.exclude_service_events_to_filter),
            exclude_regex=self.exclude_regex_to_filter,
            hidden=True,
        )


@dataclass
class RecordOptions:
    """Options of recording.

    There for programs that set them, without effect: `topic_polling_interval` (topics are noticed when they appear),
    `rmw_serialization_format` (it is CDR), `compression_queue_size` and `compression_threads_priority` (nothing is
    dropped while it waits), `node_prefix`.
    """

    all_topics: bool = False
    all_services: bool = False
    is_discovery_disabled: bool = False
    topics: Sequence[str] = ()
    topic_types: Sequence[str] = ()
    services: Sequence[str] = ()
    exclude_topics: Sequence[str] = ()
    exclude_topic_types: Sequence[str] = ()
    exclude_service_events: Sequence[str] = ()
    rmw_serialization_format: str = ""
    topic_polling_interval: timedelta = timedelta(milliseconds=100)
    regex: str = ""
    exclude_regex: str = ""
    node_prefix: str = ""
    compression_mode: str = "NONE"
    compression_format: str = ""
    compression_queue_size: int = 1
    compression_threads: int = 0
    compression_threads_priority: int = 0
    topic_qos_profile_overrides: dict[str, QoSProfile] = field(default_factory=dict)
    include_hidden_topics: bool = False
    include_unpublished_topics: bool = False
    ignore_leaf_topics: bool = False
    start_paused: bool = False
    use_sim_time: bool = False
    disable_keyboard_controls: bool = False

    @property
    def all(self) -> bool:
        """Everything, as ROS 2 Humble names it."""
        return self.all_topics and self.all_services

    @all.setter
    def all(self, value: bool) -> None:
        self.all_topics = self.all_services = value

    def selection(self) -> Selection:
        """Return what is recorded."""
        return Selection(
            topics=absolute(self.topics),
            services=_services(self.services),
            types=tuple(self.topic_types),
            all_topics=self.all_topics,
            all_services=self.all_services,
            regex=self.regex,
            exclude_topics=absolute(self.exclude_topics),
            exclude_services=_services(self.exclude_service_events),
            exclude_types=tuple(self.exclude_topic_types),
            exclude_regex=self.exclude_regex,
            hidden=self.include_hidden_topics,
        )

    def compression(self) -> Compression:
        """Return how the bag is compressed."""
        mode = self.compression_mode.upper()
        if mode in ("", "NONE"):
            return Compression()
        return Compression(mode, self.compression_format, self.compression_threads)


def _services(names: Sequence[str]) -> tuple[str, ...]:
    """Return services by their names, which may be given as those of their events."""
    return tuple(name.removesuffix(_EVENTS) for name in absolute(names))


def severity(log_level: str) -> LoggingSeverity:
    """Return the severity of a name; RuntimeError where there is none."""
    return get_logging_severity_from_string(log_level)
