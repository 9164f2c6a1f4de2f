"""Built-in checks and reports as programs use them: by class and by entry point."""

from __future__ import annotations

import pytest
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from ros2doctor.api import generate_reports, run_checks
from ros2doctor.api.graph import shared_graph
from ros2doctor.api.platform import PlatformCheck
from ros2doctor.api.qos_compatibility import QoSCompatibilityCheck, QoSCompatibilityReport
from ros2doctor.api.topic import TopicCheck, TopicReport
from std_msgs.msg import String

from ros.graph import graph, node  # noqa: F401


def test_nothing_to_report_is_said(node: Node) -> None:  # noqa: F811
    with shared_graph(node.handle.graph):
        assert (TopicCheck().check().error, TopicCheck().check().warning) == (0, 0)
        assert TopicReport().report().items == [("topic", "none"), ("publisher count", 0), ("subscriber count", 0)]
        assert [name for name, _ in QoSCompatibilityReport().report().items] == ["compatibility status"]


def test_ends_that_do_not_meet_are_counted(node: Node) -> None:  # noqa: F811
    node.create_publisher(String, "/lonely", 1)
    node.create_publisher(String, "/weak", QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT))
    node.create_subscription(String, "/weak", print, 1)
    with shared_graph(node.handle.graph):
        with pytest.warns(UserWarning, match="Publisher without subscriber detected on /lonely"):
            assert TopicCheck().check().warning == 1
        with pytest.warns(UserWarning, match=r"ERROR: QoS .*/weak.*; Best effort publisher and reliable subscription;"):
            assert QoSCompatibilityCheck().check().error == 1
        with pytest.warns(UserWarning, match="ERROR: QoS"):
            failed, fails, _ = run_checks(exclude_packages=True)
        assert "middleware" in failed
        assert fails == len(failed)
        titles = {report.name for report in generate_reports(categories={"topic", "middleware"})}
        assert titles == {"TOPIC LIST", "QOS COMPATIBILITY LIST", "RMW MIDDLEWARE"}
        pair = dict(QoSCompatibilityReport().report().items)
        assert pair == {
            "topic [type]": "/weak [std_msgs/msg/String]",
            "publisher node": node.get_name(),
            "subscriber node": node.get_name(),
            "compatibility status": "ERROR: Best effort publisher and reliable subscription;",
        }
        versions = [one for one in generate_reports(exclude_packages=["std_msgs"]) if one.name == "PACKAGE VERSIONS"]
        assert "std_msgs" not in dict(versions[0].items)


def test_another_distribution_in_the_shell_is_warned_of(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_DISTRO", "humble")
    with pytest.warns(UserWarning, match="ROS_DISTRO is humble"):
        assert PlatformCheck().check().warning == 1
