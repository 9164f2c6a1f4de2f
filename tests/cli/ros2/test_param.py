"""What of `ros2 param` no transcript shows."""

import subprocess

import pytest
import yaml

from daidalos.cli.ros2.param.dump import nested
from daidalos.workspaces.executables import built_in_command

from .commands import ros2

NODE = """
import rclpy
rclpy.init()
node = rclpy.create_node("talker", namespace="/lab")
node.declare_parameter("speed", 1.0)
node.declare_parameter("gains.p", [1, 2])
rclpy.spin(node)
"""


def test_parameters_as_a_tree():
    flat = {"a": 1, "gains.p": 2.0, "gains.d.far": 3.0}
    assert nested(flat.items()) == {"a": 1, "gains": {"p": 2.0, "d": {"far": 3.0}}}
    assert nested({"gains.p": 2.0, "gains": 1, "gains.d.far": 3.0}.items()) == {
        "gains": 1,
        "gains.p": 2.0,
        "gains.d.far": 3.0,
    }


@pytest.fixture
def talker(beside, wait_for):
    beside(NODE)
    wait_for("/lab/talker/set_parameters")


@pytest.mark.slow
def test_what_is_dumped_can_be_loaded(env, talker, tmp_path):
    dumped = ros2("param", "dump", "/lab/talker", env=env).out
    saved = ros2("param", "dump", "/lab/talker", "--output-dir", ".", env=env, cwd=tmp_path)
    assert saved.out == "Saving to:  lab__talker.yaml\n"
    text = (tmp_path / "lab__talker.yaml").read_text()
    assert yaml.safe_load(text) == yaml.safe_load(dumped)
    (tmp_path / "faster.yaml").write_text(text.replace("speed: 1.0", "speed: 2.0"))
    assert (
        "Set parameter speed successful\n"
        in ros2("param", "load", "/lab/talker", "faster.yaml", env=env, cwd=tmp_path).out
    )
    assert ros2("param", "get", "--hide-type", "/lab/talker", "speed", env=env).out == "2.0\n"
    again = ros2("param", "load", "/lab/talker", "lab__talker.yaml", env=env, cwd=tmp_path)
    assert again.err == ""
    assert "Parameter start_type_description_service is read-only and has this value already\n" in again.out
    other = text.replace("description_service: true", "description_service: false")
    (tmp_path / "other.yaml").write_text(other)
    refused = ros2("param", "load", "/lab/talker", "other.yaml", env=env, cwd=tmp_path)
    assert "Set parameter start_type_description_service failed: " in refused.err
    result = ros2("param", "dump", "/lab/talker", "--output-dir", "nowhere", env=env, cwd=tmp_path)
    assert (result.status, result.err) == (1, "nowhere/lab__talker.yaml: No such file or directory\n")


def test_a_node_that_is_starting_is_waited_for(env):
    with subprocess.Popen(built_in_command("demo_nodes_py", "talker"), stderr=subprocess.DEVNULL, env=env) as node:
        try:
            got = ros2("param", "get", "/talker", "use_sim_time", env=env)
            assert (got.status, got.out) == (0, "Boolean value is: False\n")
        finally:
            node.kill()


@pytest.mark.slow
def test_lists_are_filtered(env, talker):
    listed = ros2("param", "list", "/lab/talker", "--param-prefixes", "gains", "--param-type", env=env).out
    assert listed == "  gains.p (type: integer array)\n"
    assert ros2("param", "list", "--filter", "^spe", env=env).out == "/lab/talker:\n  speed\n"
