"""`daidalos arm egm`: a simulated controller, and what a controller sends."""

import threading

import pytest

from daidalos.cli.daidalos import main
from daidalos.industry.egm.client import EgmClient
from daidalos.industry.egm.controller import GuidedController
from daidalos.industry.egm.controller_server import EgmControllerServer
from daidalos.industry.robots import ARMS


def test_a_controller_without_guidance_stops(capsys):
    with EgmClient(port=0) as client:
        status = main(["arm", "egm", "serve", "irb120", "--port", str(client.port), "--timeout", "0.02"])
    printed = capsys.readouterr()
    assert status != 0
    assert "[0.000, 0.000, 0.000, 0.000, 30.000, 0.000] deg, 0 messages refused" in printed.out
    assert printed.err == "daidalos arm: the robot has stopped: no guidance for 0.02 s\n"


def test_what_a_controller_sends_is_shown(capsys):
    with EgmClient(port=0) as free:
        port = free.port
    with EgmControllerServer(GuidedController(ARMS["irb120"]), "127.0.0.1", port) as server:
        sender = threading.Thread(target=server.run, args=(0.6,))
        sender.start()
        assert main(["arm", "egm", "watch", "--port", str(port), "--time", "0.2"]) == 0
        sender.join()
    lines = capsys.readouterr().out.splitlines()
    assert lines[1].endswith(": [0.000, 0.000, 0.000, 0.000, 30.000, 0.000] deg, guided")
    assert lines[-1].endswith("0 late, 0 refused")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["serve", "irb12"], "there is no arm 'irb12'; did you mean 'irb120'"),
        (["serve", "irb120", "--timeout", "0"], "'0' is not greater than 0"),
        (["watch", "--listen", "192.0.2.1"], "192.0.2.1:6510 cannot be listened on"),
        (["watch", "--port", "99999"], "99999 cannot be listened on"),
    ],
)
def test_what_is_wrong_is_one_line(arguments, message, capsys):
    try:
        status = main(["arm", "egm", *arguments])
    except SystemExit as end:
        status = end.code
    assert status != 0
    assert message in capsys.readouterr().err
