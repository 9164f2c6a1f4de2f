"""Names, types and user data as rmw_cyclonedds writes them."""

from __future__ import annotations

import pytest
from example_interfaces.action import Fibonacci
from example_interfaces.srv import AddTwoInts
from hypothesis import given
from hypothesis import strategies as st

from daidalos.transport.cyclonedds import names
from daidalos.transport.graph import EndpointKind


@pytest.mark.parametrize(
    ("topic", "type_name", "writes", "expected"),
    [
        ("rt/chatter", "std_msgs::msg::dds_::String_", True, ("PUBLISHER", "/chatter", "std_msgs/msg/String")),
        ("rt/a/b", "std_msgs::msg::dds_::String_", False, ("SUBSCRIPTION", "/a/b", "std_msgs/msg/String")),
        ("rq/addRequest", "p::srv::dds_::Add_Request_", True, ("CLIENT", "/add", "p/srv/Add")),
        ("rq/addRequest", "p::srv::dds_::Add_Request_", False, ("SERVICE", "/add", "p/srv/Add")),
        (
            "rq/fibonacci/_action/send_goalRequest",
            "p::action::dds_::Fibonacci_SendGoal_Request_",
            False,
            ("SERVICE", "/fibonacci/_action/send_goal", "p/action/Fibonacci_SendGoal"),
        ),
        ("rr/addReply", "p::srv::dds_::Add_Response_", True, None),
        ("ros_discovery_info", "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_", True, None),
        ("DCPSParticipant", "x", True, None),
        ("rt/plain", "Plain", True, ("PUBLISHER", "/plain", "Plain")),
    ],
)
def test_endpoints(topic, type_name, writes, expected):
    found = names.parse_endpoint(topic, type_name, writes)
    assert (found and (found[0].name, *found[1:])) == expected


@given(name=st.from_regex(r"(/[a-z][a-z0-9_]*){1,4}", fullmatch=True))
def test_names_come_back(name):
    assert names.parse_endpoint(names.topic_of(name), "T", writes=True)[1] == name
    kind, back, _ = names.parse_endpoint(names.request_topic_of(name), "T", writes=False)
    assert (kind, back) == (EndpointKind.SERVICE, name)


def test_services_tell_the_hashes_of_their_messages():
    (request, first), (response, second) = names.parts_of_service("example_interfaces/srv/AddTwoInts")
    assert (request, response) == (
        "example_interfaces/srv/AddTwoInts_Request", "example_interfaces/srv/AddTwoInts_Response"
    )  # fmt: skip
    assert (first, second) == (AddTwoInts.Request._TYPE_HASH, AddTwoInts.Response._TYPE_HASH)
    goal, _ = names.parts_of_service("example_interfaces/action/Fibonacci_SendGoal")
    assert goal[1] == Fibonacci.Impl.SendGoalService.Request._TYPE_HASH


def test_user_data():
    data = names.write_user_data(clientid="01.10", typehash="RIHS01_ab", history="")
    assert data == b"clientid=01.10;typehash=RIHS01_ab;"
    assert names.read_user_data(data) == {"clientid": "01.10", "typehash": "RIHS01_ab"}
    assert names.read_user_data(b"serviceid= 1.10.8c;typehash=RIHS01_ab;") == {
        "serviceid": "1.10.8c", "typehash": "RIHS01_ab"
    }  # fmt: skip


@given(st.binary(max_size=100))
def test_any_user_data_are_read(data):
    assert isinstance(names.read_user_data(data), dict)
