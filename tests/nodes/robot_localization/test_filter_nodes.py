"""`ekf_node` and `ukf_node` under a stepped clock, with sensors that the test plays."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import yaml
from geometry_msgs.msg import PoseWithCovarianceStamped, TransformStamped, Twist
from nav_msgs.msg import Odometry
from rcl_interfaces.msg import Log
from robot_localization.srv import SetPose, ToggleFilterProcessing
from sensor_msgs.msg import Imu
from std_srvs.srv import Empty
from tf2_msgs.msg import TFMessage

from daidalos.common.parameters import ParameterError
from daidalos.interfaces.library import BUILT_IN
from daidalos.localization.errors import LocalizationError
from daidalos.nodes.conversions import pose_message, quaternion_message
from daidalos.nodes.robot_localization.ekf_node import EkfNode
from daidalos.nodes.robot_localization.ukf_node import UkfNode
from nodes.stepped import LATCHED, Stage

Set = Callable[[dict[str, Any]], Stage]
NAMES = ["x", "y", "z", "roll", "pitch", "yaw", "vx", "vy", "vz", "vroll", "vpitch", "vyaw", "ax", "ay", "az"]


def uses(*names: str) -> list[bool]:
    """Return a ``_config``."""
    return [name in names for name in NAMES]


class Bench:
    """A filter, its output, and one publisher for each kind of input."""

    def __init__(self, set_stage: Set, kind: type[Any] = EkfNode, **parameters: Any) -> None:
        name = "/ekf_filter_node" if kind is EkfNode else "/ukf_filter_node"
        self.stage = set_stage({name: {"two_d_mode": True, **parameters}})
        self.log = self.stage.collect(Log, "/rosout", 100)
        self.states = self.stage.collect(Odometry, "odometry/filtered")
        self.transforms = self.stage.collect(TFMessage, "/tf", 100)
        self.node = self.stage.add(kind())
        create = self.stage.node.create_publisher
        self.publishers = {"odom": create(Odometry, "odom", 10), "imu": create(Imu, "imu", 10)}
        self.poses = create(PoseWithCovarianceStamped, "pose", 10)
        self.stage.step()

    def odometry(self, x: float = 0.0, yaw: float = 0.0, vx: float = 0.0, variance: float = 1e-4, **ids: str) -> None:
        """Publish odometry at the present, and step."""
        message = Odometry(child_frame_id=ids.get("child", "base_link"))
        message.header.stamp, message.header.frame_id = self.stage.stamp, ids.get("frame", "odom")
        message.pose.pose, message.twist.twist.linear.x = pose_message([x, 0.0, yaw]), vx
        message.pose.covariance = message.twist.covariance = (variance * np.eye(6)).ravel()
        self.publishers["odom"].publish(message)
        self.stage.step()

    def imu(self, yaw: float = 0.0, frame: str = "base_link", **acceleration: float) -> None:
        message = Imu(orientation=quaternion_message(yaw))
        message.header.stamp, message.header.frame_id = self.stage.stamp, frame
        for axis, value in acceleration.items():
            setattr(message.linear_acceleration, axis, value)
        small = (1e-6 * np.eye(3)).ravel()
        message.orientation_covariance = message.angular_velocity_covariance = small
        message.linear_acceleration_covariance = small
        self.publishers["imu"].publish(message)
        self.stage.step()

    def warnings(self, word: str) -> list[str]:
        return [one.msg for one in self.log if word in one.msg]

    @property
    def position(self) -> Any:
        return self.states[-1].pose.pose.position


@pytest.mark.parametrize("kind", [EkfNode, UkfNode])
def test_a_velocity_becomes_a_way_and_a_transform(stage: Set, kind: type[Any]) -> None:
    bench = Bench(stage, kind, odom0="odom", odom0_config=uses("vx", "vy", "vyaw"))
    for _ in range(20):
        bench.odometry(vx=1.0)
    state = bench.states[-1]
    assert (state.header.frame_id, state.child_frame_id) == ("odom", "base_link")
    assert 0.8 < state.pose.pose.position.x < 1.1
    assert state.twist.twist.linear.x == pytest.approx(1.0, abs=0.01)
    found = [one for message in bench.transforms for one in message.transforms]
    assert found[-1].header.stamp == state.header.stamp
    assert found[-1].transform.translation.x == state.pose.pose.position.x
    bench.stage.step_until(lambda: bench.position.x > 1.2)  # predicted while nothing comes


def test_a_differential_pose_is_a_velocity_and_a_relative_one_starts_at_zero(stage: Set) -> None:
    bench = Bench(
        stage,
        odom0="odom", odom0_config=uses("x", "y", "yaw"), odom0_differential=True,
        imu0="imu", imu0_config=uses("yaw"), imu0_relative=True,
    )  # fmt: skip
    for i in range(20):
        bench.imu(yaw=0.7)
        bench.odometry(x=50.0 + 0.1 * i)  # 0.1 m in two steps
    assert bench.states[-1].twist.twist.linear.x == pytest.approx(1.0, abs=0.05)
    assert 0.5 < bench.position.x < 2.5
    assert abs(bench.states[-1].pose.pose.orientation.z) < 1e-3


def test_gravity_is_taken_from_a_sensor_on_its_side(stage: Set) -> None:
    bench = Bench(
        stage, two_d_mode=False, publish_acceleration=True,
        imu0="imu", imu0_config=uses("ax", "ay", "az"), imu0_remove_gravitational_acceleration=True,
    )  # fmt: skip
    mount = TransformStamped(child_frame_id="side")
    mount.header.frame_id = "base_link"
    mount.transform.rotation.x = mount.transform.rotation.w = math.sqrt(0.5)  # its y axis points up
    bench.stage.publish("/tf_static", TFMessage(transforms=[mount]), LATCHED)
    bench.stage.step()
    message = Imu()
    message.header.frame_id, message.header.stamp = "side", bench.stage.stamp
    message.orientation_covariance[0] = -1.0
    message.linear_acceleration.y, message.linear_acceleration.x = 9.80665, 0.5
    bench.publishers["imu"].publish(message)
    bench.stage.step_until(lambda: bool(bench.states))
    np.testing.assert_allclose(bench.node._filter.state[12:], [0.5, 0.0, 0.0], atol=1e-6)


@pytest.mark.parametrize(("smooth", "expected"), [(True, 0.0), (False, 0.5)])
def test_a_late_measurement_is_taken_in_at_its_time(stage: Set, smooth: bool, expected: float) -> None:
    """A robot at 1 m/s is seen at its start by a slow sensor; taken for the present, that holds it back."""
    bench = Bench(
        stage, odom0="odom", odom0_config=uses("vx"), pose0="pose", pose0_config=uses("x"),
        smooth_lagged_data=smooth, history_length=5.0,
        initial_estimate_covariance=[1.0] * 15,
    )  # fmt: skip
    start = bench.stage.stamp
    for _ in range(21):
        bench.odometry(vx=1.0)
    way = bench.position.x
    late = PoseWithCovarianceStamped()
    late.header.stamp, late.header.frame_id = start, "odom"
    late.pose.covariance = (1e-6 * np.eye(6)).ravel()
    bench.poses.publish(late)
    bench.stage.step()
    bench.odometry(vx=1.0)
    bench.odometry(vx=1.0)
    assert way > 0.9
    held_back = way - bench.position.x
    assert (held_back > expected) if expected else (held_back < 0.2)


def test_measurements_that_cannot_be_used_are_named(stage: Set) -> None:
    bench = Bench(stage, odom0="odom", odom0_config=uses("x", "vx"), odom0_pose_rejection_threshold=3.0)
    for _ in range(3):
        bench.odometry(frame="elsewhere")
    bench.odometry(variance=math.nan)
    bench.odometry(variance=-1.0)
    bench.odometry(x=math.nan)
    assert not bench.states
    ahead = Odometry()
    ahead.header.frame_id, ahead.header.stamp.sec = "odom", bench.stage.stamp.sec + 1000
    bench.publishers["odom"].publish(ahead)
    bench.odometry(x=1.0)
    bench.odometry(x=500.0)
    bench.stage.step_until(lambda: bool(bench.warnings("beyond its rejection threshold")))
    assert bench.position.x == pytest.approx(1.0, abs=0.1)
    assert len(bench.warnings("elsewhere")) == 1
    assert bench.warnings("covariance is not finite")
    assert bench.warnings("pose is not finite")
    assert len(bench.warnings("ahead of the clock")) == 1


def test_a_pose_is_set_and_processing_is_toggled(stage: Set) -> None:
    bench = Bench(stage, disabled_at_startup=True, odom0="odom", odom0_config=uses("vx"))
    bench.odometry(vx=1.0)
    assert not bench.states
    bench.stage.call(Empty, "enable")
    message = PoseWithCovarianceStamped()
    message.header.stamp, message.header.frame_id = bench.stage.stamp, "odom"
    message.pose.pose = pose_message([7.0, 2.0, 0.0])
    bench.stage.call(SetPose, "set_pose", pose=message)
    bench.stage.step_until(lambda: bool(bench.states) and abs(bench.position.x - 7.0) < 0.01)
    assert bench.stage.call(ToggleFilterProcessing, "toggle", on=False).status
    assert not bench.stage.call(ToggleFilterProcessing, "toggle", on=False).status
    del bench.states[:]
    bench.odometry(vx=1.0)
    assert not bench.states


def test_time_that_goes_back_starts_the_filter_again(stage: Set) -> None:
    bench = Bench(stage, odom0="odom", odom0_config=uses("x"))
    bench.odometry(x=3.0)
    bench.stage.step_until(lambda: bool(bench.states))
    bench.stage.step(-50.0)
    bench.stage.step_until(lambda: bool(bench.warnings("time went back")))
    del bench.states[:]
    bench.odometry(x=-4.0)
    bench.stage.step_until(lambda: bool(bench.states))
    assert bench.position.x == pytest.approx(-4.0, abs=0.1)


def test_in_the_map_the_transform_is_that_of_the_odometry(stage: Set) -> None:
    bench = Bench(stage, world_frame="map", odom0="odom", odom0_config=uses("x", "y", "yaw"))
    below = TransformStamped(child_frame_id="base_link")
    below.header.frame_id, below.transform.translation.x = "odom", 1.0
    bench.stage.publish("/tf_static", TFMessage(transforms=[below]), LATCHED)
    bench.stage.step()
    bench.odometry(x=5.0, frame="map")
    bench.stage.step_until(lambda: bool(bench.transforms))
    found = bench.transforms[-1].transforms[0]
    assert (found.header.frame_id, found.child_frame_id) == ("map", "odom")
    assert found.transform.translation.x == pytest.approx(4.0, abs=1e-6)


def test_a_command_moves_the_prediction_until_it_is_old(stage: Set) -> None:
    bench = Bench(
        stage, use_control=True, control_config=[True] + [False] * 5, control_timeout=0.5,
        odom0="odom", odom0_config=uses("x"),
    )  # fmt: skip
    bench.odometry(x=0.0)
    bench.stage.publish("cmd_vel", Twist())
    command = Twist()
    command.linear.x = 1.0
    bench.stage.publish("cmd_vel", command)
    bench.stage.step_until(lambda: bool(bench.states) and bench.states[-1].twist.twist.linear.x > 0.2)
    bench.stage.step_until(lambda: bench.states[-1].twist.twist.linear.x < 0.1)


@pytest.mark.parametrize(
    ("parameters", "error", "text"),
    [
        ({}, ParameterError, "needs at least one odomN"),
        ({"odom0": "odom", "odom0_config": [True] * 3}, ParameterError, "must have 15 booleans, got 3"),
        ({"odom0": "odom", "world_frame": "base_link"}, ParameterError, "world_frame.* must be map_frame"),
        ({"odom0": "odom", "process_noise_covariance": [0.1] * 4}, LocalizationError, "15 variances or 225"),
    ],
)
def test_parameters_that_do_not_fit_are_refused(stage: Set, parameters: Any, error: type[Exception], text: str) -> None:
    with pytest.raises(error, match=text):
        Bench(stage, **parameters)


@pytest.mark.parametrize("world", ["odom", "map"])
def test_the_filters_of_the_example_with_satellites_start(stage: Set, world: str) -> None:
    share, name = BUILT_IN / "robot_localization", f"ekf_filter_node_{world}"
    sections = yaml.safe_load((share / "params" / "dual_ekf_navsat_example.yaml").read_text())
    bench = Bench(stage, **sections[name]["ros__parameters"])
    assert bench.node.get_parameter("world_frame").value == world
    assert f'"{name}"' in (share / "launch" / "dual_ekf_navsat_example.launch.py").read_text()
