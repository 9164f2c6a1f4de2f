"""Recording, playing and converting bags, as programs ask for it."""

from __future__ import annotations

from rosbag2_py._options import PlayOptions, RecordOptions, ServiceRequestsSource
from rosbag2_py._player import Player
from rosbag2_py._recorder import Recorder
from rosbag2_py._rewrite import bag_rewrite

__all__ = [
    "PlayOptions",
    "Player",
    "RecordOptions",
    "Recorder",
    "ServiceRequestsSource",
    "bag_rewrite",
]
