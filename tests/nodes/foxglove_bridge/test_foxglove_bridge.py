"""The node's settings: exposure, encryption and its errors."""

from pathlib import Path

import pytest
from rcl_interfaces.msg import Log
from rclpy.node import Node
from rclpy.parameter import Parameter

from daidalos.nodes.foxglove_bridge.foxglove_bridge import FoxgloveBridge
from daidalos.nodes.runner import UserError
from ros.graph import graph, node, spinning  # noqa: F401


def bridge(node: Node, **settings: object) -> FoxgloveBridge:  # noqa: F811
    overrides = [Parameter(name, value=value) for name, value in {"port": 0, **settings}.items()]
    return FoxgloveBridge(context=node.context, parameter_overrides=overrides)


def test_beyond_loopback_the_terminal_has_the_token_and_the_log_has_not(
    node: Node,  # noqa: F811
    capfd: pytest.CaptureFixture[str],
) -> None:
    lines: list[str] = []
    node.create_subscription(Log, "/rosout", lambda line: lines.append(line.msg), 1000)
    with spinning(node):
        exposed = bridge(node, address="0.0.0.0")
        exposed.destroy_node()
    printed = [line for line in capfd.readouterr().err.splitlines() if "token=" in line]
    assert [line.partition(": ")[0] for line in printed] == ["studio", "studio for other machines"]
    assert not [line for line in lines if "token=" in line]


def test_a_chosen_token_is_asked_for_on_loopback_too(
    node: Node,  # noqa: F811
    monkeypatch: pytest.MonkeyPatch,
    capfd: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setenv("DAIDALOS_STUDIO_TOKEN", "0123456789abcdef")
    bridge(node).destroy_node()
    assert "/?token=0123456789abcdef" in capfd.readouterr().err
    monkeypatch.setenv("DAIDALOS_STUDIO_TOKEN", "short")
    with pytest.raises(UserError, match="expected at least 16"):
        bridge(node)


def test_a_certificate_that_cannot_be_used_is_named(node: Node, tmp_path: Path) -> None:  # noqa: F811
    with pytest.raises(UserError, match="certfile"):
        bridge(node, tls=True)
    missing = tmp_path / "none.pem"
    with pytest.raises(UserError, match=f"{missing}: there is no such file"):
        bridge(node, tls=True, certfile=str(missing))
    missing.write_text("no certificate")
    with pytest.raises(UserError, match=f"{missing}: cannot be used"):
        bridge(node, tls=True, certfile=str(missing))
