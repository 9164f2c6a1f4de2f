"""Filters for streams of messages: they subscribe, remember, select, sort and bring together what belongs together."""

from typing import TYPE_CHECKING

from rclpy.impl.lazy_reexport import lazy_reexport

from .cache import Cache as Cache
from .chain import Chain as Chain
from .delta_filter import ComparisonFilter as ComparisonFilter
from .delta_filter import DeltaFilter as DeltaFilter
from .delta_filter import PathDeltaFilter as PathDeltaFilter
from .input_aligner import InputAligner as InputAligner
from .latest_time_synchronizer import LatestTimeSynchronizer as LatestTimeSynchronizer
from .message_traits import get_time_from_message_header as get_time_from_message_header
from .simple_filter import SimpleFilter as SimpleFilter
from .subscriber import Subscriber as Subscriber
from .synchronizers import ApproximateTimeSynchronizer as ApproximateTimeSynchronizer
from .synchronizers import TimeSynchronizer as TimeSynchronizer
from .time_sequencer import TimeSequencer as TimeSequencer

if not TYPE_CHECKING:
    __getattr__ = lazy_reexport(
        __name__,
        {"rclpy.clock": ("Clock",), "rclpy.duration": ("Duration",), "rclpy.time": ("Time",)},
    )
