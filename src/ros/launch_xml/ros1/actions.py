"""Actions of translated launch files beside those of ROS 2."""

from __future__ import annotations

import functools
import os
import shlex
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from launch import Action
from launch.actions import IncludeLaunchDescription, OpaqueFunction
from launch.frontend import Entity
from launch.frontend.expose import expose_action, expose_substitution
from launch.frontend.type_utils import get_data_type_from_identifier
from launch.launch_description_entity import LaunchDescriptionEntity
from launch.some_substitutions_type import SomeSubstitutionsType
from launch.substitution import Substitution
from launch.substitutions import SubstitutionFailure
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

from ..entity import Entity as XMLEntity
from .parameters import Ros1Parameters

if TYPE_CHECKING:
    from launch import Condition, LaunchContext
    from launch.frontend import Parser

# Launch configurations that are not arguments: namespaces, parameters and remappings.
_CONDITIONS = ("if", "unless")
_PARTS = ("param", "rosparam", "remap", "env")
_SPECIAL_RULES = {"__name": "__node", "__ns": "__ns"}
_INTERNAL = ("ros_namespace", "global_params", "ros_remaps")


@expose_action("ros1:node")
def parse_node(entity: Entity, parser: Parser) -> tuple[type[Action], dict[str, Any]]:
    """Read a node of ROS 1; it may have files of parameters in ROS 1's form, and parts with conditions."""
    from launch_ros.actions import Node

    parts = [part for tag in _PARTS for part in entity.get_attr(tag, data_type=list[Entity], optional=True) or []]
    if any(_condition(part, parser) is not None for part in parts):
        return _NodeWithConditions, {"entity": entity, "parser": parser}
    verb = entity.get_attr("rosbag", optional=True)
    _, kwargs = Node.parse(entity, parser)
    files = entity.get_attr("rosparam", data_type=list[Entity], optional=True) or []
    values: dict[Any, Any] = {}
    for parameter in kwargs.pop("parameters", []):
        values.update(parameter)
    kwargs["parameters"] = [_parse_parameters(file, parser) for file in files]
    if values:
        kwargs["parameters"].append(values)
    command_line = entity.get_attr("command_line", optional=True)
    if command_line is not None:
        kwargs["command_line"] = parser.parse_substitution(command_line)
    if verb is not None:
        from .rosbag_action import Rosbag

        names = ("package", "executable", "parameters")
        return Rosbag, {"verb": verb, **{name: value for name, value in kwargs.items() if name not in names}}
    return _node_class(), kwargs


@functools.cache
def _node_class() -> type[Action]:
    """Return the action that runs a node of ROS 1; made late, because only files with nodes need `launch_ros`."""
    from launch_ros.actions import Node

    class Ros1Node(Node):
        """Action that runs a node whose arguments are split after their substitutions were performed, as in ROS 1."""

        def __init__(self, *, command_line: SomeSubstitutionsType = "", **kwargs: Any) -> None:
            super().__init__(**kwargs)
            self.__command_line = normalize_to_list_of_substitutions(command_line)

        def _perform_substitutions(self, context: LaunchContext) -> None:
            words = _ros2_arguments(shlex.split(perform_substitutions(context, self.__command_line)))
            self.process_description.cmd.extend(normalize_to_list_of_substitutions(word) for word in words)
            super()._perform_substitutions(context)

    return Ros1Node


def _ros2_arguments(words: list[str]) -> list[str]:
    """Return the words of a command line with its rules, such as ``scan:=/scan`` and ``_rate:=5``, marked as those."""
    rules: list[str] = []
    for word in words:
        name, sign, value = word.partition(":=")
        if not sign:
            continue
        if name in _SPECIAL_RULES:
            rules += ["-r", f"{_SPECIAL_RULES[name]}:={value}"]
        elif name.startswith("_") and not name.startswith("__"):
            rules += ["-p", f"{name[1:]}:={value}"]
        elif not name.startswith("__"):
            rules += ["-r", word]
    others = [word for word in words if ":=" not in word]
    return [*others, "--ros-args", *rules, "--"] if rules else others


class _NodeWithConditions(Action):
    """Action that runs a node with those of its parameters and remappings whose conditions hold.

    Parameters
    ----------
    entity
        The node's element.
    parser
        The parser of its file.
    """

    def __init__(self, *, entity: XMLEntity, parser: Parser) -> None:
        super().__init__()
        self.__parser = parser
        self.__entity = entity.without_children(lambda child: False, ())
        # Mistakes are to be found before anything runs.
        parser.parse_action(self.__entity.without_children(lambda child: False, _CONDITIONS))

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        """Choose the parts, and yield the node."""

        def does_not_hold(child: Entity) -> bool:
            condition = _condition(child, self.__parser)
            return condition is not None and not condition.evaluate(context)

        return [self.__parser.parse_action(self.__entity.without_children(does_not_hold, _CONDITIONS))]


def _condition(entity: Entity, parser: Parser) -> Condition | None:
    return Action.parse(entity, parser)[1].get("condition")


@expose_action("ros1:param")
def parse_param(entity: Entity, parser: Parser) -> tuple[type[Action], dict[str, Any]]:
    """Read a parameter for all nodes."""
    from launch_ros.actions import SetParameter
    from launch_ros.parameter_descriptions import ParameterValue

    _, kwargs = Action.parse(entity, parser)
    kwargs["name"] = parser.parse_substitution(entity.get_attr("name"))
    value: Any = parser.parse_substitution(entity.get_attr("value"))
    identifier = entity.get_attr("type", optional=True)
    if identifier is not None:
        value = ParameterValue(value, value_type=get_data_type_from_identifier(identifier))
    kwargs["value"] = value
    return SetParameter, kwargs


@expose_action("ros1:rosparam")
def parse_rosparam(entity: Entity, parser: Parser) -> tuple[type[Action], dict[str, Any]]:
    """Read parameters for all nodes."""
    _, kwargs = Action.parse(entity, parser)
    kwargs["parameters"] = _parse_parameters(entity, parser)
    return SetRos1Parameters, kwargs


class SetRos1Parameters(Action):
    """Action that sets parameters of the nodes that follow in the same scope.

    Parameters
    ----------
    parameters
        The parameters.
    **kwargs
        As for `Action`.
    """

    def __init__(self, *, parameters: Ros1Parameters, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.__parameters = parameters

    def execute(self, context: LaunchContext) -> None:
        """Add the parameters."""
        present = context.launch_configurations.get("global_params", [])
        read = self.__parameters.read(context)
        context.launch_configurations["global_params"] = [*present, *read.items()]


@expose_action("ros1:include")
class IncludeRos1(IncludeLaunchDescription):
    """Action that includes a launch file as ROS 1 did: it sees the arguments that are passed, and leaves none behind.

    Parameters
    ----------
    pass_all_args
        Whether it sees all arguments.
    **kwargs
        As for `launch.actions.IncludeLaunchDescription`.
    """

    def __init__(self, *, pass_all_args: bool = False, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.__pass_all_args = pass_all_args

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[IncludeRos1], dict[str, Any]]:
        """Read an element `ros1:include`."""
        _, kwargs = super().parse(entity, parser)
        kwargs["pass_all_args"] = entity.get_attr("pass_all_args", optional=True) is not None
        return cls, kwargs

    def _arguments_around(self, context: LaunchContext) -> set[str]:
        """Return the names of all arguments where they are passed on."""
        return set(context.launch_configurations) if self.__pass_all_args else set()

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        """Load the file and yield it in a scope of its own."""
        outside = dict(context.launch_configurations)
        arguments = [
            (
                perform_substitutions(context, normalize_to_list_of_substitutions(name)),
                perform_substitutions(context, normalize_to_list_of_substitutions(value)),
            )
            for name, value in self.launch_arguments
        ]
        # The arguments are set by `enter`, after what is outside has been put aside.
        rest = super().execute(context)[len(self.launch_arguments) :]

        def enter(context: LaunchContext) -> None:
            if not self.__pass_all_args:
                for name in set(context.launch_configurations) - set(_INTERNAL):
                    del context.launch_configurations[name]
            context.launch_configurations.update(arguments)

        def leave(context: LaunchContext) -> None:
            # Parameters were global, wherever they were set.
            parameters = context.launch_configurations.get("global_params")
            context.launch_configurations.clear()
            context.launch_configurations.update(outside)
            if parameters is not None:
                context.launch_configurations["global_params"] = parameters

        return [OpaqueFunction(function=enter), *rest, OpaqueFunction(function=leave)]


def _parse_parameters(entity: Entity, parser: Parser) -> Ros1Parameters:
    texts = {
        name: parser.parse_substitution(text)
        for name in ("file", "yaml", "ns")
        if (text := entity.get_attr(name, optional=True)) is not None
    }
    substitutes = entity.get_attr("subst_value", optional=True) is not None
    entity.assert_entity_completely_parsed()
    return Ros1Parameters(
        file=texts.get("file"), text=texts.get("yaml"), namespace=texts.get("ns", ""), substitutes=substitutes
    )


@expose_substitution("ros1-eval")
class Ros1Eval(Substitution):
    """The value of a Python expression in which arguments are variables, and `arg`, `env` and others functions.

    Parameters
    ----------
    expression
        The expression.
    """

    def __init__(self, expression: SomeSubstitutionsType) -> None:
        self.__expression = normalize_to_list_of_substitutions(expression)

    @classmethod
    def parse(cls, data: Sequence[SomeSubstitutionsType]) -> tuple[type[Ros1Eval], dict[str, Any]]:
        """Read `$(ros1-eval expression)`."""
        return cls, {"expression": data[0]}

    def describe(self) -> str:
        """Return the substitution in words."""
        return f"Ros1Eval({' + '.join(sub.describe() for sub in self.__expression)})"

    def perform(self, context: LaunchContext) -> str:
        """Evaluate the expression."""
        import math

        expression = perform_substitutions(context, self.__expression)
        arguments = {
            name: _guess(value) for name, value in context.launch_configurations.items() if name not in _INTERNAL
        }
        functions = {"arg": lambda name: arguments[name], "find": _find, **_environment(context)}
        variables = {**vars(math), **functions, "true": True, "false": False, **arguments}
        try:
            return str(eval(expression, variables))
        # An expression may raise anything.
        except Exception as error:
            raise SubstitutionFailure(f"$(eval {expression}) failed: {type(error).__name__}: {error}") from error


def _guess(text: str) -> Any:
    """Return what an argument's text looks like."""
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return {"true": True, "false": False}.get(text.lower(), text)


def _find(package: str) -> str:
    from ament_index_python.packages import get_package_share_directory

    return get_package_share_directory(package)


def _environment(context: LaunchContext) -> dict[str, Any]:
    return {
        "env": lambda name: context.environment[name],
        "optenv": lambda name, default="": context.environment.get(name, default),
        "dirname": lambda: os.path.dirname(context.get_locals_as_dict().get("current_launch_file_path", "")),
    }
