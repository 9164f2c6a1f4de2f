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
    heard = threading.Event()
    qos = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    node.create_subscription(String, "/word", lambda message: heard.set(), qos)
    publisher = node.create_publisher(String, "/model/m/word", 10)
    with spinning(node, bridge):
        publisher.publish(String(data="hello"))
        assert heard.wait(5.0)
    bridge.destroy_node()


def test_both_sides_are_heard_and_nothing_goes_round(node):  # noqa: F811
    bridge = ParameterBridge(
        ["/model/m/word@std_msgs/msg/String@gz.msgs.StringMsg"], cli_args=["--ros-args", "-r", "/model/m/word:=/word"]
    )
    heard = {"/word": [], "/model/m/word": []}
    done = threading.Event()

    def hear(topic, message):
        heard[topic].append(message.data)
        if all(words.count("end") == 2 for words in heard.values()):
            done.set()

    for topic in heard:
        node.create_subscription(String, topic, lambda message, topic=topic: hear(topic, message), 10)
    ros, gz = (node.create_publisher(String, topic, 10) for topic in heard)
    with spinning(node, bridge):
        gz.publish(String(data="from gz"))
        ros.publish(String(data="from ros"))
        for publisher in (ros, gz):
            publisher.publish(String(data="end"))
        assert done.wait(5.0)
        for words in heard.values():
            assert words.count("from gz") == words.count("from ros") == 1
    bridge.destroy_node()


def test_a_topic_of_the_same_name_needs_no_bridge(graph):  # noqa: F811
    bridge = ParameterBridge(["/word@std_msgs/msg/String@gz.msgs.StringMsg"])
    assert not rclpy.create_node("looker").get_publishers_info_by_topic("/word")
    bridge.destroy_node()
