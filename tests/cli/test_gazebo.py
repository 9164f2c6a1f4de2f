"""The commands of Gazebo."""

import pytest

from daidalos.cli import gazebo as commands
from daidalos.nodes.gazebo_ros._command_line import parse


@pytest.fixture
def started(monkeypatch):
    """Record what would be started."""
    found = []
    monkeypatch.setattr(commands, "_run", lambda *words, with_view: found.append((*words, with_view)) or 0)
    return found


def test_each_command_starts_its_simulator_and_the_view(started):
    assert commands.gazebo(["--verbose", "a.world"]) == 0
    assert commands.gz(["sim", "-r", "a.sdf"]) == 0
    assert commands.gz(["sim", "-s", "a.sdf"]) == 0
    assert commands.gz(["gazebo", "-g"]) == 0
    assert commands.gzclient() == 0
    view_alone = ("", "", (), True)
    assert started == [
        ("gazebo_ros", "gzserver", ["--verbose", "a.world"], True),
        ("ros_gz_sim", "gz_sim", ["-r", "a.sdf"], True),
        ("ros_gz_sim", "gz_sim", ["-s", "a.sdf"], False),
        view_alone,
        view_alone,
    ]


@pytest.mark.parametrize(("words", "said"), [(["topic", "-l"], "gz has no 'topic' here"), ([], "gz has no '' here")])
def test_other_verbs_are_ros2s(started, capsys, words, said):
    assert commands.gz(words) == 2
    assert said in capsys.readouterr().err
    assert not started


def test_the_server_takes_what_launch_files_give_gazebo():
    words = "--verbose -s libgazebo_ros_init.so -slibgazebo_ros_factory.so -e ode --seed 3 --lockstep a.world -u"
    arguments = parse(words.split())
    assert (arguments.world, arguments.seed, arguments.pause) == ("a.world", 3, True)
