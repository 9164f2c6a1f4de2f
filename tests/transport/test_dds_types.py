import pytest

from daidalos.transport.dds_types import dds_type, ros_type


@pytest.mark.parametrize(
    ("ros", "dds"),
    [
        ("std_msgs/msg/String", "std_msgs::msg::dds_::String_"),
        ("example_interfaces/srv/AddTwoInts_Request", "example_interfaces::srv::dds_::AddTwoInts_Request_"),
    ],
)
def test_names_go_both_ways(ros: str, dds: str) -> None:
    assert dds_type(ros) == dds
    assert ros_type(dds) == ros


@pytest.mark.parametrize("other", ["", "String", "std_msgs::msg::String_", "a::b::c::d", "std_msgs/msg/String"])
def test_other_names_are_left_as_they_are(other: str) -> None:
    assert ros_type(other) == other
