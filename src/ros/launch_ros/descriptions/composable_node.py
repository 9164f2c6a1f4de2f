"""A node that is loaded into a container."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from launch.condition import Condition
from launch.conditions import IfCondition, UnlessCondition
from launch.frontend import Entity
from launch.some_substitutions_type import SomeSubstitutionsType
from launch.substitution import Substitution
from launch.utilities import normalize_to_list_of_substitutions

from ..parameters_type import Parameters, SomeParameters
from ..remap_rule_type import RemapRule, SomeRemapRules
from ..utilities.normalize_parameters import normalize_parameters
from ..utilities.normalize_remap_rule import normalize_remap_rules

if TYPE_CHECKING:
    from launch import LaunchContext
    from launch.frontend import Parser


class ComposableNode:
    """Node to be loaded into a container.

    Parameters
    ----------
    package
        The package that has the node.
    plugin
        The node's class in the package.
    name, namespace
        The node's name and namespace, its own if not said.
    parameters, remappings
        As for `launch_ros.actions.Node`.
    extra_arguments
        Parameters for the container, about how it loads the node.
    condition
        Whether it is loaded; None means yes.
    """

    def __init__(
        self,
        *,
        package: SomeSubstitutionsType,
        plugin: SomeSubstitutionsType,
        name: SomeSubstitutionsType | None = None,
        namespace: SomeSubstitutionsType | None = None,
        parameters: SomeParameters | None = None,
        remappings: SomeRemapRules | None = None,
        extra_arguments: SomeParameters | None = None,
        condition: Condition | None = None,
    ) -> None:
        self.__package = normalize_to_list_of_substitutions(package)
        self.__node_plugin = normalize_to_list_of_substitutions(plugin)
        self.__node_name = None if name is None else normalize_to_list_of_substitutions(name)
        self.__node_namespace = None if namespace is None else normalize_to_list_of_substitutions(namespace)
        self.__parameters = None if parameters is None else normalize_parameters(parameters)
        self.__remappings = None if remappings is None else list(normalize_remap_rules(remappings))
        self.__extra_arguments = None if extra_arguments is None else normalize_parameters(extra_arguments)
        self.__condition = condition

    @classmethod
    def parse(cls, parser: Parser, entity: Entity) -> tuple[type[ComposableNode], dict[str, Any]]:
        """Read an element `composable_node`."""
        from ..actions._node_parsing import parse_extra_argument, parse_remapping
        from ..actions.node import Node

        kwargs: dict[str, Any] = {
            "package": parser.parse_substitution(entity.get_attr("pkg")),
            "plugin": parser.parse_substitution(entity.get_attr("plugin")),
            "name": parser.parse_substitution(entity.get_attr("name")),
        }
        namespace = entity.get_attr("namespace", optional=True)
        if namespace is not None:
            kwargs["namespace"] = parser.parse_substitution(namespace)
        parameters = entity.get_attr("param", data_type=list[Entity], optional=True)
        if parameters is not None:
            kwargs["parameters"] = Node.parse_nested_parameters(parameters, parser)
        extra_arguments = entity.get_attr("extra_arg", data_type=list[Entity], optional=True)
        if extra_arguments is not None:
            kwargs["extra_arguments"] = [parse_extra_argument(argument, parser) for argument in extra_arguments]
        remappings = entity.get_attr("remap", data_type=list[Entity], optional=True)
        if remappings is not None:
            kwargs["remappings"] = [parse_remapping(remapping, parser) for remapping in remappings]
        for attribute, condition in (("if", IfCondition), ("unless", UnlessCondition)):
            text = entity.get_attr(attribute, optional=True)
            if text is not None:
                if "condition" in kwargs:
                    raise RuntimeError("if and unless conditions cannot be used on the same node")
                kwargs["condition"] = condition(parser.parse_substitution(text))
        return cls, kwargs

    @property
    def package(self) -> list[Substitution]:
        """The package that has the node."""
        return self.__package

    @property
    def node_plugin(self) -> list[Substitution]:
        """The node's class in the package."""
        return self.__node_plugin

    @property
    def node_name(self) -> list[Substitution] | None:
        """The node's name."""
        return self.__node_name

    @property
    def node_namespace(self) -> list[Substitution] | None:
        """The node's namespace."""
        return self.__node_namespace

    @property
    def parameters(self) -> Parameters | None:
        """The node's parameters, prepared."""
        return self.__parameters

    @property
    def remappings(self) -> list[RemapRule] | None:
        """The node's remappings, prepared."""
        return self.__remappings

    @property
    def extra_arguments(self) -> Parameters | None:
        """Parameters for the container, prepared."""
        return self.__extra_arguments

    @property
    def condition(self) -> Condition | None:
        """Whether the node is loaded."""
        return self.__condition

    def autostarts(self, context: LaunchContext) -> bool:
        """Return whether the node is to be configured and activated at once: it has no life cycle."""
        return False
