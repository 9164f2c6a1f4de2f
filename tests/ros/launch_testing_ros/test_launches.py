"""Launch tests of nodes under pytest, in domains of their own."""

import os
import re

import pytest
from launch import LaunchDescription, LaunchService
from launch.actions import OpaqueFunction
from launch_testing_ros.actions import EnableRmwIsolation
from launch_testing_ros.tools import basic_output_filter

pytest_plugins = ["pytester"]

TEST = """
import sys
import unittest
import launch
import launch_testing.actions
import launch_testing.markers
import pytest

@pytest.mark.rostest
@launch_testing.markers.keep_alive
def generate_test_description():
    return launch.LaunchDescription([launch_testing.actions.ReadyToTest()])

class TestGraph(unittest.TestCase):
    def test_the_launch_adds_no_node(self, launch_service):
        self.assertNotIn('launch_ros.ros_adapters', sys.modules)
"""


def test_a_description_for_ros_is_run_without_a_node_of_its_own(pytester, monkeypatch, tmp_path):
    monkeypatch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")
    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path))
    pytester.makepyfile(test_ros=TEST)
    plugins = ("-p", "launch_testing.pytest.hooks", "-p", "launch_testing_ros.pytest.hooks", "-p", "no:cacheprovider")
    pytester.runpytest_subprocess(*plugins, "--strict-markers", "test_ros.py").assert_outcomes(passed=1)


@pytest.mark.parametrize("before", [None, "7"])
def test_a_launch_in_a_domain_of_its_own(before, monkeypatch, tmp_path):
    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path))
    monkeypatch.delenv("ROS_DOMAIN_ID", raising=False)
    if before:
        monkeypatch.setenv("ROS_DOMAIN_ID", before)
    seen = []
    service = LaunchService()
    note = OpaqueFunction(function=lambda context: seen.append(context.environment["ROS_DOMAIN_ID"]))
    service.include_launch_description(LaunchDescription([EnableRmwIsolation(), note]))
    assert service.run() == 0
    assert re.fullmatch(r"[1-9]\d?|100", seen[0])
    assert os.environ.get("ROS_DOMAIN_ID") == before


def test_output_without_what_a_middleware_says(tmp_path, monkeypatch):
    resources = tmp_path / "share" / "ament_index" / "resource_index"
    for kind, text in (("prefixes", "[rmw]"), ("patterns", ".*discovery.*")):
        folder = resources / f"rmw_output_{kind}"
        folder.mkdir(parents=True)
        (folder / "rmw_loud").write_text(text)
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path))
    output = "pid 5\n[rmw] up\nhello\nin discovery now\n[mine] up\n"
    assert basic_output_filter(filtered_rmw_implementation="rmw_loud")(output) == "hello\n[mine] up\n"
    assert basic_output_filter(["[m"], ["hel+o"])(output) == "pid 5\n[rmw] up\nin discovery now\n"
