"""The program's side of KUKA RSI over UDP, against the simulated controller and against bad partners."""

import socket
from collections.abc import Iterator

import numpy as np
import pytest

from daidalos.common.errors import UserError
from daidalos.industry.rsi.client import ConnectionLost, RsiClient
from daidalos.industry.rsi.controller import SimulatedController
from daidalos.industry.rsi.controller_server import ControllerServer
from daidalos.industry.rsi.telegrams import Telegram, decode, encode

from .test_controller import CONFIGURATION, controller

WAIT = 5.0


@pytest.fixture
def client() -> Iterator[RsiClient]:
    with RsiClient(port=0) as one:
        yield one


@pytest.fixture
def robot(client: RsiClient) -> Iterator[socket.socket]:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as one:
        one.connect(("127.0.0.1", client.port))
        one.settimeout(WAIT)
        yield one


def telegram(ipoc: int, delay: int = 0) -> bytes:
    return encode(Telegram("Rob", "KUKA", ipoc, {"RIst": {"Y": 1.0}, "Delay": {"D": delay}}))


def correct(_: Telegram) -> dict[str, dict[str, float]]:
    return {"RKorr": {"Y": 0.1}}


def test_a_loop_over_udp_loses_nothing(client: RsiClient) -> None:
    with ControllerServer(controller(), "127.0.0.1", client.port) as server:
        for _ in range(20):
            server.send()
            client.answer(correct, WAIT)
            server.receive(WAIT)
    assert server.controller.total_lost == 0
    assert server.controller.correction[1] == pytest.approx(2.0)
    assert client.statistics.answered == 20


def test_a_repeated_telegram_is_answered_but_not_computed_again(client: RsiClient, robot: socket.socket) -> None:
    calls = []
    robot.send(telegram(12))
    client.answer(lambda one: calls.append(one.ipoc) or {"RKorr": {"Y": 0.1}}, WAIT)  # type: ignore[func-returns-value]
    first = robot.recv(9000)
    robot.send(telegram(12))
    with pytest.raises(ConnectionLost):
        client.answer(correct, 0.05)
    assert robot.recv(9000) == first
    assert calls == [12]
    assert client.statistics.repeated == 1


def test_only_the_newest_of_waiting_telegrams_is_answered(client: RsiClient, robot: socket.socket) -> None:
    for ipoc in (12, 24, 36):
        robot.send(telegram(ipoc, delay=2))
    assert client.answer(correct, WAIT).ipoc == 36
    assert decode(robot.recv(9000), "Sen").ipoc == 36
    assert (client.statistics.late, client.statistics.delays) == (2, 2)


def test_old_telegrams_are_not_answered_and_gaps_are_counted(client: RsiClient, robot: socket.socket) -> None:
    for ipoc in (12, 24, 60):
        robot.send(telegram(ipoc))
        client.answer(correct, WAIT)
    robot.send(telegram(48))
    with pytest.raises(ConnectionLost, match="no telegram of a robot came within"):
        client.answer(correct, 0.05)
    assert (client.statistics.missed, client.statistics.late) == (2, 1)


@pytest.mark.parametrize("ipoc", [10_000_000, 5])
def test_a_jump_of_the_ipoc_ends_the_connection(client: RsiClient, robot: socket.socket, ipoc: int) -> None:
    robot.send(telegram(1_000_000))
    client.answer(correct, WAIT)
    robot.send(telegram(ipoc))
    with pytest.raises(ConnectionLost, match="IPOC jumped from 1000000 to"):
        client.answer(correct, WAIT)


def test_what_is_no_telegram_is_not_answered(client: RsiClient, robot: socket.socket) -> None:
    robot.send(b"<Rob")
    robot.send(encode(Telegram("Rob", "KUKA", 1, {"RIst": {"Y": 1.0}})).replace(b"1.0", b"nan"))
    robot.send(telegram(12))
    client.answer(correct, WAIT)
    assert decode(robot.recv(9000), "Sen").ipoc == 12
    assert client.statistics.refused == 2


def test_another_sender_is_not_obeyed(robot: socket.socket) -> None:
    with RsiClient(port=0, robot="127.0.0.9") as guarded:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
            other.sendto(telegram(12), ("127.0.0.1", guarded.port))
            with pytest.raises(ConnectionLost):
                guarded.answer(correct, 0.05)
        assert guarded.statistics.refused == 1


@pytest.mark.parametrize("value", [float("nan"), 1.0 / 3.0])
def test_a_handler_that_fails_corrects_nothing(client: RsiClient, robot: socket.socket, value: float) -> None:
    def fail(_: Telegram) -> dict[str, dict[str, float]]:
        if value == value:
            raise RuntimeError("broken")
        return {"RKorr": {"Y": value}}

    robot.send(telegram(12))
    with pytest.raises((RuntimeError, ValueError)):
        client.answer(fail, WAIT)
    answered = decode(robot.recv(9000), "Sen")
    assert (answered.ipoc, dict(answered.groups)) == (12, {})


def test_a_used_port_is_named(client: RsiClient) -> None:
    with pytest.raises(UserError, match=rf"127.0.0.1:{client.port} cannot be listened on"):
        RsiClient(port=client.port)


@pytest.mark.slow
def test_a_robot_that_nobody_answers_stops_in_real_time() -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as nobody:
        nobody.bind(("127.0.0.1", 0))
        silent = SimulatedController(CONFIGURATION, lambda _: np.zeros(6))
        with ControllerServer(silent, "127.0.0.1", nobody.getsockname()[1]) as server:
            with pytest.raises(UserError, match=r"nobody answered within 0.05 s"):
                server.wait_for_partner(0.05)
            assert silent.total_lost == 0
            server.run(60.0)
    assert silent.stopped == "10 answers in a row were lost"
