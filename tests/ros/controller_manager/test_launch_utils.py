"""What launches spawners."""

import pytest
from controller_manager.launch_utils import (
    generate_controllers_spawner_launch_description,
    generate_controllers_spawner_launch_description_from_dict,
    generate_load_controller_launch_description,
)
from launch import LaunchContext
from launch.actions import DeclareLaunchArgument
from launch.substitutions import PathJoinSubstitution
from launch.utilities import perform_substitutions
from launch_ros.actions import Node


def commands(description, **arguments):
    """Return the words that each spawner would be started with."""
    context = LaunchContext()
    for entity in description.entities:
        if isinstance(entity, DeclareLaunchArgument):
            context.launch_configurations[entity.name] = perform_substitutions(context, entity.default_value)
    context.launch_configurations.update(arguments)
    found = []
    for node in description.entities:
        if isinstance(node, Node) and (node.condition is None or node.condition.evaluate(context)):
            package = perform_substitutions(context, node.node_package)
            program, *words = [perform_substitutions(context, word) for word in node.cmd]
            assert (package, program) == ("controller_manager", "spawner")
            # A shell leaves out empty words.
            assert node.shell
            found.append([word for word in words if word])
    return found


def test_one_spawner_takes_all_names_and_files():
    description = generate_controllers_spawner_launch_description(["a", "b"], ["x.yaml", "y.yaml"], ["--inactive"])
    expected = "a b --controller-manager {} --param-file x.yaml --param-file y.yaml --inactive"
    assert commands(description) == [expected.format("controller_manager").split()]
    [words] = commands(description, controller_manager_name="/r/cm", unload_on_kill="true")
    assert sorted(words) == sorted([*expected.format("/r/cm").split(), "--unload-on-kill"])
    assert len(description.entities) == 3


@pytest.mark.parametrize(
    ("files", "words"),
    [
        (None, []),
        ("x.yaml", ["--param-file", "x.yaml"]),
        (PathJoinSubstitution(["d", "x.yaml"]), ["--param-file", "d/x.yaml"]),
    ],
)
def test_files_may_be_one_or_none(files, words):
    expected = [["a", "--controller-manager", "controller_manager", *words]]
    assert commands(generate_load_controller_launch_description("a", files)) == expected
    assert commands(generate_controllers_spawner_launch_description_from_dict({"a": files})) == expected
