"""What programs find in the environment without a setup file."""

import os
import subprocess
import sys

import pytest

SET = ("ROS_DISTRO", "ROS_VERSION", "ROS_PYTHON_VERSION", "AMENT_PREFIX_PATH")
PROGRAM = "import {module}, os; print([os.environ.get(name) for name in {names}])"


@pytest.mark.parametrize("module", ["rclpy", "ament_index_python"])
def test_a_program_started_by_python_finds_what_a_setup_file_sets(module):
    env = {name: value for name, value in os.environ.items() if name not in SET}
    program = PROGRAM.format(module=module, names=SET)
    out = subprocess.run([sys.executable, "-c", program], env=env, capture_output=True, text=True, check=True).stdout
    assert out.startswith(f"['jazzy', '2', '3', '{sys.prefix}{os.pathsep}")


def test_what_is_set_is_kept():
    env = {**os.environ, "ROS_DISTRO": "humble", "AMENT_PREFIX_PATH": "/opt/mine"}
    program = PROGRAM.format(module="ament_index_python", names=SET)
    out = subprocess.run([sys.executable, "-c", program], env=env, capture_output=True, text=True, check=True).stdout
    assert out == "['humble', '2', '3', '/opt/mine']\n"
