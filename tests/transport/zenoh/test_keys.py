"""Key expressions and tokens as rmw_zenoh writes them."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from daidalos.transport.graph import EndpointInfo, EndpointKind, NodeInfo
from daidalos.transport.qos import Durability, History, Liveliness, Qos, Reliability
from daidalos.transport.zenoh import keys

STRING_HASH = "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"
TOKEN = (
    "@ros2_lv/2/aac3178e146ba6f1fc6e6a4085e77f21/0/10/MS/%/%/listener/%chatter/"
    f"std_msgs::msg::dds_::String_/{STRING_HASH}/::,10:,:,:,,"
)
NAMES = st.from_regex(r"(/[a-z][a-z0-9_]*){1,3}", fullmatch=True)


def test_the_gid_of_a_token_is_that_of_a_real_node():
    assert keys.gid_of(TOKEN).hex() == "76148a538308fe55a6c5375462ca1de6"


def test_a_real_token_is_read():
    found = keys.parse_token(TOKEN)
    assert isinstance(found, EndpointInfo)
    assert (found.kind, found.name, found.type_name) == (EndpointKind.SUBSCRIPTION, "/chatter", "std_msgs/msg/String")
    assert (found.type_hash, found.qos, found.gid) == (STRING_HASH, Qos(depth=10), keys.gid_of(TOKEN))
    assert (found.node.name, found.node.namespace, found.node.enclave) == ("listener", "/", "/")
    assert keys.session_of(TOKEN) == "aac3178e146ba6f1fc6e6a4085e77f21"


def test_a_real_token_is_written():
    session = "aac3178e146ba6f1fc6e6a4085e77f21"
    node = NodeInfo(keys.node_token(2, session, 0, "listener", "/", "/"), "listener", "/")
    assert node.key == f"@ros2_lv/2/{session}/0/0/NN/%/%/listener"
    kind = EndpointKind.SUBSCRIPTION
    assert keys.endpoint_token(node, 10, kind, "/chatter", "std_msgs/msg/String", STRING_HASH, Qos()) == TOKEN


def test_a_token_of_a_newer_distribution_may_have_more_parts():
    assert keys.parse_token(f"{TOKEN}/more").name == "/chatter"


def test_a_peer_of_humble_states_no_hash():
    assert keys.parse_token(TOKEN.replace(STRING_HASH, "TypeHashNotSupported")).type_hash == ""


@pytest.mark.parametrize(
    ("name", "type_name", "type_hash", "expected"),
    [
        ("/chatter", "std_msgs/msg/String", STRING_HASH, f"0/chatter/std_msgs::msg::dds_::String_/{STRING_HASH}"),
        ("/a/b", "p/srv/S", "", "0/a/b/p::srv::dds_::S_/TypeHashNotSupported"),
    ],
)
def test_data_keys(name, type_name, type_hash, expected):
    assert keys.data_key(0, name, type_name, type_hash) == expected


@pytest.mark.parametrize(
    ("qos", "text"),
    [
        (Qos(), "::,10:,:,:,,"),
        (Qos(depth=42), "::,:,:,:,,"),
        (Qos(durability=Durability.TRANSIENT_LOCAL, depth=1000, lifespan_ns=10 * 10**9), ":1:,1000:,:10,0:,,"),
        (Qos(Reliability.BEST_EFFORT, history=History.KEEP_ALL, depth=42), "2::2,:,:,:,,"),
        (
            Qos(liveliness=Liveliness.MANUAL_BY_TOPIC, deadline_ns=1_500_000_000, liveliness_lease_ns=2_000_000_001),
            "::,10:1,500000000:,:3,2,1",
        ),
    ],
)
def test_profiles(qos, text):
    assert keys.qos_text(qos) == text
    assert keys.parse_qos(text) == qos


QOS = st.builds(
    Qos,
    st.sampled_from([Reliability.RELIABLE, Reliability.BEST_EFFORT]),
    st.sampled_from([Durability.VOLATILE, Durability.TRANSIENT_LOCAL]),
    st.sampled_from([History.KEEP_LAST, History.KEEP_ALL]),
    st.integers(1, 2**31),
    *[st.integers(1, 2**63 - 1)] * 2,
    st.sampled_from([Liveliness.AUTOMATIC, Liveliness.MANUAL_BY_TOPIC]),
    st.integers(1, 2**63 - 1),
)


@given(QOS)
def test_profiles_come_back(qos):
    assert keys.parse_qos(keys.qos_text(qos)) == qos


@given(st.sampled_from(list(EndpointKind)), NAMES, NAMES, NAMES, QOS, st.integers(0, 232))
def test_tokens_come_back(kind, name, namespace, enclave, qos, domain):
    token = keys.node_token(domain, "ab" * 16, 3, "node", namespace, enclave)
    assert keys.parse_token(token) == NodeInfo(token, "node", namespace, enclave)
    node = NodeInfo(token, "node", namespace, enclave)
    found = keys.parse_token(keys.endpoint_token(node, 9, kind, name, "a/msg/B", STRING_HASH, qos))
    assert (found.kind, found.node, found.name, found.qos) == (kind, node, name, qos)


@given(st.lists(st.text(max_size=6).filter(lambda text: "/" not in text), max_size=16))
def test_what_is_no_token_is_passed_over(parts):
    keys.parse_token("/".join(["@ros2_lv", *parts]))
