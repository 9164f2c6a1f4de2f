"""A simulated controller that is guided: what moves its robot, what does not count, and what stops it."""

import math

import numpy as np
import pytest

from daidalos.common.pose3 import Pose
from daidalos.industry.egm.controller import CYCLE, EgmSettings, GuidedController
from daidalos.industry.egm.messages import (
    EgmCartesian,
    EgmEuler,
    EgmHeader,
    EgmJoints,
    EgmPlanned,
    EgmPose,
    EgmQuaternion,
    EgmRobot,
    EgmSensor,
    Mci,
    MessageType,
    Rapid,
)
from daidalos.industry.egm.wire import decode, encode
from daidalos.industry.motion.kinematics import forward
from daidalos.industry.motion.redundant_kinematics import forward_of
from daidalos.industry.robots import ARMS
from daidalos.industry.robots.yumi import HOME_DEG, YUMI_ARM

ARM = ARMS["irb120"]


def guidance(number, planned):
    return encode(EgmSensor(EgmHeader(number, 0, MessageType.CORRECTION), planned))


def joints(number, *degrees):
    return guidance(number, EgmPlanned(joints=EgmJoints(degrees)))


def test_the_robot_follows_the_joints_by_its_speeds():
    controller = GuidedController(ARM)
    assert controller.take(joints(1, 50, 0, 0, 0, 30, 0)) == ""
    controller.step()
    np.testing.assert_allclose(np.degrees(controller.joints), [250 * CYCLE, 0, 0, 0, 30, 0], atol=1e-9)
    for number in range(2, 60):
        assert controller.take(joints(number, 50, 0, 0, 0, 30, 0)) == ""
        controller.step()
    np.testing.assert_allclose(np.degrees(controller.joints), [50, 0, 0, 0, 30, 0], atol=1e-9)
    state = decode(EgmRobot, controller.message())
    assert (state.header.mtype, state.mciState.state, state.mciConvergenceMet) == (MessageType.DATA, Mci.RUNNING, True)
    np.testing.assert_allclose(state.feedBack.joints.joints, [50, 0, 0, 0, 30, 0], atol=1e-9)
    position = state.feedBack.cartesian.pos
    np.testing.assert_allclose(
        [position.x, position.y, position.z], 1e3 * forward(ARM, controller.joints)[:3, 3], atol=1e-9
    )


@pytest.mark.parametrize("form", ["quaternion", "euler"])
def test_the_robot_follows_a_pose(form):
    goal = np.radians([20, 10, -10, 15, 40, -20])
    pose = Pose.from_matrix(forward(ARM, goal))
    x, y, z, w = pose.orientation
    place = EgmCartesian(*(1e3 * one for one in pose.position))
    if form == "quaternion":
        asked = EgmPose(place, EgmQuaternion(w, x, y, z))
    else:
        m = forward(ARM, goal)[:3, :3]
        roll, pitch = math.atan2(m[2, 1], m[2, 2]), -math.asin(m[2, 0])
        asked = EgmPose(place, None, EgmEuler(*map(math.degrees, (roll, pitch, math.atan2(m[1, 0], m[0, 0])))))
    controller = GuidedController(ARM, settings=EgmSettings("pose"))
    for number in range(1, 60):
        assert controller.take(guidance(number, EgmPlanned(cartesian=asked))) == ""
        controller.step()
    np.testing.assert_allclose(controller.joints, goal, atol=1e-9)


@pytest.mark.parametrize(
    ("data", "reason"),
    [
        (joints(1, *[math.nan] * 6), "the joints are not finite"),
        (joints(1, 0, 0, 0, 0, math.inf, 0), "the joints are not finite"),
        (joints(1, 0, 0), "2 joints are given, but the robot has 6"),
        (joints(0, 1, 0, 0, 0, 30, 0), "seqno is 0 after 0"),
        (guidance(1, EgmPlanned(cartesian=EgmPose(EgmCartesian(1, 2, 3)))), "joints are guided, but it has none"),
        (encode(EgmSensor()), "the header has no seqno"),
        (b"\x0a\x05", "a field of 5 bytes is cut off after 0"),
    ],
    ids=["nan", "infinite", "too few", "repeated", "a pose", "no number", "cut off"],
)
def test_what_does_not_count_leaves_the_robot_where_it_is(data, reason):
    controller = GuidedController(ARM)
    assert controller.take(joints(0, 0, 0, 0, 0, 30, 0)) == ""
    assert controller.take(data) == reason
    controller.step()
    np.testing.assert_allclose(np.degrees(controller.joints), [0, 0, 0, 0, 30, 0], atol=1e-12)
    assert (controller.refused, controller.last_refusal, controller.stopped) == (1, reason, "")


def test_a_late_message_does_not_move_the_robot_back():
    controller = GuidedController(ARM)
    assert controller.take(joints(5, 2, 0, 0, 0, 30, 0)) == ""
    assert controller.take(joints(4, -2, 0, 0, 0, 30, 0)) == "seqno is 4 after 5"
    for _ in range(10):
        controller.step()
    np.testing.assert_allclose(np.degrees(controller.joints[0]), 2.0, atol=1e-9)


@pytest.mark.parametrize(
    ("settings", "data", "reason"),
    [
        (EgmSettings(), joints(1, 0, 0, 0, 0, 130, 0), "joint out of range"),
        (
            EgmSettings("pose"),
            guidance(1, EgmPlanned(cartesian=EgmPose(EgmCartesian(2000, 0, 0), EgmQuaternion(1, 0, 0, 0)))),
            "reach",
        ),
    ],
    ids=["range", "reach"],
)
def test_what_the_robot_cannot_do_stops_it(settings, data, reason):
    controller = GuidedController(ARM, settings=settings)
    controller.take(data)
    assert reason in controller.stopped
    before = controller.joints.copy()
    controller.step()
    np.testing.assert_array_equal(controller.joints, before)
    assert controller.take(joints(2, 0, 0, 0, 0, 31, 0)).startswith("guided motion has ended")
    state = decode(EgmRobot, controller.message())
    assert (state.mciState.state, state.rapidExecState.state) == (Mci.STOPPED, Rapid.STOPPED)


def test_guidance_that_stays_away_stops_the_robot_on_its_way():
    controller = GuidedController(ARM, settings=EgmSettings(communication_timeout=0.02, max_speed_deviation=10.0))
    controller.take(joints(1, 50, 0, 0, 0, 30, 0))
    for _ in range(20):
        controller.step()
    assert controller.stopped == "no guidance for 0.02 s"
    assert 0.1 < np.degrees(controller.joints[0]) < 0.3


def test_a_controller_waits_for_the_first_guidance_where_it_is_told_to():
    controller = GuidedController(ARM, settings=EgmSettings(communication_timeout=0.02, waits=True))
    for _ in range(100):
        controller.step()
    assert controller.stopped == ""
    controller.take(joints(1, 0, 0, 0, 0, 30, 0))
    for _ in range(7):
        controller.step()
    assert controller.stopped == "no guidance for 0.02 s"


def test_the_seventh_axis_of_yumi_is_an_external_one():
    controller = GuidedController(YUMI_ARM)
    goal = [5, -125, 32, 4, 42, -3, 130]
    for number in range(1, 60):
        asked = EgmPlanned(joints=EgmJoints(tuple(goal[:6])), externalJoints=EgmJoints((goal[6],)))
        assert controller.take(guidance(number, asked)) == ""
        controller.step()
    state = decode(EgmRobot, controller.message()).feedBack
    np.testing.assert_allclose([*state.joints.joints, *state.externalJoints.joints], goal, atol=1e-9)
    from_base = np.radians([goal[k] for k in (0, 1, 6, 2, 3, 4, 5)])
    position = (state.cartesian.pos.x, state.cartesian.pos.y, state.cartesian.pos.z)
    np.testing.assert_allclose(position, 1e3 * forward_of(YUMI_ARM, from_base)[0][:3, 3], atol=1e-9)
    assert controller.take(joints(100, *goal[:6])) == "6 joints are given, but the robot has 7"


def test_yumi_follows_a_pose_with_its_arm_angle():
    controller = GuidedController(YUMI_ARM, settings=EgmSettings("pose"))
    order = YUMI_ARM.controller_order
    pose, arm_angle = forward_of(YUMI_ARM, np.radians(HOME_DEG["left"]))
    pose[0, 3] += 0.03
    x, y, z, w = Pose.from_matrix(pose).orientation
    asked = EgmPose(EgmCartesian(*(1e3 * pose[:3, 3])), EgmQuaternion(w, x, y, z))
    for number in range(1, 60):
        assert controller.take(guidance(number, EgmPlanned(cartesian=asked))) == ""
        controller.step()
    angles = np.empty(7)
    angles[order] = controller.joints
    found, found_angle = forward_of(YUMI_ARM, angles)
    np.testing.assert_allclose(found, pose, atol=1e-8)
    assert found_angle == pytest.approx(float(arm_angle), abs=1e-8)
