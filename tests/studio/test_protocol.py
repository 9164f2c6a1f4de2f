"""The binary codecs and the JSON messages of the Foxglove WebSocket protocol."""

import contextlib
import json
import math
import re
import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st

from daidalos.studio import frames, protocol
from daidalos.studio.frames import PlaybackControl, Publish, ServiceRequest
from daidalos.studio.protocol import ClientMessage, ProtocolError
from daidalos.studio.records import complete
from daidalos.studio.source import Graph, Parameter, Service, Topic

U32 = st.integers(0, 2**32 - 1)
U64 = st.integers(0, 2**64 - 1)
PAYLOAD = st.binary(max_size=200)
TEXT = st.text(max_size=30)


@given(U32, U64, PAYLOAD)
def test_message_frames_follow_the_published_layout(subscription, stamp, payload):
    assert frames.message_frame(subscription, stamp, payload) == (
        b"\x01" + subscription.to_bytes(4, "little") + stamp.to_bytes(8, "little") + payload
    )


@given(U64)
def test_time_frames_follow_the_published_layout(stamp):
    assert frames.time_frame(stamp) == b"\x02" + stamp.to_bytes(8, "little")


@given(U32, U32, PAYLOAD)
def test_service_responses_follow_the_published_layout(service, call, payload):
    frame = frames.service_response_frame(service, call, payload)
    assert frame == b"\x03" + struct.pack("<III", service, call, 3) + b"cdr" + payload


@given(U32, PAYLOAD, TEXT)
def test_assets_follow_the_published_layout(request, data, reason):
    assert frames.asset_head(request) == b"\x04" + struct.pack("<IBI", request, 0, 0)
    text = reason.encode()
    frame = frames.asset_error_frame(request, reason)
    assert frame == b"\x04" + struct.pack("<IBI", request, 1, len(text)) + text


@given(U32, PAYLOAD)
def test_reads_publish_frames(channel, payload):
    frame = b"\x01" + channel.to_bytes(4, "little") + payload
    assert frames.parse_binary(frame) == Publish(channel, payload)


@given(U32, U32, TEXT, PAYLOAD)
def test_reads_service_requests(service, call, encoding, payload):
    text = encoding.encode()
    frame = b"\x02" + struct.pack("<III", service, call, len(text)) + text + payload
    assert frames.parse_binary(frame) == ServiceRequest(service, call, encoding, payload)


@given(st.booleans(), st.floats(width=32, allow_nan=False), st.none() | U64, TEXT)
def test_reads_playback_control(playing, speed, seek, request):
    text = request.encode()
    layout = (0 if playing else 1, speed, 0 if seek is None else 1, seek or 0, len(text))
    frame = b"\x03" + struct.pack("<BfBQI", *layout) + text
    assert frames.parse_binary(frame) == PlaybackControl(playing, speed, seek, request)


@given(st.binary(max_size=64))
def test_any_bytes_are_read_or_refused(frame):
    with contextlib.suppress(ProtocolError):
        assert isinstance(frames.parse_binary(frame), Publish | ServiceRequest | PlaybackControl)


@given(st.text(max_size=60) | st.builds(json.dumps, st.dictionaries(TEXT, TEXT | st.integers())))
def test_any_text_is_read_or_refused(frame):
    with contextlib.suppress(ProtocolError):
        assert isinstance(complete(protocol.parse_text(frame)), ClientMessage)


def test_reads_what_a_client_says():
    frame = '{"op": "subscribe", "subscriptions": [{"id": 1, "channelId": 4294967295, "more": true}]}'
    assert complete(protocol.parse_text(frame)) == protocol.Subscribe((protocol.ChannelSubscription(1, 4294967295),))


@pytest.mark.parametrize(
    ("frame", "error"),
    [
        ({"op": "subscribe"}, 'expected "subscriptions" to be a list of objects'),
        ({"op": "subscribe", "subscriptions": [3]}, 'expected "subscriptions" to be a list of objects'),
        ({"op": "subscribe", "subscriptions": [{"id": -1}]}, 'expected "id" to be a number of 32 bits'),
        ({"op": "unsubscribe", "subscriptionIds": ["a"]}, 'expected "subscriptionIds" to be a list of numbers'),
        ({"op": "getParameters", "parameterNames": [3]}, 'expected "parameterNames" to be a list of strings'),
        ({"op": "getParameters", "parameterNames": [], "id": 3}, 'expected "id" to be a string'),
        ({"op": "fetchAssets"}, "unknown op 'fetchAssets'"),
        ({"op": 3}, 'expected a JSON object with a string "op"'),
    ],
)
def test_says_which_field_is_not_what_it_must_be(frame, error):
    with pytest.raises(ProtocolError, match=re.escape(error)):
        complete(protocol.parse_text(json.dumps(frame)))


def test_deeply_nested_text_is_refused():
    with pytest.raises(ProtocolError):
        complete(protocol.parse_text("[" * 100_000))


@pytest.mark.parametrize(
    ("name", "full"),
    [
        ("geometry_msgs/PoseStamped", "geometry_msgs/msg/PoseStamped"),
        ("geometry_msgs/msg/PoseStamped", "geometry_msgs/msg/PoseStamped"),
        ("my_srvs/srv/Do_Request", "my_srvs/srv/Do_Request"),
    ],
)
def test_spells_types_in_full(name, full):
    assert protocol.full_type_name(name) == full


VALUES = (
    st.none()
    | st.booleans()
    | st.integers(-(2**63), 2**63 - 1)
    | st.floats(allow_nan=False)
    | TEXT
    | st.binary(max_size=20)
    | st.lists(st.booleans(), max_size=4)
    | st.lists(st.integers(-(2**63), 2**63 - 1), max_size=4)
    | st.lists(st.floats(allow_nan=False), max_size=4)
    | st.lists(TEXT, max_size=4)
)


@given(VALUES)
def test_parameters_survive_the_way_to_a_client_and_back(value):
    frame = json.loads(protocol.parameter_values([Parameter("/node.p", value)]), parse_constant=_refuse)
    again = _parse_parameter(frame["parameters"][0]).value
    assert again == value
    assert type(again) is type(value)


def _parse_parameter(entry):
    message = complete(protocol.parse_text(json.dumps({"op": "setParameters", "parameters": [entry]})))
    return protocol.parse_parameter(message.parameters[0])


def _refuse(constant):
    raise AssertionError(f"{constant} is not valid JSON")


def test_a_value_that_is_not_a_number_survives():
    frame = json.loads(protocol.parameter_values([Parameter("/n.p", math.nan)]))
    assert math.isnan(_parse_parameter(frame["parameters"][0]).value)


@pytest.mark.parametrize(
    "entry",
    [
        {},
        {"name": 3},
        "text",
        {"name": "/n.p", "value": {"a": 1}},
        {"name": "/n.p", "value": [1, "a"]},
        {"name": "/n.p", "value": "%%%", "type": "byte_array"},
        {"name": "/n.p", "value": None, "type": "float64"},
        {"name": "/n.p", "value": ["x"], "type": "float64_array"},
    ],
)
def test_bad_parameters_are_refused_by_name(entry):
    with pytest.raises(ProtocolError) as caught:
        _parse_parameter(entry)
    assert "/n.p" in str(caught.value) or '"name"' in str(caught.value) or '"parameters"' in str(caught.value)


def test_time_is_claimed_only_where_there_is_time():
    without = json.loads(protocol.server_info("n", "s", False, {"ROS_DISTRO": "jazzy"}))
    assert "time" not in without["capabilities"]
    assert without["metadata"] == {"ROS_DISTRO": "jazzy"}
    assert "time" in json.loads(protocol.server_info("n", "s", True, {}))["capabilities"]


def test_channels_carry_their_schema():
    topics = {3: Topic("/a", "std_msgs/msg/Empty", ""), 4: Topic("/b", "x/msg/Y", None)}
    known, unknown = json.loads(protocol.advertise(topics))["channels"]
    assert known == {
        "id": 3,
        "topic": "/a",
        "encoding": "cdr",
        "schemaName": "std_msgs/msg/Empty",
        "schema": "",
        "schemaEncoding": "ros2msg",
    }
    assert unknown["schema"] == ""
    assert "schemaEncoding" not in unknown


def test_services_carry_both_generations_of_schemas():
    frame = protocol.advertise_services({9: Service("/s", "p/srv/S", "int32 a", "int32 b")})
    (entry,) = json.loads(frame)["services"]
    assert entry["requestSchema"] == entry["request"]["schema"] == "int32 a"
    assert entry["responseSchema"] == entry["response"]["schema"] == "int32 b"
    assert entry["request"]["schemaName"] == "p/srv/S_Request"


NODES = st.frozensets(st.sampled_from(["a", "b", "c"]), max_size=3)
NAMES = st.dictionaries(st.sampled_from(["/x", "/y", "/z"]), NODES, max_size=3)
GRAPHS = st.builds(Graph, NAMES, NAMES, NAMES)


@given(GRAPHS, GRAPHS)
def test_updates_of_the_graph_lead_from_one_graph_to_the_other(before, after):
    frame = protocol.connection_graph_update(before, after)
    assert _apply(before, frame) == _without_nobody(after)


def _apply(graph, frame):
    parts = {"publishers": dict(graph.publishers), "subscribers": dict(graph.subscribers)}
    parts["services"] = dict(graph.services)
    if frame is not None:
        update = json.loads(frame)
        keys = [
            ("publishers", "publishedTopics", "publisherIds"),
            ("subscribers", "subscribedTopics", "subscriberIds"),
            ("services", "advertisedServices", "providerIds"),
        ]
        for part, key, ids in keys:
            for entry in update[key]:
                parts[part][entry["name"]] = frozenset(entry[ids])
        for name in update["removedTopics"]:
            parts["publishers"].pop(name, None)
            parts["subscribers"].pop(name, None)
        for name in update["removedServices"]:
            parts["services"].pop(name, None)
    return _without_nobody(Graph(**parts))


def _without_nobody(graph):
    """A name with nobody behind it says as much as no name."""
    return Graph(
        *({name: nodes for name, nodes in part.items() if nodes} for part in (graph.publishers, graph.subscribers)),
        services={name: nodes for name, nodes in graph.services.items() if nodes},
    )


@pytest.mark.parametrize("value", [2**63, -(2**63) - 1, [1, "a"], [True, 1], [2**70], {"a": 1}])
def test_values_that_no_parameter_can_hold_are_refused(value):
    with pytest.raises(ProtocolError, match="cannot hold"):
        protocol.parse_parameter(protocol.ParameterEntry("/node.x", value))


def test_a_lone_surrogate_is_refused():
    with pytest.raises(ProtocolError, match="not JSON"):
        complete(protocol.parse_text('{"op": "getParameters", "parameterNames": ["/a.\\ud800"]}'))


def test_a_long_list_is_read_in_steps_and_many_values_are_refused():
    frame = json.dumps({"op": "subscribe", "subscriptions": [{"id": number, "channelId": 1} for number in range(100)]})
    assert len(list(protocol.parse_text(frame))) == 100
    with pytest.raises(ProtocolError, match="more than 10 values"):
        next(protocol.parse_text(frame, max_values=10))
