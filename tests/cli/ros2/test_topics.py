from argparse import ArgumentParser

import pytest
import rclpy
from nav_msgs.msg import Odometry
from rclpy.executors import SingleThreadedExecutor
from rclpy.qos import DurabilityPolicy, QoSProfile
from sensor_msgs.msg import LaserScan
from std_msgs.msg import String

from daidalos.cli.ros2.errors import CliError
from daidalos.cli.ros2.topic.bw import BandwidthMeter
from daidalos.cli.ros2.topic.delay import DelayMeter
from daidalos.cli.ros2.topic.echo import EchoVerb, Losses
from daidalos.cli.ros2.topic.hz import Rate, RateMeter, table
from daidalos.cli.ros2.topics import Field, filter_function, subscribe


def test_fields_by_path():
    odometry = Odometry(child_frame_id="base")
    odometry.pose.pose.position.x = 1.5
    assert Field("pose.pose.position.x").of(odometry) == 1.5
    assert Field("pose.covariance.[35]").of(odometry) == 0.0
    assert Field("child_frame_id").of(odometry) == "base"
    assert Field("ranges[1]").of(LaserScan(ranges=[1.0, 2.0])) == 2.0


@pytest.mark.parametrize(
    ("path", "fault"),
    [
        (".", r"^Invalid field value '\.'$"),
        ("pose..x", "^Invalid field value"),
        ("not_member", "^Invalid field 'not_member': 'Odometry' object has no attribute 'not_member'$"),
        ("pse", "^Invalid field 'pse': 'Odometry' object has no attribute 'pse'\nDid you mean 'pose'"),
        ("pose.covariance.[36]", "^Invalid field 'pose.covariance.\\[36\\]': index 36 is out of bounds"),
        ("child_frame_id.[0].x", "'child_frame_id.\\[0\\].x'"),
        ("pose.covariance.[0].[0]", "invalid index to scalar variable"),
    ],
)
def test_fields_that_are_not_there(path, fault):
    with pytest.raises(CliError, match=fault):
        Field(path).of(Odometry(child_frame_id="base"))


def test_filters():
    near = filter_function("min(m.ranges) < sqrt(4)")
    assert near(LaserScan(ranges=[1.0, 5.0]))
    assert not near(LaserScan(ranges=[3.0, 5.0]))
    with pytest.raises(CliError, match=r"Invalid filter expression 'm.': invalid syntax"):
        filter_function("m.")
    with pytest.raises(CliError, match="Failed to evaluate the filter expression"):
        filter_function("m.nope")(LaserScan())


@pytest.mark.slow
def test_a_latched_topic_whose_publisher_comes_after_its_listener_is_heard(monkeypatch):
    monkeypatch.setenv("RMW_IMPLEMENTATION", "rmw_daidalos_inprocess")
    parser = ArgumentParser()
    EchoVerb().add_arguments(parser, "ros2")
    with rclpy.Context() as context:
        executor = SingleThreadedExecutor(context=context)
        listener, talker = (rclpy.create_node(name, context=context) for name in ("listener", "talker"))
        executor.add_node(listener)
        talker.create_subscription(String, "latched", lambda message: None, 10)  # the topic is known, but not its QoS
        heard = []
        subscribe(
            listener,
            parser.parse_args(["/latched"]),
            "/latched",
            String,
            lambda message, info: heard.append(message.data),
        )
        publisher = talker.create_publisher(
            String, "latched", QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        )
        publisher.publish(String(data="before anybody listens"))
        for _ in range(4):
            executor.spin_once(timeout_sec=1.0)
        assert "before anybody listens" in heard
        assert len(list(listener.subscriptions)) == 1
        assert not list(listener.guards)
        listener.destroy_node()
        talker.destroy_node()


def test_rate_of_regular_and_irregular_messages():
    meter = RateMeter(100)
    for tick in range(11):
        assert meter.add(tick * 100_000_000)
    assert meter.rate() == Rate(10.0, 0.1, 0.1, 0.0, 10)
    meter = RateMeter(100)
    for second in (0, 1, 4):
        meter.add(second * 10**9)
    assert meter.rate() == Rate(0.5, 1.0, 3.0, 1.0, 2)
    assert str(meter.rate()) == "average rate: 0.500\n\tmin: 1.000s max: 3.000s std dev: 1.00000s window: 2"


def test_rate_looks_at_the_window_and_begins_anew_when_time_goes_back():
    meter = RateMeter(2)
    assert meter.rate() is None
    for second in (0, 10, 11, 12):
        meter.add(second * 10**9)
    assert meter.rate() == Rate(1.0, 1.0, 1.0, 0.0, 2)
    assert not meter.add(10**9)
    assert meter.rate() is None
    assert meter.add(2 * 10**9)
    assert meter.rate().window == 1


def test_table_of_rates_is_aligned():
    lines = table([("/a", Rate(10.0, 0.1, 0.1, 0.0, 9)), ("/much/longer", Rate(1.0, 1.0, 1.0, 0.0, 1))]).splitlines()
    assert lines[0].split() == ["topic", "rate", "min_delta", "max_delta", "std_dev", "window"]
    assert set(lines[1]) == {"="}
    assert len({len(line) for line in lines}) == 1


@pytest.mark.parametrize(
    ("size", "expected"),
    [
        (44, "220 B/s from 5 messages\n\tMessage size mean: 44 B min: 44 B max: 44 B"),
        (400, "2.00 KB/s from 5 messages\n\tMessage size mean: 0.40 KB min: 0.40 KB max: 0.40 KB"),
        (3_000_000, "15.00 MB/s from 5 messages\n\tMessage size mean: 3.00 MB min: 3.00 MB max: 3.00 MB"),
    ],
)
def test_bandwidth(size, expected):
    meter = BandwidthMeter(100)
    for tick in range(5):
        meter.add(tick * 0.2, size)
    assert meter.report(1.0) == expected


def test_bandwidth_needs_two_messages_and_looks_at_the_window():
    meter = BandwidthMeter(3)
    meter.add(0.0, 9999)
    assert meter.report(1.0) == ""
    for tick in range(1, 4):
        meter.add(float(tick), 10 * tick)
    assert meter.report(4.0) == "20 B/s from 3 messages\n\tMessage size mean: 20 B min: 10 B max: 30 B"


def test_delay():
    meter = DelayMeter(10)
    assert meter.report() == ""
    meter.add(5_000_000_000, 4_000_000_000)
    meter.add(9_000_000_000, 6_000_000_000)
    assert meter.report() == "average delay: 2.000\n\tmin: 1.000s max: 3.000s std dev: 1.00000s window: 2"
    assert meter.report() == ""


def test_losses_are_counted_per_publisher(capsys):
    def info(number, publisher):
        return {"publication_sequence_number": number, "publisher_gid": {"data": publisher}}

    losses = Losses()
    assert [losses.note(info(*one)) for one in ((5, b"a"), (6, b"a"), (1, b"b"), (9, b"a"), (2, b"b"))] == [
        0,
        0,
        0,
        2,
        0,
    ]
    assert losses.note(info(3, b"a")) == 0
    assert losses.note({"publication_sequence_number": None, "publisher_gid": None}) == 0
    assert capsys.readouterr().err == "A message was lost!!!\n\ttotal count change:2\n\ttotal count: 2\n"
