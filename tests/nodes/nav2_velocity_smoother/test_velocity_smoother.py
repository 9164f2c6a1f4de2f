"""The velocity smoother's managed node, under a stepped clock."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import pytest
from geometry_msgs.msg import Twist, TwistStamped, Vector3
from nav_msgs.msg import Odometry
from rcl_interfaces.msg import Log
from rclpy.lifecycle import TransitionCallbackReturn
from rclpy.parameter import Parameter

from daidalos.nodes.nav2_velocity_smoother.velocity_smoother import VelocitySmootherNode
from nodes.stepped import Stage

pytestmark = pytest.mark.timeout(120)
Set = Callable[[dict[str, Any]], Stage]


class Bench:
    """The node, active, with what it publishes and logs."""

    def __init__(self, set_stage: Set, **parameters: Any) -> None:
        self.stage = stage = set_stage({"/velocity_smoother": parameters})
        self.kind = TwistStamped if parameters.get("enable_stamped_cmd_vel") else Twist
        self.log = stage.collect(Log, "/rosout", 100)
        self.node = stage.add(VelocitySmootherNode())
        self.sent = stage.collect(self.kind, "cmd_vel_smoothed")
        self.commands = stage.node.create_publisher(self.kind, "cmd_vel", 1)
        self.odometry = stage.node.create_publisher(Odometry, "odom", 1)
        assert self.node.trigger_configure() == TransitionCallbackReturn.SUCCESS
        stage.step_until(lambda: self.commands.get_subscription_count() > 0)

    def activate(self) -> Bench:
        self.node.trigger_activate()
        return self

    def command(self, x: float, stamp: Any = None) -> None:
        twist = Twist(linear=Vector3(x=x))
        if self.kind is TwistStamped:
            message = TwistStamped(twist=twist)
            message.header.stamp = self.stage.stamp if stamp is None else stamp
            message.header.frame_id = "base_link"
            self.commands.publish(message)
        else:
            self.commands.publish(twist)
        self.stage.step()

    def drive(self, x: float, seconds: float) -> None:
        for _ in range(round(seconds / 0.05)):
            self.command(x)

    @property
    def speeds(self) -> list[float]:
        return [(one.twist if self.kind is TwistStamped else one).linear.x for one in self.sent]

    def has_logged(self, word: str) -> bool:
        return any(word in one.msg for one in self.log)


@pytest.mark.slow
def test_commands_are_smoothed_while_active_and_time_out(stage: Set) -> None:
    bench = Bench(stage, max_accel=[1.0, 0.0, 1.0], velocity_timeout=0.5, use_realtime_priority=False)
    bench.drive(0.4, 0.5)
    assert not bench.sent
    bench.activate()
    bench.drive(0.9, 1.0)
    assert bench.speeds[-1] == pytest.approx(0.5)
    assert max(after - before for before, after in zip([0.0, *bench.speeds], bench.speeds, strict=False)) < 0.051
    bench.stage.step_until(lambda: bench.speeds[-1] == 0.0)
    bench.stage.step_for(0.5)
    count = len(bench.sent)
    bench.stage.step_for(0.5)
    assert len(bench.sent) == count
    assert bench.has_logged("without effect: use_realtime_priority")
    bench.drive(0.3, 0.5)
    assert bench.speeds[-1] == pytest.approx(0.3)
    bench.node.trigger_deactivate()
    bench.stage.step_until(lambda: bench.speeds[-1] == 0.0)
    count = len(bench.sent)
    bench.drive(0.3, 0.3)
    assert len(bench.sent) == count


def test_commands_that_are_late_or_not_finite_do_not_move_the_robot(stage: Set) -> None:
    bench = Bench(stage, enable_stamped_cmd_vel=True, velocity_timeout=0.5).activate()
    old = bench.stage.stamp
    bench.stage.step_for(1.0)
    bench.command(0.3, old)
    bench.stage.step_until(lambda: bench.has_logged("s old and ignored"))
    assert not bench.sent
    bench.drive(0.3, 0.5)
    assert bench.speeds[-1] == pytest.approx(0.3)
    assert bench.sent[-1].header.frame_id == "base_link"
    bench.command(math.nan)
    bench.stage.step_until(lambda: bench.speeds[-1] == 0.0)
    assert bench.has_logged("is not finite")
    bench.drive(0.3, 0.3)
    assert bench.speeds[-1] > 0.2
    assert all(math.isfinite(one) for one in bench.speeds)


def test_closed_loop_begins_at_the_odometry_and_goes_on_without_it(stage: Set) -> None:
    bench = Bench(stage, feedback="CLOSED_LOOP", max_accel=[1.0, 0.0, 1.0], odom_duration=0.05).activate()
    odometry = Odometry()
    odometry.twist.twist.linear.x = 0.2
    for _ in range(10):
        bench.odometry.publish(odometry)
        bench.command(0.4)
    assert bench.speeds[-1] == pytest.approx(0.25)
    odometry.twist.twist.linear.x = math.nan
    bench.odometry.publish(odometry)
    bench.drive(0.4, 1.5)
    assert bench.has_logged("is not finite and ignored")
    assert bench.has_logged("there is no odometry on 'odom'")
    assert bench.speeds[-1] == pytest.approx(0.4)


def test_parameters_change_while_it_is_active(stage: Set) -> None:
    bench = Bench(stage).activate()
    bench.drive(0.5, 0.5)
    assert bench.speeds[-1] == pytest.approx(0.5)
    values = {"max_velocity": [0.2, 0.0, 1.0], "smoothing_frequency": 10.0}
    changes = bench.node.set_parameters([Parameter(name, value=value) for name, value in values.items()])
    assert all(one.successful for one in changes)
    count = len(bench.sent)
    bench.drive(0.5, 1.0)
    assert bench.speeds[-1] == pytest.approx(0.2)
    assert len(bench.sent) - count == pytest.approx(10, abs=2)
    refused = bench.node.set_parameters([Parameter("max_accel", value=[-1.0, 0.0, 1.0])])[0]
    assert not refused.successful
    assert "max_accel" in refused.reason
