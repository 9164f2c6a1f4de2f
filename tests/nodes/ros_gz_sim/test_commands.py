"""gz's command lines."""

import re

import pytest
from rclpy.node import Node
from rclpy.parameter import Parameter

from daidalos.nodes.gazebo_ros import spawn_entity
from daidalos.nodes.gazebo_ros.spawn_model import translate
from daidalos.nodes.ros_gz_sim import create, gz_sim
from daidalos.nodes.runner import UserError
from end_to_end.processes import ROS2, finished
from ros.graph import graph  # noqa: F401


def test_gzs_arguments_may_come_in_one_word():
    arguments = gz_sim.parse(["-r -v4 shop.sdf"])
    assert (arguments.run, arguments.verbose, arguments.world) == (True, 4, "shop.sdf")
    assert gz_sim.parse(["-v", "2", "-s"]).server


def test_create_takes_one_dash_or_two():
    arguments = create.parse(["-name", "bot", "--file", "a.sdf", "-x", "1.5", "-Y", "-2", "-allow_renaming", "true"])
    assert (arguments.name, arguments.file, arguments.x, arguments.Y) == ("bot", "a.sdf", 1.5, -2.0)
    assert arguments.allow_renaming is True


def test_numbers_may_be_as_programs_write_them():
    words = ["-x", "-1.5e-05", "-y=-2e-3", "-z", "-0.5", "-Y", "-3E+0"]
    arguments = create.parse([*words, "-name", "bot"])
    assert (arguments.x, arguments.y, arguments.z, arguments.Y) == (-1.5e-05, -2e-3, -0.5, -3.0)
    spawned = spawn_entity.parse([*words, "-entity", "bot", "-stdin"], "spawn_entity.py")
    assert (spawned.x, spawned.y, spawned.z, spawned.Y) == (-1.5e-05, -2e-3, -0.5, -3.0)


def test_create_leaves_out_what_it_does_not_know(capsys):
    assert create.parse(["-entity", "bot", "-topic", "robot_description"]).topic == "robot_description"
    assert capsys.readouterr().err == "warning: create does not know -entity bot, left out\n"


def test_create_takes_parameters_where_no_word_is_given(graph):  # noqa: F811
    values = {"name": "bot", "z": 2, "x": 1.0, "allow_renaming": True}
    overrides = [Parameter(name, value=value) for name, value in values.items()]
    node = Node("create", parameter_overrides=overrides)
    arguments = create.parse(["-x", "3"])
    create.take_parameters(arguments, node)
    assert (arguments.name, arguments.x, arguments.y, arguments.z) == ("bot", 3.0, 0.0, 2.0)
    assert arguments.allow_renaming is True
    assert arguments.file == ""


def test_ros1s_spawner_has_its_own_words():
    words = ["-urdf", "-param", "robot_description", "-model", "bot", "-J", "elbow", "0.5", "-z", "1"]
    assert translate(words) == (["-topic", "robot_description", "-entity", "bot", "-z", "1"], {"elbow": 0.5})
    with pytest.raises(UserError, match="-J takes"):
        translate(["-J", "elbow"])


@pytest.mark.parametrize(
    ("name", "arguments"),
    [
        ("gz_sim", {"gz_args", "on_exit_shutdown"}),
        ("ros_gz_sim", {"world_sdf_file", "world_sdf_string", "bridge_name", "config_file"}),
        ("ros_gz_spawn_model", {"file", "entity_name", "x", "config_file"}),
    ],
)
def test_launch_files_take_gzs_arguments(domain, name, arguments):
    told = finished(*ROS2, "launch", "ros_gz_sim", f"{name}.launch.py", "--show-args", domain=domain, timeout=30)
    assert told.returncode == 0
    assert arguments <= set(re.findall(r"^ +'(\w+)':$", told.stdout, re.MULTILINE))
