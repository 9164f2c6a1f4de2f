import pytest

from daidalos.simulation.topics import absolute_topic, frame, join_namespaces


@pytest.mark.parametrize(
    ("name", "namespace", "topic"),
    [
        ("scan", "", "/scan"),
        ("scan", "robot", "/robot/scan"),
        ("scan", "/a/b/", "/a/b/scan"),
        ("/scan", "robot", "/scan"),
        ("front//scan", "/", "/front/scan"),
    ],
)
def test_topics(name, namespace, topic):
    assert absolute_topic(name, namespace) == topic


def test_namespaces_and_frames():
    assert join_namespaces("a", "b") == "/a/b"
    assert join_namespaces("a", "/b") == "/b"
    assert join_namespaces("a", "") == "a"
    assert frame("/odom") == "odom"
