"""Commands and verbs of other packages."""

from pathlib import Path

import pytest
from ros2cli.plugin_system import satisfies_version

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


from ros2launch.option import OptionExtension


class NoiseOption(OptionExtension):
    """Print when a launch begins and ends."""

    def add_arguments(self, parser, cli_name, *, argv=None):
        parser.add_argument("--noise")

    def prestart(self, args):
        print(f"{args.noise}: before", flush=True)

    def postlaunch(self, launch_return_code, args):
        print(f"{args.noise}: after {launch_return_code}", flush=True)
'''

UPSTREAM = '''
from ros2cli.command import CommandExtension, add_subparsers_on_demand
from ros2cli.node.strategy import NodeStrategy, add_arguments
from ros2cli.verb import VerbExtension


class CensusCommand(CommandExtension):
    """Count what there is."""

    def add_arguments(self, parser, cli_name):
        self._subparser = parser
        add_subparsers_on_demand(parser, cli_name, "_verb", "ros2census.verb", required=False)

    def main(self, *, parser, args):
        if not hasattr(args, "_verb"):
            self._subparser.print_help()
            return 0
        return args._verb.main(args=args)


class NodesVerb(VerbExtension):
    """Count the nodes."""

    def add_arguments(self, parser, cli_name):
        add_arguments(parser)
        parser.add_argument("--and-one", action="store_true")

    def main(self, *, args):
        with NodeStrategy(args) as node:
            print(len(node.get_node_names()) + args.and_one)
'''

ENTRY_POINTS = """
[ros2cli.command]
greet = greeting:GreetCommand
census = census:CensusCommand

[ros2cli.extension_point]
ros2census.verb = ros2cli.verb:VerbExtension

[ros2census.verb]
nodes = census:NodesVerb

[ros2launch.option]
noise = greeting:NoiseOption

[ros2topic.verb]
loud = greeting:LoudVerb
"""


@pytest.fixture
def with_package(env, tmp_path: Path):
    """An environment in which a package adds a command and a verb."""
    (tmp_path / "greeting.py").write_text(MODULE)
    (tmp_path / "census.py").write_text(UPSTREAM)
    info = tmp_path / "greeting-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: greeting\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text(ENTRY_POINTS)
    return {**env, "PYTHONPATH": str(tmp_path)}


def test_an_added_command_runs_and_is_listed(with_package):
    result = ros2("greet", "you", env=with_package)
    assert (result.status, result.out) == (3, "hello you\n")
    assert "  greet             Greet somebody\n" in ros2(env=with_package).out


@pytest.mark.slow
def test_an_added_verb_runs_and_is_listed(with_package):
    assert ros2("topic", "loud", "/scan", env=with_package).out == "/SCAN\n"
    assert "  loud   Shout a topic's name\n" in ros2("topic", env=with_package).out
    listed = ros2("extensions", "-v", env=with_package).out
    assert "  loud: Shout a topic's name\n    from: greeting 1.0 (greeting:LoudVerb)\n" in listed


def test_what_an_added_verb_returns_or_raises_is_the_message(with_package):
    for topic in ("bad", "worse"):
        result = ros2("topic", "loud", topic, env=with_package)
        assert (result.status, result.out, result.err) == (1, "", f"that is {topic}\n")


def test_groups_are_listed(env):
    shown = ros2("extension_points", env=env).out.splitlines()
    assert "ros2topic.verb" in shown
    assert "ros2cli.command" in shown


@pytest.mark.slow
def test_an_extension_written_for_ros2_runs_as_it_is(with_package):
    assert ros2("census", "nodes", "--no-daemon", "--and-one", env=with_package).out == "2\n"
    assert "Commands:\n  nodes  Count the nodes\n" in ros2("census", env=with_package).out
    result = ros2("census", "nods", env=with_package)
    assert result.status == 2
    assert "Did you mean 'nodes'?" in result.err


@pytest.mark.slow
def test_a_declared_group_is_listed(with_package):
    assert "ros2census.verb" in ros2("extension_points", env=with_package).out.splitlines()
    assert "ros2census.verb\n  nodes: Count the nodes\n" in ros2("extensions", env=with_package).out


def test_an_added_option_of_launch_acts(with_package, tmp_path):
    file = tmp_path / "quiet.launch.py"
    file.write_text("from launch import LaunchDescription\ndef generate_launch_description():\n"
                    "    return LaunchDescription([])\n")  # fmt: skip
    out = ros2("launch", "--noise", "boom", str(file), env=with_package).out
    assert out.startswith("boom: before\n")
    assert out.endswith("boom: after 0\n")


@pytest.mark.parametrize("fits", [("0.1", "^0.1"), ("0.1.3", "^0.1.2"), ("1.4", "^1.2")])
def test_versions_that_fit(fits):
    satisfies_version(*fits)


@pytest.mark.parametrize("misfit", [("0.1", "^0.2"), ("0.2", "^0.1"), ("2.0", "^1.2"), ("1.1", "^1.2")])
def test_versions_that_do_not_fit(misfit):
    with pytest.raises(RuntimeError, match="does not satisfy"):
        satisfies_version(*misfit)


@pytest.mark.parametrize("nonsense", [("0.1", "0.1"), ("x", "^0.1"), ("0.1", "^")])
def test_what_is_no_version(nonsense):
    with pytest.raises(ValueError, match="is not a "):
        satisfies_version(*nonsense)
