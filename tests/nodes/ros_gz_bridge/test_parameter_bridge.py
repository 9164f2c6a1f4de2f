import threading

import rclpy
from geometry_msgs.msg import PoseArray, TransformStamped, Twist, TwistStamped
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import String
from tf2_msgs.msg import TFMessage

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


def test_a_stamped_command_reaches_a_simulator_that_takes_it_unstamped(node, capfd):  # noqa: F811
    received = threading.Event()
    speeds = []

    def on_twist(twist):
        speeds.append(twist.linear.x)
        received.set()

    node.create_subscription(Twist, "/cmd_vel", on_twist, 10)
    bridge = ParameterBridge(["/cmd_vel@geometry_msgs/msg/TwistStamped]gz.msgs.Twist"])
    publisher = node.create_publisher(TwistStamped, "/cmd_vel", 10)
    with spinning(node, bridge):
        command = TwistStamped()
        command.twist.linear.x = 0.25
        _publish_when_matched(node, publisher, command)
        assert received.wait(5.0)
    assert speeds == [0.25]
    bridge.destroy_node()
    assert not [
        line for line in capfd.readouterr().err.splitlines() if "Incompatible" in line and "ros_gz_bridge" in line
    ]


def test_a_simulators_publisher_of_another_type_that_comes_later_is_converted(node):  # noqa: F811
    bridge = ParameterBridge(["/model/m/pose@geometry_msgs/msg/PoseArray[gz.msgs.Pose_V"])
    received = threading.Event()
    node.create_subscription(PoseArray, "/model/m/pose", lambda poses: received.set(), 10)
    publisher = node.create_publisher(TFMessage, "/model/m/pose", 10)
    with spinning(node, bridge):
        _publish_when_matched(node, publisher, TFMessage(transforms=[TransformStamped()]))
        assert received.wait(5.0)
    bridge.destroy_node()


def _publish_when_matched(node, publisher, message):  # noqa: F811
    assert node.handle.graph.wait_for(lambda: publisher.get_subscription_count() > 0, 5.0)
    publisher.publish(message)
