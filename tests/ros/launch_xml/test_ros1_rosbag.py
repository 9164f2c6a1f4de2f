"""Command lines of ROS 1's `rosbag`: translated, and run in launch files."""

import re
import shlex
import sys

import pytest
from launch_xml.ros1.rosbag import ros2_command

# A shell starts soon enough to be there when it is interrupted, on a busy machine as well.
SHOW = """#!/bin/sh
trap 'echo ENDED; exit 0' INT
printf RAN
printf " '%s'" "$@"
echo
case "$*" in *forever*) while :; do sleep 0.1; done ;; esac
"""


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("record -a", "record --all-topics"),
        ("record scan /tf -O walk.bag", "record --output walk --topics /scan /tf"),
        ("record -Owalk /tf", "record --output walk --topics /tf"),
        ("record --output-name=walk /tf", "record --output walk --topics /tf"),
        ("record -e /a.* /b", "record --regex '^(/a.*)$|^(/b)$'"),
        ("record -a -x /camera/.* -q", "record --all-topics --exclude-regex '^(/camera/.*)$' --log-level warn"),
        ("record -a -b 2 -j", "record --all-topics --max-cache-size 2097152 --compression-mode file "
         "--compression-format zstd"),
        ("record -a --split --size=3", "record --all-topics --max-bag-size 3145728"),
        ("record -a --split --duration=2m", "record --all-topics --max-bag-duration 120"),
        ("play walk.bag", "play walk"),
        ("play -l --clock walk.bag", "play walk --clock 100 --loop"),
        ("play --clock --hz=50 -r 2 -s 3.5 -u 10 -d 1 walk", "play walk --clock 50 --rate 2 --delay 1 "
         "--start-offset 3.5 --playback-duration 10"),
        ("play --pause --queue 7 walk --topics /a /b", "play walk --read-ahead-queue-size 7 --start-paused "
         "--topics /a /b"),
        ("play one.bag two.bag", "play --input one --input two"),
        ("play --topics /a --bags one.bag two.bag", "play --input one --input two --topics /a"),
        ("play walk a:=/b __name:=player", "play walk --remap /a:=/b"),
    ],
)  # fmt: skip
def test_todays_command(old, new):
    verb, *words = shlex.split(old)
    command = ros2_command(verb, words)
    assert command.arguments == shlex.split(new)
    assert command.notes == []
    assert command.duration_s is None


def test_names_are_those_of_the_scope():
    command = ros2_command("record", ["scan", "odom", "/tf"], "/robot", [("odom", "/odometry"), ("/tf", "tf")])
    assert command.arguments == ["record", "--topics", "/robot/scan", "/odometry", "/robot/tf"]


def test_a_bag_of_the_old_name_is_played(tmp_path):
    old = tmp_path / "walk.bag"
    old.touch()
    assert ros2_command("play", [str(old)]).arguments == ["play", str(old)]


def test_output_has_the_time_in_its_name():
    _, option, name, _ = ros2_command("record", ["-o", "walk", "-a"]).arguments
    assert option == "--output"
    assert re.fullmatch(r"walk_\d{4}(_\d\d){2}-(\d\d_){2}\d\d", name)


@pytest.mark.parametrize(
    ("old", "option"),
    [("record -a -l 5", "--limit"), ("record -a --size 5", "--size"), ("play -k walk", "--keep-alive")],
)
def test_what_is_not_done_is_said(old, option):
    verb, *words = old.split()
    (note,) = ros2_command(verb, words).notes
    assert note.startswith(option)


@pytest.mark.parametrize(
    ("old", "reason"),
    [
        ("record -a --dance", "rosbag record: unrecognized arguments: --dance"),
        ("record -a --duration=soon", "argument -d/--duration: 'soon' is not a duration; expected such as 30s"),
        ("play", "expected a bag to play, found none"),
    ],
)
def test_bad_words(old, reason):
    verb, *words = old.split()
    with pytest.raises(ValueError, match=re.escape(reason)):
        ros2_command(verb, words)


@pytest.fixture
def launched(tmp_path, monkeypatch, capsys, run_text):
    """Run the text of a launch file with a command `ros2` that prints its arguments; return what was printed."""
    program = tmp_path / "ros2"
    program.write_text(SHOW)
    program.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path), prepend=":")
    monkeypatch.setenv("OVERRIDE_LAUNCH_PROCESS_OUTPUT", "screen")

    def run(text, **options):
        run_text(text, **options)
        return "".join(capsys.readouterr())

    return run


@pytest.mark.skipif(sys.platform == "win32", reason="the command is a script with a #! line")
def test_in_a_launch_file(launched):
    printed = launched(
        """
        <launch>
            <arg name="file" default="walk"/>
            <group ns="robot">
                <node pkg="rosbag" type="record" name="log" args="-O $(arg file).bag --node=/n scan odom">
                    <remap from="odom" to="/odometry" if="true"/>
                </node>
            </group>
            <node pkg="rosbag" type="record" name="short" args="-d 0.3s -O forever -a" required="true"/>
        </launch>
        """
    )
    assert "node rosbag/record -> ros2 bag record" in printed
    assert "RAN 'bag' 'record' '--output' 'walk' '--topics' '/robot/scan' '/odometry'" in printed
    assert "--node has no counterpart: name the topics instead" in printed
    # The one that is to end by itself did, and the launch with it.
    assert "RAN 'bag' 'record' '--output' 'forever' '--all-topics'" in printed
    assert "ENDED" in printed


@pytest.mark.skipif(sys.platform == "win32", reason="the command is a script with a #! line")
def test_mistakes_are_located(run_text):
    service = run_text("<launch>\n<node pkg='rosbag' type='play' name='p' args='--dance'/></launch>", expected=1)
    assert (service.error.line, service.error.reason) == (2, "rosbag play: unrecognized arguments: --dance")
