"""Definitions in one text."""

from rosapi.objectutils import get_typedef, get_typedef_full_text
from rosapi.stringify_field_types import stringify_field_types


def test_each_type_comes_once_after_the_message() -> None:
    text = stringify_field_types("sensor_msgs/CameraInfo")
    names = [line.removeprefix("MSG: ") for line in text.splitlines() if line.startswith("MSG: ")]
    assert names == ["sensor_msgs/RegionOfInterest", "std_msgs/Header", "builtin_interfaces/Time"]
    assert text == stringify_field_types("sensor_msgs/msg/CameraInfo")


def test_what_has_no_definition_is_said() -> None:
    assert get_typedef_full_text("none/None").startswith("# failed to get full definition text for none/None")
    assert get_typedef("boolean") is get_typedef("sequence<boolean>") is get_typedef("none/None") is None
