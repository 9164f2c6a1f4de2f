import pytest
from rclpy.qos import DurabilityPolicy, HistoryPolicy, ReliabilityPolicy

from daidalos.cli.ros2.bag.qos_overrides import read_overrides
from daidalos.cli.ros2.errors import CliError


def test_policies(tmp_path):
    path = tmp_path / "qos.yaml"
    path.write_text(
        "/scan:\n  reliability: best_effort\n  history: keep_all\n"
        "/map:\n  durability: transient_local\n  depth: 3\n  deadline: {sec: 1, nsec: 5}\n"
        "  avoid_ros_namespace_conventions: false\n"
    )
    found = read_overrides(str(path))
    assert (found["/scan"].reliability, found["/scan"].history) == (
        ReliabilityPolicy.BEST_EFFORT,
        HistoryPolicy.KEEP_ALL,
    )
    assert (found["/map"].durability, found["/map"].depth) == (DurabilityPolicy.TRANSIENT_LOCAL, 3)
    assert found["/map"].deadline.nanoseconds == 1_000_000_005
    assert read_overrides(None) == {}


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("- /scan", "expected a mapping of topics"),
        ("/scan: [", "line 1, column 9"),
        ("/scan: 3", "expected a mapping of QoS policies (topic /scan in "),
        ("/scan: {reliability: often}", "reliability: expected one of system_default, reliable, best_effort"),
        ("/scan: {depth: -1}", "`depth` may not be a negative value"),
        ("/scan: {deadline: {sec: 1}}", "must include both seconds"),
        ("/scan: {deadline: {sec: -1, nsec: 0}}", "may not be a negative value"),
        ("/scan: {size: 1}", "Unexpected key `size` for QoS profile"),
    ],
)
def test_what_is_not_understood(tmp_path, text, fault):
    path = tmp_path / "qos.yaml"
    path.write_text(text)
    with pytest.raises(CliError) as raised:
        read_overrides(str(path))
    assert fault in str(raised.value)
    assert "qos.yaml" in str(raised.value)
