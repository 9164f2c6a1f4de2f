import threading
import time

import numpy as np
import pytest
from geometry_msgs.msg import Quaternion, Transform, TransformStamped, Vector3
from rclpy.parameter import Parameter
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
    heard = []
    done = threading.Event()
    node.create_subscription(TFMessage, "/tf", lambda message: (heard.append(message), done.set()), 10)
    states = node.create_publisher(JointState, "/joint_states", 10)
    with spinning(node, state_publisher):
        message = JointState(name=["nobody", "j1"], position=[9.0, np.pi / 2])
        message.header.stamp.sec = 3
        states.publish(message)
        assert done.wait(5.0)
    first, second = heard[0].transforms
    assert (first.header.frame_id, first.child_frame_id) == ("bot/l0", "bot/l1")
    assert first.transform.rotation.w == 1.0
    assert first.transform.translation.z == pytest.approx(0.1)
    assert second.header.stamp.sec == 3
    assert (second.transform.rotation.y, second.transform.rotation.w) == pytest.approx((np.sqrt(0.5),) * 2)
    state_publisher.destroy_node()


def test_names_may_change_from_message_to_message(graph):  # noqa: F811
    state_publisher = publisher(chain(3))
    state_publisher._take(["j2", "j0"], [0.2, 0.1])
    state_publisher._take(["j1"], [0.3])
    assert state_publisher._positions.tolist() == [0.1, 0.3, 0.2]
    state_publisher.destroy_node()


def test_a_missing_description_is_named(graph):  # noqa: F811
    with pytest.raises(UserError, match="robot_description"):
        publisher("")


def test_a_thousand_joints_take_less_than_a_millisecond(graph):  # noqa: F811
    """At 100 Hz that is a tenth of a core: decoding, kinematics and encoding together."""
    state_publisher = publisher(chain(1000), publish_frequency=0.0)
    names = [f"j{i}" for i in range(1000)]
    data = bytes(serialize_message(JointState(name=names, position=np.linspace(0, 1, 1000))))
    times = []
    for _ in range(60):
        begun = time.thread_time()
        state_publisher._on_joint_states(deserialize_message(data, JointState))
        times.append(time.thread_time() - begun)
    assert np.median(times) < 1e-3
    state_publisher.destroy_node()
