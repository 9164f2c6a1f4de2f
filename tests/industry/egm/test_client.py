"""The guiding side over the loopback: the newest state counts, and what is late, repeated or damaged does not."""

import math
import socket

import numpy as np
import pytest

from daidalos.common.errors import UserError
from daidalos.common.pose3 import Pose
from daidalos.industry.egm.client import ControllerLost, EgmClient
from daidalos.industry.egm.controller import EgmSettings, GuidedController
from daidalos.industry.egm.controller_server import EgmControllerServer
from daidalos.industry.egm.messages import EgmFeedBack, EgmHeader, EgmJoints, EgmRobot, EgmState, Mci, Motors
from daidalos.industry.egm.wire import encode
from daidalos.industry.motion.kinematics import forward
from daidalos.industry.robots import ARMS

ARM = ARMS["irb120"]


@pytest.fixture
def client():
    with EgmClient(port=0) as found:
        yield found


@pytest.fixture
def sender(client):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as found:
        found.connect(("127.0.0.1", client.port))
        yield found


def state(number, angle=1.0, mci=Mci.RUNNING, motors=Motors.ON):
    feedback = EgmFeedBack(joints=EgmJoints((angle,) * 6))
    return encode(EgmRobot(EgmHeader(number, 0, 2), feedback, None, EgmState(motors), EgmState(mci)))


def test_a_robot_is_guided_along_joints(client):
    controller = GuidedController(ARM)
    with EgmControllerServer(controller, "127.0.0.1", client.port) as server:
        for number in range(100):
            server.cycle()
            found = client.wait(1.0)
            assert found.is_guided
            client.send_joints(np.radians([0.2 * number, 0, 0, 0, 30, 0]))
        server.cycle()
    np.testing.assert_allclose(np.degrees(controller.joints[0]), 0.2 * 99, atol=1e-9)
    assert controller.refused == 0
    assert (client.statistics.taken, client.statistics.missed, client.statistics.refused) == (100, 0, 0)


def test_a_robot_is_guided_to_a_pose(client):
    controller = GuidedController(ARM, settings=EgmSettings("pose"))
    goal = forward(ARM, np.radians([10, 5, -5, 0, 40, 0]))
    with EgmControllerServer(controller, "127.0.0.1", client.port) as server:
        for _ in range(40):
            server.cycle()
            client.wait(1.0)
            client.send_pose(Pose.from_matrix(goal))
        server.cycle()
        found = client.wait(1.0)
    np.testing.assert_allclose(forward(ARM, controller.joints), goal, atol=1e-9)
    np.testing.assert_allclose(found.pose.matrix, goal, atol=1e-9)


def test_only_newer_messages_count(client, sender):
    sender.send(state(5, 1.0))
    assert client.wait(1.0).number == 5
    for number in (5, 4, 3):
        sender.send(state(number, 9.0))
    assert client.receive(0.02) is None
    sender.send(state(8, 2.0))
    found = client.wait(1.0)
    np.testing.assert_allclose(np.degrees(found.joints), 2.0)
    counts = client.statistics
    assert (counts.taken, counts.repeated, counts.late, counts.missed) == (2, 1, 2, 2)


def test_the_newest_of_several_messages_counts(client, sender):
    for number in range(4):
        sender.send(state(number, number))
    assert client.wait(1.0).number == 3


def test_a_controller_that_begins_anew_is_followed(client, sender):
    sender.send(state(5000))
    assert client.wait(1.0).number == 5000
    for number in range(12):
        sender.send(state(number))
    assert client.wait(1.0).number == 11


@pytest.mark.parametrize(
    ("data", "reason"),
    [
        (b"no message", "cut off|kind"),
        (state(1, math.nan), "not finite"),
        (encode(EgmRobot(EgmHeader(1))), "no seqno or no joints"),
        (encode(EgmRobot(None, EgmFeedBack(EgmJoints((1.0,))))), "no seqno or no joints"),
    ],
    ids=["text", "nan", "no joints", "no number"],
)
def test_what_is_no_state_is_refused_and_said(client, sender, data, reason):
    sender.send(data)
    with pytest.raises(ControllerLost, match=f"no message of a controller came within 0.05 s.*({reason})"):
        client.wait(0.05)
    assert client.statistics.refused == 1


@pytest.mark.parametrize(
    ("mci", "motors", "is_guided"),
    [(Mci.RUNNING, Motors.ON, True), (Mci.STOPPED, Motors.ON, False), (Mci.RUNNING, Motors.OFF, False)],
)
def test_a_state_says_whether_guidance_moves_the_robot(client, sender, mci, motors, is_guided):
    sender.send(state(1, 1.0, mci, motors))
    assert client.wait(1.0).is_guided is is_guided


def test_another_sender_is_refused():
    other = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    with EgmClient(port=0, controller="127.0.0.9") as client, other:
        other.sendto(state(1), ("127.0.0.1", client.port))
        with pytest.raises(ControllerLost, match=r"it came from 127\.0\.0\.1"):
            client.wait(0.05)


def test_guidance_that_is_not_finite_is_not_sent(client, sender):
    sender.send(state(1))
    client.wait(1.0)
    with pytest.raises(ValueError, match="not finite is not sent"):
        client.send_joints(np.full(6, np.nan))
    sender.setblocking(False)
    with pytest.raises(BlockingIOError):
        sender.recv(100)


def test_a_port_that_is_taken_is_one_line(client):
    with pytest.raises(UserError, match=f"127.0.0.1:{client.port} cannot be listened on: Address already in use"):
        EgmClient(port=client.port)
