"""Built-in verbs and commands as ROS 2's packages have them: entry points and modules."""

import importlib
from importlib.metadata import distribution

import pytest
from ros2cli.plugin_system import instantiate_extensions

from daidalos.cli.ros2.groups import groups

PUBLIC_GROUPS = [group for group in groups() if group.endswith(".verb") and group.startswith("ros2")]


def declared(group: str) -> dict[str, str]:
    points = distribution("daidalos").entry_points
    return {point.name: point.value for point in points if point.group == group}


@pytest.mark.parametrize("group", groups())
def test_the_built_in_extensions_are_entry_points(group):
    kind = groups()[group].kind
    assert declared(group) == {extension.name: extension.target for extension in kind.built_in()}


@pytest.mark.parametrize("group", PUBLIC_GROUPS)
def test_a_verb_has_a_module(group):
    package = "ros2cli.verb.daemon" if group == "ros2cli.daemon.verb" else group
    for name, target in declared(group).items():
        original, _, attribute = target.partition(":")
        module = importlib.import_module(f"{package}.{name}")
        assert getattr(module, attribute) is getattr(importlib.import_module(original), attribute)


def test_a_command_has_a_module():
    assert importlib.import_module("ros2topic.command.topic").TopicCommand.__doc__


def test_what_is_no_verb_has_no_module():
    with pytest.raises(ModuleNotFoundError, match=r"ros2topic\.verb\.sing"):
        importlib.import_module("ros2topic.verb.sing")


def test_verbs_are_instantiated_once():
    found = instantiate_extensions("ros2multicast.verb")
    assert sorted(found) == ["receive", "send"]
    assert instantiate_extensions("ros2multicast.verb", exclude_names=["send"]) == {"receive": found["receive"]}
    assert instantiate_extensions("ros2multicast.verb", unique_instance=True)["send"] is not found["send"]
