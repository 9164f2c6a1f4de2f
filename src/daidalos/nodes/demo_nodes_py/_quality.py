"""Command line options of the quality of service demos."""

from __future__ import annotations

import argparse
import sys

from rclpy.qos import QoSProfile, QoSReliabilityPolicy, qos_profile_sensor_data
from rclpy.utilities import remove_ros_args


def parse(description: str, cycles_help: str) -> argparse.Namespace:
    """Read the command line: ``reliable`` and ``number_of_cycles``."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--reliable", action="store_true", help="set qos profile to reliable")
    parser.add_argument("-n", "--number_of_cycles", type=int, default=20, help=cycles_help)
    return parser.parse_args(remove_ros_args(sys.argv)[1:])


def profile(reliable: bool) -> QoSProfile:
    """Return the profile of a choice."""
    if reliable:
        return QoSProfile(depth=10, reliability=QoSReliabilityPolicy.RELIABLE)
    return qos_profile_sensor_data
