"""The action that runs a ROS node."""

from __future__ import annotations

import os
import pathlib
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from launch.actions import ExecuteProcess
from launch.frontend import Entity
from launch.frontend.expose import expose_action
from launch.launch_description_entity import LaunchDescriptionEntity
from launch.some_substitutions_type import SomeSubstitutionsType
from launch.substitution import Substitution
from launch.substitutions import SubstitutionFailure, TextSubstitution
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

from daidalos.common.temporary_files import write_temporary

from ..parameters_type import SomeParameters
from ..remap_rule_type import SomeRemapRules
from ..utilities.evaluate_parameters import evaluate_parameters
from ..utilities.namespace_utils import (
    check_namespace,
    check_node_name,
    make_namespace_absolute,
    prefix_namespace,
)
from ..utilities.normalize_parameters import normalize_parameters
from ..utilities.normalize_remap_rule import normalize_remap_rules
from ..utilities.track_node_names import add_node_name, get_node_name_count
from ._node_extension import NodeActionExtension as NodeActionExtension
from ._node_extension import get_extensions as get_extensions
from ._node_extension import instantiate_extension as instantiate_extension
from ._node_parsing import parse_parameter, parse_remapping

if TYPE_CHECKING:
    import logging

    from launch import LaunchContext
    from launch.frontend import Parser


# Operating systems limit the length of an argument; a robot's description may well be longer.
_MAX_RULE_LENGTH = 8192


@expose_action("node")
class Node(ExecuteProcess):
    """Action that runs a ROS node.

    Parameters
    ----------
    executable
        The node's executable; a path where there is no package.
    package
        The package that has it.
    name
        The node's name, its own if not said.
    namespace
        The node's namespace, inside the one of the present scope unless it begins with a slash.
    exec_name
        The process's name without its number; the executable's if not said.
    parameters
        Files, dictionaries and descriptions of parameters; for each name the last counts. A text becomes what
        it looks like by the rules of YAML, see `launch_ros.parameter_descriptions.ParameterValue` for other
        wishes.
    remappings
        Pairs of names.
    ros_arguments
        Arguments for ROS.
    arguments
        Arguments for the node.
    **kwargs
        As for `launch.actions.ExecuteProcess`.
    """

    UNSPECIFIED_NODE_NAME = "<node_name_unspecified>"
    UNSPECIFIED_NODE_NAMESPACE = "<node_namespace_unspecified>"

    def __init__(
        self,
        *,
        executable: SomeSubstitutionsType,
        package: SomeSubstitutionsType | None = None,
        name: SomeSubstitutionsType | None = None,
        namespace: SomeSubstitutionsType | None = None,
        exec_name: SomeSubstitutionsType | None = None,
        parameters: SomeParameters | None = None,
        remappings: SomeRemapRules | None = None,
        ros_arguments: Iterable[SomeSubstitutionsType] | None = None,
        arguments: Iterable[SomeSubstitutionsType] | None = None,
        **kwargs: Any,
    ) -> None:
        self.__package = None if package is None else normalize_to_list_of_substitutions(package)
        self.__node_executable = normalize_to_list_of_substitutions(executable)
        self.__node_name = None if name is None else normalize_to_list_of_substitutions(name)
        self.__node_namespace = None if namespace is None else normalize_to_list_of_substitutions(namespace)
        self.__parameters = [] if parameters is None else list(normalize_parameters(parameters))
        self.__remappings = [] if remappings is None else list(normalize_remap_rules(remappings))
        self.__ros_arguments = [] if ros_arguments is None else list(ros_arguments)
        self.__arguments = [] if arguments is None else list(arguments)

        self.__expanded_node_name = self.UNSPECIFIED_NODE_NAME
        self.__expanded_node_namespace = self.UNSPECIFIED_NODE_NAMESPACE
        self.__expanded_parameter_arguments: list[tuple[Any, bool]] | None = None
        self.__expanded_remappings: list[tuple[str, str]] | None = None
        self.__final_node_name: str | None = None
        self.__substitutions_performed = False

        cmd: list[SomeSubstitutionsType] = [self.__node_executable, *self.__arguments]
        if self.__ros_arguments:
            cmd += ["--ros-args", *self.__ros_arguments, "--"]
        super().__init__(cmd=cmd, name=exec_name, **kwargs)

    # Launch files in markup -------------------------------------------------------------------------

    @classmethod
    def parse(  # type: ignore[override]  # as in ROS 2, without `ignore`
        cls, entity: Entity, parser: Parser
    ) -> tuple[type[Node], dict[str, Any]]:
        """Read an element `node`."""
        # The command line is the node's own business, and `name` is that of the node, not of the process.
        _, kwargs = super().parse(entity, parser, ["cmd", "name"])
        kwargs["executable"] = parser.parse_substitution(entity.get_attr("exec"))
        for attribute, argument in (
            ("pkg", "package"),
            ("name", "name"),
            ("exec_name", "exec_name"),
            ("ns", "namespace"),
            ("namespace", "namespace"),
        ):
            text = entity.get_attr(attribute, optional=True)
            if text is not None:
                kwargs[argument] = parser.parse_substitution(text)
        for attribute, argument in (("args", "arguments"), ("ros_args", "ros_arguments")):
            text = entity.get_attr(attribute, optional=True)
            if text is not None:
                kwargs[argument] = cls._parse_cmdline(text, parser)
        remappings = entity.get_attr("remap", data_type=list[Entity], optional=True)
        if remappings is not None:
            kwargs["remappings"] = [parse_remapping(remapping, parser) for remapping in remappings]
        parameters = entity.get_attr("param", data_type=list[Entity], optional=True)
        if parameters is not None:
            kwargs["parameters"] = cls.parse_nested_parameters(parameters, parser)
        return cls, kwargs

    @staticmethod
    def parse_nested_parameters(params: Iterable[Entity], parser: Parser) -> list[Any]:
        """Read elements `param`: files, and names with values or with elements of the same kind.

        Raises
        ------
        RuntimeError
            If one is neither.
        """
        return [parse_parameter(param, parser) for param in params]

    # What is known of the node ----------------------------------------------------------------------

    @property
    def node_package(self) -> list[Substitution] | None:
        """The package that has the executable."""
        return self.__package

    @property
    def node_executable(self) -> list[Substitution]:
        """The executable."""
        return self.__node_executable

    @property
    def node_name(self) -> str:
        """The node's full name, with marks for what its program itself decides.

        Raises
        ------
        RuntimeError
            If it is not known yet.
        """
        if self.__final_node_name is None:
            raise RuntimeError("cannot access 'node_name' before executing action")
        return self.__final_node_name

    def is_node_name_fully_specified(self) -> bool:
        """Return whether nothing of the full name is left to the program."""
        unspecified = (self.UNSPECIFIED_NODE_NAME, self.UNSPECIFIED_NODE_NAMESPACE)
        return all(mark not in self.node_name for mark in unspecified)

    @property
    def expanded_node_namespace(self) -> str:
        """The node's namespace, with a mark if its program itself decides."""
        return self.__expanded_node_namespace

    @property
    def expanded_remapping_rules(self) -> list[tuple[str, str]] | None:
        """The node's remappings, with those of the present scope; None before the action is executed."""
        return self.__expanded_remappings

    # Running it -------------------------------------------------------------------------------------

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Start the node."""
        self._perform_substitutions(context)
        self.__find_executable(context)
        self.__ask_extensions(context)
        entities = super().execute(context)
        if self.is_node_name_fully_specified():
            add_node_name(context, self.node_name)
            count = get_node_name_count(context, self.node_name)
            if count > 1:
                _logger().warning(
                    f"there are now at least {count} nodes with the name {self.node_name} created within this "
                    "launch context"
                )
        return entities

    def _perform_substitutions(self, context: LaunchContext) -> None:
        """Evaluate the node's names, parameters and remappings, and append them to the command line."""
        if self.__substitutions_performed:
            return
        self.__substitutions_performed = True
        self.__expand_names(context)
        arguments = ["--ros-args"]
        if self.__node_name is not None:
            arguments += ["-r", f"__node:={self.__expanded_node_name}"]
        if self.__expanded_node_namespace != self.UNSPECIFIED_NODE_NAMESPACE:
            arguments += ["-r", f"__ns:={self.__expanded_node_namespace}"]
        self.__expanded_parameter_arguments = self.__expand_parameters(context)
        for argument, is_file in self.__expanded_parameter_arguments:
            arguments += ["--params-file" if is_file else "-p", argument]
        self.__expanded_remappings = self.__expand_remappings(context)
        for source, destination in self.__expanded_remappings:
            arguments += ["-r", f"{source}:={destination}"]
        self.process_description.cmd.extend([TextSubstitution(text=argument)] for argument in arguments)

    def __expand_names(self, context: LaunchContext) -> None:
        if self.__node_name is not None:
            self.__expanded_node_name = perform_substitutions(context, self.__node_name)
            check_node_name(self.__expanded_node_name)
        own = None if self.__node_namespace is None else perform_substitutions(context, self.__node_namespace)
        namespace = prefix_namespace(context.launch_configurations.get("ros_namespace"), own)
        if namespace:
            namespace = make_namespace_absolute(namespace)
            check_namespace(namespace)
            self.__expanded_node_namespace = namespace
        elif own is not None:
            # An empty namespace is the root.
            self.__expanded_node_namespace = "/"
        if self.__expanded_node_namespace == self.UNSPECIFIED_NODE_NAMESPACE:
            self.__final_node_name = f"{self.__expanded_node_namespace}/{self.__expanded_node_name}"
        else:
            self.__final_node_name = prefix_namespace(self.__expanded_node_namespace, self.__expanded_node_name)

    def __expand_parameters(self, context: LaunchContext) -> list[tuple[Any, bool]]:
        """Return rules and files; each with whether it is a file."""
        arguments: list[tuple[Any, bool]] = []
        for entry in context.launch_configurations.get("global_params", []):
            if isinstance(entry, tuple):
                name, value = entry
                arguments.append(self.__rule_or_file(name, value, context))
            else:
                arguments += self.__existing_file(os.path.abspath(entry))
        for parameters in evaluate_parameters(context, self.__parameters):
            if isinstance(parameters, dict):
                arguments.append((self._create_params_file_from_dict(parameters, context), True))
            elif isinstance(parameters, pathlib.Path):
                arguments += self.__existing_file(str(parameters))
            else:
                name, value = parameters.evaluate(context)
                arguments.append(self.__rule_or_file(name, value, context))
        return arguments

    def __rule_or_file(self, name: str, value: Any, context: LaunchContext) -> tuple[str, bool]:
        rule = f"{name}:={_dump_yaml(value, quoted=False)}"
        if len(rule) > _MAX_RULE_LENGTH:
            return self._create_params_file_from_dict({name: value}, context), True
        return rule, False

    def __existing_file(self, path: str) -> list[tuple[str, bool]]:
        if os.path.isfile(path):
            return [(path, True)]
        _logger().warning(f"Parameter file path is not a file: {path}")
        return []

    def _create_params_file_from_dict(self, params: dict[str, Any], context: LaunchContext) -> str:
        """Write parameters to a temporary file, which is there as long as this program runs.

        Its first line names the launch file, for messages about the parameters.
        """
        # Stand-ins of a context, as tests have, know no launch file.
        known = context.get_locals_as_dict() if hasattr(context, "get_locals_as_dict") else {}
        written_in = known.get("current_launch_file_path")
        node = self.node_name if self.is_node_name_fully_specified() else "/**"
        source = f"# from: {written_in}\n" if written_in else ""
        text = source + _dump_yaml({node: {"ros__parameters": params}}, quoted=True)
        return str(write_temporary(text, "launch_params_"))

    def __expand_remappings(self, context: LaunchContext) -> list[tuple[str, str]]:
        own = [
            (perform_substitutions(context, source), perform_substitutions(context, destination))
            for source, destination in self.__remappings
        ]
        return [*context.launch_configurations.get("ros_remaps", []), *own]

    def __find_executable(self, context: LaunchContext) -> None:
        if self.__package is None:
            return
        from daidalos.workspaces.executables import find_executable

        package = perform_substitutions(context, self.__package)
        executable = perform_substitutions(context, self.__node_executable)
        try:
            command = find_executable(package, executable)
        except LookupError as error:
            raise SubstitutionFailure(error.args[0] if error.args else str(error)) from error
        self.process_description._set_program(command, name=executable)

    def __ask_extensions(self, context: LaunchContext) -> None:
        ros_specific_arguments: dict[str, Any] = {}
        for extension in get_extensions(_logger()).values():
            added, ros_specific_arguments = extension.prepare_for_execute(context, ros_specific_arguments, self)
            self.process_description.cmd.extend(normalize_to_list_of_substitutions(text) for text in added)


def _logger() -> logging.Logger:
    from launch.logging import get_logger

    return get_logger("launch_ros.actions.node")


def _dump_yaml(value: Any, *, quoted: bool) -> str:
    """Return a value as YAML; with `quoted` in a form in which no other reader takes a text for something else."""
    # Only nodes with parameters pay for YAML.
    import yaml

    class Dumper(yaml.SafeDumper):
        def ignore_aliases(self, data: Any) -> bool:
            return True

    if quoted:
        Dumper.add_representer(
            str, lambda dumper, text: dumper.represent_scalar("tag:yaml.org,2002:str", text, style="'")
        )
    Dumper.add_representer(tuple, lambda dumper, items: dumper.represent_list(items))
    style = None if quoted else True
    text = yaml.dump(value, Dumper=Dumper, width=float("inf"), default_flow_style=style, sort_keys=False)
    return text if quoted else text.removesuffix("...\n").rstrip("\n")
