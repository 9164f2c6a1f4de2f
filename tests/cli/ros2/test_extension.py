"""Commands and verbs of other packages."""

from pathlib import Path

import pytest

from .commands import ros2

MODULE = '''
class GreetCommand:
    """Greet somebody.

    More about it.
    """

    def add_arguments(self, parser, cli_name):
        parser.add_argument("who")

    def main(self, *, parser, args):
        print(f"hello {args.who}")
        return 3


class LoudVerb:
    """Shout a topic's name."""

    def add_arguments(self, parser, cli_name):
        parser.add_argument("topic")

    def main(self, *, args):
        if args.topic == "bad":
            raise RuntimeError("that is bad")
        if args.topic == "worse":
            return "that is worse"
        print(args.topic.upper())
'''

ENTRY_POINTS = """
[ros2cli.command]
greet = greeting:GreetCommand

[ros2topic.verb]
loud = greeting:LoudVerb
"""


@pytest.fixture
def with_package(env, tmp_path: Path):
    """An environment in which a package adds a command and a verb."""
    (tmp_path / "greeting.py").write_text(MODULE)
    info = tmp_path / "greeting-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: greeting\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text(ENTRY_POINTS)
    return {**env, "PYTHONPATH": str(tmp_path)}


def test_an_added_command_runs_and_is_listed(with_package):
    result = ros2("greet", "you", env=with_package)
    assert (result.status, result.out) == (3, "hello you\n")
    assert "  greet             Greet somebody\n" in ros2(env=with_package).out


def test_an_added_verb_runs_and_is_listed(with_package):
    assert ros2("topic", "loud", "/scan", env=with_package).out == "/SCAN\n"
    assert "  loud   Shout a topic's name\n" in ros2("topic", env=with_package).out
    listed = ros2("extensions", "-v", env=with_package).out
    assert "  loud: Shout a topic's name\n    from: greeting (greeting:LoudVerb)\n" in listed


def test_what_an_added_verb_returns_or_raises_is_the_message(with_package):
    for topic in ("bad", "worse"):
        result = ros2("topic", "loud", topic, env=with_package)
        assert (result.status, result.out, result.err) == (1, "", f"that is {topic}\n")


def test_groups_are_listed(env):
    shown = ros2("extension_points", env=env).out.splitlines()
    assert "ros2topic.verb" in shown
    assert "ros2cli.command" in shown
