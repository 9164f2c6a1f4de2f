import threading

import rclpy
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import String

from daidalos.nodes.ros_gz_bridge.parameter_bridge import ParameterBridge
from ros.graph import graph, node, spinning  # noqa: F401


def test_a_topic_of_another_name_is_passed_on(node):  # noqa: F811
    latched = ["-p", "qos_overrides./word.publisher.durability:=transient_local"]
    bridge = ParameterBridge(
        ["/model/m/word@std_msgs/msg/String[gz.msgs.StringMsg"],
        cli_args=["--ros-args", "-r", "/model/m/word:=/word", *latched],
    )
    received = threading.Event()
    qos = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    node.create_subscription(String, "/word", lambda message: received.set(), qos)
    publisher = node.create_publisher(String, "/model/m/word", 10)
    with spinning(node, bridge):
        publisher.publish(String(data="hello"))
        assert received.wait(5.0)
    bridge.destroy_node()


def test_both_sides_are_heard_and_nothing_goes_round(node):  # noqa: F811
    bridge = ParameterBridge(
        ["/model/m/word@std_msgs/msg/String@gz.msgs.StringMsg"], cli_args=["--ros-args", "-r", "/model/m/word:=/word"]
    )
    received = {"/word": [], "/model/m/word": []}
    done = threading.Event()

    def hear(topic, message):
        received[topic].append(message.data)
        if all(words.count("end") == 2 for words in received.values()):
            done.set()

    for topic in received:
        node.create_subscription(String, topic, lambda message, topic=topic: hear(topic, message), 10)
    ros, gz = (node.create_publisher(String, topic, 10) for topic in received)
    with spinning(node, bridge):
        gz.publish(String(data="from gz"))
        ros.publish(String(data="from ros"))
        for publisher in (ros, gz):
            publisher.publish(String(data="end"))
        assert done.wait(5.0)
        for words in received.values():
            assert words.count("from gz") == words.count("from ros") == 1
    bridge.destroy_node()


def test_a_topic_of_the_same_name_needs_no_bridge(graph):  # noqa: F811
    bridge = ParameterBridge(["/word@std_msgs/msg/String@gz.msgs.StringMsg"])
    assert not rclpy.create_node("looker").get_publishers_info_by_topic("/word")
    bridge.destroy_node()
