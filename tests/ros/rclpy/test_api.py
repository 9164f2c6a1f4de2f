"""Every public name and parameter of ROS 2 Jazzy's rclpy is there."""

from pathlib import Path

import pytest

from ..api_listing import faults

ELSEWHERE = {
    # Typing constructs that say nothing about behaviour.
    ("rclpy.clock", "ClockHandle", "DestroyableType"),
    ("rclpy.clock", "ClockHandle", "Protocol"),
    ("rclpy.context", "ContextHandle", "DestroyableType"),
    ("rclpy.context", "ContextHandle", "Protocol"),
    ("rclpy.context", "Context", "Generic"),
    ("rclpy.executors", "Executor", "Generic"),
    # An import that stands in a class's body there.
    ("rclpy.exceptions", "InvalidParameterTypeException", "Parameter"),
}


@pytest.fixture(scope="module")
def listing(shared_data: Path) -> str:
    file = shared_data.parent / "facts" / "api" / "rclpy.txt"
    if not file.is_file():
        pytest.skip(f"no list of names at {file}")
    return file.read_text()


def test_every_name_and_parameter_is_there(listing: str) -> None:
    missing = [fault for fault in faults(listing) if fault not in ELSEWHERE]
    assert missing == []


def test_the_reader_of_the_list_finds_what_is_missing() -> None:
    text = """
## rclpy.duration
names: NOT_THERE
- class Duration(NoBase): seconds_since(self) -> int; __init__(self, *, days: int = 0)
- no_function(value: int) -> int

## rclpy.no_module
"""
    assert sorted(map(str, faults(text))) == sorted(
        map(
            str,
            [
                ("rclpy.duration", "NOT_THERE"),
                ("rclpy.duration", "Duration", "NoBase"),
                ("rclpy.duration", "Duration", "seconds_since"),
                ("rclpy.duration", "Duration", "__init__", "days"),
                ("rclpy.duration", "no_function"),
                ("rclpy.no_module",),
            ],
        )
    )
