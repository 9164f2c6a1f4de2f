"""Launch's logging: screen, main log file, files of processes."""

import logging
import os
import re
from collections import defaultdict
from pathlib import Path

import launch.logging
import pytest
from launch.logging import handlers, launch_config


def logged(name="launch.log"):
    launch_config.get_log_file_handler(name).flush()
    return Path(launch_config.get_log_file_path(name)).read_text().splitlines()


def test_screen_and_main_log_file(capsys):
    logger = launch.logging.get_logger("some.logger")
    logger.debug("hidden")
    logger.warning("shown")
    assert capsys.readouterr().out == "[WARNING] [some.logger]: shown\n"
    assert len(logged()) == 1
    assert re.fullmatch(r"\d+\.\d{7} \[WARNING\] \[some\.logger\]: shown", logged()[0])


def test_level(capsys):
    launch_config.level = logging.DEBUG
    assert launch_config.level == logging.DEBUG
    launch.logging.get_logger("x").debug("now shown")
    assert "[DEBUG] [x]: now shown" in capsys.readouterr().out


def test_loggers_do_not_print_twice(capsys):
    launch.logging.get_logger("a")
    launch.logging.get_logger("a")
    launch.logging.get_logger("a.b").error("once")
    assert capsys.readouterr().out.count("once") == 1


def test_other_loggers_are_left_alone():
    launch.logging.get_logger("mine")
    other = logging.getLogger("somebody.elses.logger")
    assert type(other) is logging.Logger
    assert other.propagate


def test_screen_formats(capsys):
    launch_config.set_screen_format("default_with_timestamp")
    launch.logging.get_logger("x").info("a")
    assert re.fullmatch(r"\d+\.\d{7} \[INFO\] \[x\]: a\n", capsys.readouterr().out)
    launch_config.set_screen_format("%(message)s!", screen_style="%")
    launch.logging.get_logger("x").info("b")
    assert capsys.readouterr().out == "b!\n"
    launch_config.set_log_format("only {message}")
    launch.logging.get_logger("x").info("c")
    assert logged()[-1] == "only c"


def test_formats_from_the_environment(capsys, monkeypatch):
    monkeypatch.setenv("OVERRIDE_LAUNCH_SCREEN_FORMAT", "<{message}>")
    launch.logging.reset()
    launch_config.set_screen_format("default")
    launch.logging.get_logger("x").info("a")
    assert capsys.readouterr().out == "<a>\n"


def test_bad_configuration():
    with pytest.raises(ValueError, match="not a folder"):
        launch_config.log_dir = "not/a/real/dir"
    with pytest.raises(ValueError, match="its own style"):
        launch_config.set_screen_format("default", screen_style="%")
    with pytest.raises(ValueError, match="its own style"):
        launch_config.set_log_format("default", log_style="%")


def test_log_dir(tmp_path):
    launch_config.log_dir = str(tmp_path)
    assert launch_config.log_dir == str(tmp_path)
    assert launch_config.get_log_file_path() == str(tmp_path / "launch.log")
    assert launch_config.get_log_file_path("x.log") == str(tmp_path / "x.log")
    launch_config.get_log_file_handler()
    with pytest.raises(RuntimeError, match="cannot be changed"):
        launch_config.log_dir = str(tmp_path)


def test_each_launch_has_its_own_folder_and_the_latest_is_linked(tmp_path):
    first = launch_config.log_dir
    assert os.path.dirname(first) == str(tmp_path / "log")
    launch.logging.reset()
    second = launch_config.log_dir
    assert first != second
    assert os.path.isdir(first)
    assert os.path.realpath(tmp_path / "log" / "latest") == os.path.realpath(second)


@pytest.mark.parametrize(
    ("environment", "expected"),
    [
        ({}, "{home}/.ros/log"),
        ({"ROS_HOME": "{tmp}/ros"}, "{tmp}/ros/log"),
        ({"ROS_HOME": "{tmp}/ros", "ROS_LOG_DIR": "{tmp}/logs"}, "{tmp}/logs"),
        ({"ROS_LOG_DIR": "{tmp}//logs/"}, "{tmp}/logs"),
        ({"ROS_LOG_DIR": ""}, "{home}/.ros/log"),
        ({"ROS_LOG_DIR": "~/logs"}, "{home}/logs"),
    ],
)
def test_where_the_folders_are(environment, expected, tmp_path, monkeypatch):
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    for name in ("ROS_HOME", "ROS_LOG_DIR"):
        monkeypatch.delenv(name, raising=False)
    for name, value in environment.items():
        monkeypatch.setenv(name, value.format(tmp=tmp_path))
    launch.logging.reset()
    folder = expected.format(home=tmp_path / "home", tmp=tmp_path)
    assert os.path.dirname(launch_config.log_dir) == os.path.normpath(folder)


def test_log_handler_factory():
    class Keeping(handlers.Handler):
        def __init__(self, kept):
            super().__init__()
            self.kept = kept

        def emit(self, record):
            self.kept.append(self.format(record))

    kept = defaultdict(list)
    launch_config.log_handler_factory = lambda path, encoding=None: Keeping(kept[path])
    launch.logging.get_logger("x").error("kept")
    assert kept[launch_config.get_log_file_path()][0].endswith("kept")


ALL = {"screen", "log", "own_log"}


@pytest.mark.parametrize(
    ("config", "stdout", "stderr", "both"),
    [
        ("screen", set(), set(), {"screen"}),
        ("log", set(), {"screen"}, {"log"}),
        ("both", set(), set(), {"screen", "log"}),
        ("own_log", {"own_log"}, {"own_log"}, {"own_log"}),
        ("full", {"own_log"}, {"own_log"}, ALL),
        ({"stdout": "screen", "stderr": "log"}, {"screen"}, {"log"}, set()),
        ({"stdout": {"own_log", "log"}}, {"own_log", "log"}, set(), set()),
        ({"both": ALL}, set(), set(), ALL),
        ({}, set(), set(), set()),
    ],
)
def test_output_of_processes(config, stdout, stderr, both, capsys):
    main = launch.logging.get_logger("proc")
    main.error("main")
    out, err = launch.logging.get_output_loggers("proc", config)
    out.info("[proc] foo")
    err.info("[proc] bar")

    def expected(destination):
        return [
            line for line, source in (("[proc] foo", stdout), ("[proc] bar", stderr)) if destination in source | both
        ]

    assert capsys.readouterr().out.splitlines() == ["[ERROR] [proc]: main", *expected("screen")]
    assert [line.split(" ", 1)[1] for line in logged()] == ["[ERROR] [proc]: main", *expected("log")]
    own = {"proc-stdout.log": [], "proc-stderr.log": [], "proc.log": []}
    if "own_log" in stdout:
        own["proc-stdout.log"] = ["[proc] foo"]
    if "own_log" in stderr:
        own["proc-stderr.log"] = ["[proc] bar"]
    if "own_log" in both:
        own["proc.log"] = ["[proc] foo", "[proc] bar"]
    for name, lines in own.items():
        path = launch_config.get_log_file_path(name)
        assert (logged(name) if os.path.exists(path) else []) == lines


@pytest.mark.parametrize("config", ["everywhere", 1, {"stdin": "screen"}, {"stdout": "paper"}, {"both": {"log", "x"}}])
def test_invalid_output(config):
    with pytest.raises(ValueError, match="not a valid output configuration"):
        launch.logging.get_output_loggers("proc", config)


def test_what_processes_print_is_shown_at_any_level(capsys):
    launch_config.level = logging.ERROR
    out, _ = launch.logging.get_output_loggers("proc", "screen")
    out.info("still")
    assert capsys.readouterr().out == "still\n"


def test_colour_on_a_terminal_only(monkeypatch):
    record = logging.LogRecord("launch", logging.ERROR, "", 0, "text", None, None)
    line = logging.LogRecord("talker-1-stdout", logging.INFO, "", 0, "[talker-1] hello", None, None)
    level = launch.logging.screen_formatter("default", None)
    prefix = launch.logging.output_screen_formatter()
    assert level.format(record) == "[ERROR] [launch]: text"
    assert prefix.format(line) == "[talker-1] hello"
    monkeypatch.setattr("sys.stdout.isatty", lambda: True, raising=False)
    monkeypatch.delenv("NO_COLOR", raising=False)
    assert level.format(record).startswith("\033[31m[ERROR]\033[0m ")
    assert re.fullmatch(r"\033\[\d+m\[talker-1\]\033\[0m hello", prefix.format(line))
    monkeypatch.setenv("NO_COLOR", "1")
    assert level.format(record) == "[ERROR] [launch]: text"


def test_a_reset_forgets_levels_and_handlers():
    launch.logging.reset()
    logger = launch.logging.get_logger("forgetful")
    logger.addHandler(logging.NullHandler())
    logger.setLevel(logging.ERROR)
    launch.logging.launch_config.log_dir = None
    launch.logging.reset()
    assert logger.handlers == []
    assert logger.getEffectiveLevel() == logging.INFO
