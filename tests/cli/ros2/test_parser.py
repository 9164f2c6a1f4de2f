import pytest
from ros2cli.parser import Parser

from daidalos.cli.ros2 import commands, main
from daidalos.cli.ros2.extension import make_command
from daidalos.cli.ros2.verbs import VerbCommand
from daidalos.common.extensions import first_line

NAMES = sorted(commands.BUILT_IN)


@pytest.mark.parametrize("name", NAMES)
def test_every_command_is_there_and_says_of_itself_what_the_list_says(name):
    command = commands.commands()[name]
    assert first_line(command) == commands.BUILT_IN[name]
    if isinstance(command, VerbCommand):
        for verb, description in command.verbs.items():
            assert first_line(command.extensions()[verb]) == description


@pytest.mark.parametrize("name", NAMES)
def test_every_verb_can_show_its_help(name, capsys):
    command = commands.commands()[name]
    for verb in getattr(command, "verbs", {None: ""}):
        words = [name, verb] if verb else [name]
        with pytest.raises(SystemExit) as ended:
            main([*words, "--help"])
        assert ended.value.code == 0
        shown = capsys.readouterr().out
        assert shown.startswith(f"usage: ros2 {' '.join(words)} ")


def test_without_a_command_the_help_is_shown(capsys):
    assert main([]) == 0
    assert "\nCommands:\n  action            Various action related" in capsys.readouterr().out


def test_without_a_verb_the_help_of_the_command_is_shown(capsys):
    assert main(["topic"]) == 0
    shown = capsys.readouterr().out
    assert "  echo   Output messages from a topic\n" in shown
    assert shown.rstrip().endswith("Call `ros2 topic <command> -h` for more detailed usage.")


@pytest.mark.parametrize(
    ("words", "fault"),
    [
        (["topic", "echo"], "ros2 topic echo: error: the following arguments are required: topic_name"),
        (["topic", "echo", "/x", "-l", "-3"], "value must be non-negative integer"),
        (["topic", "pub", "/x", "std_msgs/msg/Empty", "-1", "-t", "3"], "not allowed with argument -1/--once"),
        (["topic", "bw", "/x", "-w", "0"], "value must be a positive integer"),
        (["topic", "list", "--nope"], "ros2: error: unrecognized arguments: --nope"),
        (["param", "load"], "ros2 param load: error: the following arguments are required: node_name, parameter_file"),
        (["topic", "echo", "/x", "--qos-reliability", "best"], "invalid choice: 'best'"),
    ],
)
def test_wrong_arguments_end_with_status_2(words, fault, capsys):
    with pytest.raises(SystemExit) as ended:
        main(words)
    assert ended.value.code == 2
    assert fault in capsys.readouterr().err


def test_choosing_a_command_imports_no_other(capsys):
    made = []
    parser = Parser(prog="ros2")
    parser.add_subcommands("Commands", "ros2", commands.commands(), lambda command, *rest: made.append(command))
    parser.parse_args(["run"])
    assert [type(one).__name__ for one in made] == ["RunCommand"]


def test_a_command_knows_its_parser():
    parser = Parser(prog="ros2")
    parser.add_subcommands("Commands", "ros2", commands.commands(), make_command)
    args = parser.parse_args(["topic", "--include-hidden-topics", "list", "-t"])
    assert args.include_hidden_topics
    assert args.show_types
    args = parser.parse_args(["topic", "list"])
    assert not args.include_hidden_topics


def test_what_fails_after_an_interrupt_is_not_told(monkeypatch):
    def run(argv):
        try:
            raise KeyboardInterrupt
        finally:
            argv.half_made.close()

    monkeypatch.setattr("daidalos.cli.ros2.program._run", run)
    assert main(["topic"]) == 2


def test_what_fails_of_itself_is_told(monkeypatch):
    monkeypatch.setattr("daidalos.cli.ros2.program._run", lambda argv: argv.nothing)
    with pytest.raises(AttributeError):
        main(["topic"])
