"""Options of lock-step runs on command lines."""

from argparse import ArgumentParser

import pytest

from daidalos.cli.ros2.program import run
from daidalos.lockstep import options
from daidalos.lockstep.options import Options


def test_the_options_are_read_as_they_are_written() -> None:
    parser = ArgumentParser()
    options.add_options(parser)
    for written in (Options(), Options(7, 1.5, "a folder", "^/camera/|/tf$"), Options(until_s=1e-9)):
        assert Options.of(parser.parse_args(written.words())) == written


@pytest.mark.parametrize("text", ["0", "-1", "inf", "nan", "soon"])
def test_the_end_of_a_run_is_a_time_to_come(text: str, capsys: pytest.CaptureFixture[str]) -> None:
    parser = ArgumentParser()
    options.add_options(parser)
    with pytest.raises(SystemExit):
        parser.parse_args(["--until", text])
    assert "--until" in capsys.readouterr().err


def test_what_is_not_of_the_run_is_kept() -> None:
    words = ["launch", "--launch-prefix", "nice -n 5", "--lock", "-a", "--seed=3", "p", "f", "seed:=1", "--bag", "b"]
    assert options.without_options(words) == ["launch", "--launch-prefix", "nice -n 5", "-a", "p", "f", "seed:=1"]


def test_options_without_lockstep_are_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["launch", "--until", "3", "--seed", "0", "turtlesim", "multisim.launch.py"]) == 1
    assert capsys.readouterr().err == "--seed and --until only act together with --lockstep\n"
