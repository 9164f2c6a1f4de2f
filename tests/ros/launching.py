"""What the tests of all packages of launch share: an environment of their own, and running text."""

import os

import pytest


@pytest.fixture(autouse=True)
def sandbox(tmp_path, monkeypatch):
    """Isolate log files and environment of each test."""
    import launch._process  # before a test puts another module of executables in its place
    import launch.logging

    environment = dict(os.environ)
    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path / "log"))
    for name in ("OVERRIDE_LAUNCH_PROCESS_OUTPUT", "OVERRIDE_LAUNCH_SCREEN_FORMAT", "OVERRIDE_LAUNCH_LOG_FORMAT"):
        monkeypatch.delenv(name, raising=False)
    launch.logging.reset()
    yield
    launch.logging.reset()
    os.environ.clear()
    os.environ.update(environment)


@pytest.fixture
def run_text():
    """Run the text of a launch file in markup, and return the service."""
    import io
    import textwrap

    from launch import LaunchService
    from launch.frontend import Parser

    descriptions = []  # temporary parameter files are deleted with the actions that wrote them

    def run(text, expected=0, **configurations):
        root, parser = Parser.load(io.StringIO(textwrap.dedent(text)))
        descriptions.append(parser.parse_description(root))
        service = LaunchService()
        service.context.launch_configurations.update(configurations)
        service.include_launch_description(descriptions[-1])
        assert service.run() == expected
        return service

    return run
