import threading
import time

import numpy as np
import pytest
from geometry_msgs.msg import Quaternion, Transform, TransformStamped, Vector3
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.serialization import deserialize_message, serialize_message
from sensor_msgs.msg import JointState
from std_msgs.msg import Header
from tf2_msgs.msg import TFMessage

from daidalos.nodes.robot_state_publisher._transform_bytes import TransformBytes
from daidalos.nodes.robot_state_publisher.robot_state_publisher import RobotStatePublisher
from daidalos.nodes.runner import UserError
from ros.graph import graph, node, spinning  # noqa: F401


@pytest.mark.parametrize("count", [0, 1, 7])
def test_bytes_are_those_of_the_codec(count):
    random = np.random.default_rng(count)
    parents = ["p" * int(random.integers(0, 9)) for _ in range(count)]
    children = ["ä" * int(random.integers(0, 9)) for _ in range(count)]
    translations, rotations = random.normal(size=(count, 3)), random.normal(size=(count, 4))
    header = [Header(frame_id=parent) for parent in parents]
    for each in header:
        each.stamp.sec, each.stamp.nanosec = -5, 999_999_999
    transforms = [
        TransformStamped(
            header=header[i],
            child_frame_id=children[i],
            transform=Transform(
                translation=Vector3(**dict(zip("xyz", translations[i].tolist(), strict=True))),
                rotation=Quaternion(**dict(zip("xyzw", rotations[i].tolist(), strict=True))),
            ),
        )
        for i in range(count)
    ]
    written = TransformBytes(parents, children).write(-5, 999_999_999, translations, rotations)
    assert written == bytes(serialize_message(TFMessage(transforms=transforms)))


def chain(joints):
    links = "".join(f"<link name='l{i}'/>" for i in range(joints + 1))
    parts = "".join(
        f"<joint name='j{i}' type='continuous'><parent link='l{i}'/><child link='l{i + 1}'/><origin xyz='0 0 0.1'/>"
        "<axis xyz='0 1 0'/></joint>"
        for i in range(joints)
    )
    return f"<robot name='chain'>{links}{parts}</robot>"


def publisher(text, **parameters):
    values = {"robot_description": text, **parameters}
    return RobotStatePublisher(parameter_overrides=[Parameter(name, value=value) for name, value in values.items()])


def chain_in_sdf(joints):
    links = "".join(f"<link name='l{i}'><pose>0 0 {0.1 * i} 0 0 0</pose></link>" for i in range(joints + 1))
    parts = "".join(
        f"<joint name='j{i}' type='revolute'><parent>l{i}</parent><child>l{i + 1}</child>"
        "<axis><xyz>0 1 0</xyz></axis></joint>"
        for i in range(joints)
    )
    return f"<?xml version='1.0'?><sdf version='1.8'><model name='chain'>{links}{parts}</model></sdf>"


@pytest.mark.parametrize("written", [chain, chain_in_sdf])
def test_joint_states_become_transforms(node, written):  # noqa: F811
    state_publisher = publisher(written(2), frame_prefix="bot/")
    received = []
    done = threading.Event()
    node.create_subscription(TFMessage, "/tf", lambda message: (received.append(message), done.set()), 10)
    told = node.create_publisher(JointState, "/joint_states", 10)
    with spinning(node, state_publisher):
        message = JointState(name=["nobody", "j1", "j0"], position=[9.0, np.pi / 2, 0.0])
        message.header.stamp.sec = 3
        told.publish(message)
        assert done.wait(5.0)
    first, second = received[0].transforms
    assert (first.header.frame_id, first.child_frame_id) == ("bot/l0", "bot/l1")
    assert first.transform.rotation.w == 1.0
    assert first.transform.translation.z == pytest.approx(0.1)
    assert second.header.stamp.sec == 3
    assert (second.transform.rotation.y, second.transform.rotation.w) == pytest.approx((np.sqrt(0.5),) * 2)
    state_publisher.destroy_node()


def states(seconds, **positions):
    message = JointState(name=list(positions), position=list(positions.values()))
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(round(seconds * 1e9), 10**9)
    return message


@pytest.fixture
def sent(graph, monkeypatch):  # noqa: F811
    """Makes a node and returns it with the list of what it publishes on /tf."""
    nodes = []

    def make(text, **parameters):
        nodes.append(publisher(text, **parameters))
        received = []
        monkeypatch.setattr(nodes[-1]._tf_publisher, "publish", lambda data: received.append(data))
        return nodes[-1], received

    yield make
    for each in nodes:
        each.destroy_node()


def children(data):
    return [transform.child_frame_id for transform in deserialize_message(data, TFMessage).transforms]


def test_only_what_is_told_of_has_a_transform(sent):
    state_publisher, received = sent(chain(3).replace("</robot>", MIMIC))
    state_publisher._on_joint_states(states(1.0, j2=0.2, j0=0.1))
    state_publisher._on_joint_states(states(1.0, j1=0.3))
    state_publisher._on_joint_states(states(1.0, nobody=0.3))
    assert [children(data) for data in received] == [["l1", "m", "l3"], ["l2"]]
    assert state_publisher._positions.tolist() == [0.1, 0.3, 0.2]


MIMIC = """<link name="m"/><joint name="k" type="continuous"><parent link="l0"/><child link="m"/>
<mimic joint="j0"/></joint></robot>"""


def test_states_come_as_often_as_wanted_though_not_on_time(sent):
    random = np.random.default_rng(1)
    late = random.uniform(0, 0.008, 1000)
    for rate, expected in ((100.0, 1000), (20.0, 200)):
        state_publisher, received = sent(chain(1), publish_frequency=rate)
        for i in range(1000):
            state_publisher._on_joint_states(states(5 + 0.01 * i + late[i], j0=0.0))
        assert len(received) == pytest.approx(expected, abs=3)


def test_two_who_tell_of_different_joints_are_both_heard(sent):
    state_publisher, received = sent(chain(2), publish_frequency=10.0)
    for i in range(100):
        state_publisher._on_joint_states(states(5 + 0.1 * i, j0=0.0))
        state_publisher._on_joint_states(states(5 + 0.1 * i + 0.001, j1=0.0))
    assert len(received) == 200


def test_a_clock_may_be_set_back(sent):
    state_publisher, received = sent(chain(1))
    for seconds in (50.0, 1.0, 1.01, 1.06):
        state_publisher._on_joint_states(states(seconds, j0=0.0))
    assert len(received) == 3


def test_transforms_of_a_joint_never_go_back_a_little(sent):
    """Two may tell of the same joint, each with its own view of the time."""
    state_publisher, received = sent(chain(1), publish_frequency=30.0)
    for i in range(100):
        state_publisher._on_joint_states(states(5 + 0.01 * i, j0=0.0))
        state_publisher._on_joint_states(states(5 + 0.01 * i - 0.02, j0=0.0))
    stamps = [deserialize_message(data, TFMessage).transforms[0].header.stamp for data in received]
    times = [stamp.sec + 1e-9 * stamp.nanosec for stamp in stamps]
    assert len(times) == pytest.approx(30, abs=3)
    assert times == sorted(times)


def test_states_without_a_time_count_only_when_times_are_ignored(sent):
    for ignored in (False, True):
        state_publisher, received = sent(chain(1), ignore_timestamp=ignored)
        state_publisher._on_joint_states(states(0.0, j0=0.0))
        assert len(received) == ignored


@pytest.mark.parametrize(("type_", "expected"), [("floating", []), ("planar", ["l1"]), ("fixed", ["l1"])])
def test_what_floats_is_left_to_others(sent, node, type_, expected):  # noqa: F811
    received, done = [], threading.Event()
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    node.create_subscription(TFMessage, "/tf_static", lambda message: (received.append(message), done.set()), latched)
    state_publisher, _ = sent(chain(1).replace("continuous", type_))
    with spinning(node, state_publisher):
        assert done.wait(5.0)
    assert [each.child_frame_id for each in received[0].transforms] == expected


def test_a_missing_description_is_named(graph):  # noqa: F811
    with pytest.raises(UserError, match="robot_description"):
        publisher("")


@pytest.mark.timing
def test_a_thousand_joints_take_less_than_a_millisecond(graph):  # noqa: F811
    """At 100 Hz that is a tenth of a core: decoding, kinematics and encoding together."""
    state_publisher = publisher(chain(1000), publish_frequency=0.0)
    names = [f"j{i}" for i in range(1000)]
    data = bytes(serialize_message(states(1.0, **dict(zip(names, np.linspace(0, 1, 1000).tolist(), strict=True)))))
    times = []
    for _ in range(60):
        begun = time.thread_time()
        state_publisher._on_joint_states(deserialize_message(data, JointState))
        times.append(time.thread_time() - begun)
    assert np.median(times) < 1e-3
    state_publisher.destroy_node()
