"""Command line options of the quality of service demos."""

from __future__ import annotations

import argparse

from rclpy.qos import QoSProfile, QoSReliabilityPolicy, qos_profile_sensor_data

from daidalos.nodes.runner import program_arguments


def parse(description: str, cycles_help: str) -> argparse.Namespace:
    """Read the command line: ``reliable`` and ``number_of_cycles``."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--reliable", action="store_true", help="set qos profile to reliable")
    parser.add_argument("-n", "--number_of_cycles", type=int, default=20, help=cycles_help)
    return parser.parse_args(program_arguments())


def profile(reliable: bool) -> QoSProfile:
    """Return the profile of a choice."""
    if reliable:
        return QoSProfile(depth=10, reliability=QoSReliabilityPolicy.RELIABLE)
    return qos_profile_sensor_data
