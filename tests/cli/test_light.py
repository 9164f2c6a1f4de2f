"""`daidalos light`: what reaches a receiver, and what is wrong with what was typed."""

import math
import re
import signal
import socket
import subprocess
import sys

import pytest

from daidalos.cli.daidalos import main
from daidalos.industry.lighting import artnet


@pytest.fixture
def receiver():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as one:
        one.bind(("127.0.0.1", 0))
        one.settimeout(20.0)
        yield one


@pytest.fixture
def config(tmp_path, receiver):
    path = tmp_path / "lights.yaml"
    path.write_text(
        "heads: [{name: spot, address: 10, movement: direct}]\n"
        f"outputs: [{{protocol: artnet, port: {receiver.getsockname()[1]}}}]\n"
    )
    return str(path)


def test_point_sends_until_its_end_and_then_a_blackout(config, receiver, capsys):
    assert (
        main(["light", "point", "0.5", "-0.3", "0.8", "--config", config, "--duration", "0.1", "--color", "red"]) == 0
    )
    assert capsys.readouterr().out == ("spot: pan 30.964 deg, tilt -16.254 deg, universe 1, channels 10 to 22\n")
    first = artnet.parse_dmx(receiver.recv(2048))
    pan, tilt = int.from_bytes(first.data[9:11], "big"), int.from_bytes(first.data[11:13], "big")
    assert pan == round((30.9638 + 270) / 540 * 65535)
    assert tilt == round((-16.2537 + 135) / 270 * 65535)
    assert first.data[14] == 255
    assert 10 <= first.data[16] <= 14
    last = first
    while last.data[14]:
        last = artnet.parse_dmx(receiver.recv(2048))
    assert last.data[9:13] == first.data[9:13]


@pytest.mark.slow
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such signals")
def test_signals_end_with_a_blackout(config, receiver, number):
    command = [sys.executable, "-m", "daidalos.cli.daidalos", "light", "point", "0.5", "0", "0.8", "--config", config]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        found = artnet.parse_dmx(receiver.recv(2048))
        assert found.data[14] == 255
        process.send_signal(number)
        try:
            while found.data[14]:
                found = artnet.parse_dmx(receiver.recv(2048))
            assert process.wait(20) == 0
        finally:
            process.kill()


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (["point", "0", "0", "9"], "the point [0, 0, 9] is out of range"),
        (["point", "nan", "0", "0"], "the point [nan, 0, 0] is not finite"),
        (["point", "0", "0", "0", "--head", "spott"], "there is no head 'spott'"),
        (["point", "0", "0", "0", "--color", "mauve"], "'mauve' is no color"),
        (["point", "0", "0", "0", "--config", "none.yaml"], "none.yaml: No such file"),
        (["fixture", "none.yaml"], "none.yaml: No such file"),
    ],
)
def test_a_fault_is_one_line(capsys, words, expected):
    assert main(["light", *words]) == 2
    said = capsys.readouterr().err
    assert said.startswith(f"daidalos light {words[0]}: {expected}") or expected in said
    assert said.count("\n") == 1


def test_the_channels_of_a_fixture(capsys):
    assert main(["light", "fixture", "zema_13_channel"]) == 0
    said = capsys.readouterr().out
    assert "1, 2  Pan" in said
    assert "90 to 94     color: Magenta" in said


class Keys:
    """Keyboard that someone presses who knows in advance what to press."""

    def __init__(self, keys):
        self.keys = iter(keys)

    def __call__(self):
        return self

    def __enter__(self):
        return self

    def __exit__(self, *error):
        pass

    def read(self):
        return next(self.keys, None)


def test_a_calibration_is_left_and_resumed(config, tmp_path, capsys, monkeypatch):
    output = tmp_path / "found.yaml"
    words = ["light", "calibrate", "--config", config, "-o", str(output)]
    # The head is where the configuration says, so that every direction is right at once.
    monkeypatch.setattr("daidalos.nodes.keyboard.Keyboard", Keys(["\n", "right", "left", "\n", "u", "\n", "\n", "q"]))
    assert main(words) == 1
    said = capsys.readouterr().out
    assert "1 of 8: put the spot on [-1, -0.75, 0], straight" in said
    assert "the same command resumes it" in said
    assert not output.exists()
    monkeypatch.setattr("daidalos.nodes.keyboard.Keyboard", Keys(["\n"] * 5 + ["p", "\n", "\n"]))
    assert main(words) == 0
    said = capsys.readouterr().out
    assert "3 directions are confirmed" in said
    assert "8 of 8: put the spot on [1, 0.75, 0], flipped" in said
    assert "9 of 9: put the spot on" in said
    assert "expected pointing error over the table" in said
    assert "position 0.0000 +- " in said
    assert output.exists()
    assert not output.with_name("found.yaml.session").exists()

    calibrated = tmp_path / "calibrated.yaml"
    calibrated.write_text("heads: [{name: spot, position: [9, 9, 9], calibration: found.yaml}]\noutputs: []\n")
    assert main(["light", "point", "0.5", "-0.3", "0.8", "--config", str(calibrated), "--duration", "0.01"]) == 0
    assert capsys.readouterr().out.startswith("spot: pan 30.96")


def test_the_law_of_sines_is_printed_for_points_of_a_line(config, tmp_path, capsys, monkeypatch):
    points = tmp_path / "points.yaml"
    points.write_text("[[-1, -0.75, 0], [0, -0.75, 0], [1, -0.75, 0], [0.3, 0.75, 0]]\n")
    output = tmp_path / "found.yaml"
    monkeypatch.setattr("daidalos.nodes.keyboard.Keyboard", Keys(["\n"] * 9))
    assert main(["light", "calibrate", "--config", config, "--points", str(points), "-o", str(output)]) == 0
    said = capsys.readouterr().out
    reach = math.dist((1.0, -0.75, 0.0), (0.0, 0.0, 2.8))
    assert re.search(rf"law of sines: position -?0.0000  -?0.0000  2.8000 m; .* {reach:.4f} \+- 0.00\d+ m", said)


def test_a_calibration_needs_a_terminal(config, capsys):
    assert main(["light", "calibrate", "--config", config]) == 2
    assert "is not a terminal" in capsys.readouterr().err
