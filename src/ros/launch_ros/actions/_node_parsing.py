"""Remappings and parameters of nodes in launch files in markup."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from launch.frontend import Entity
from launch.frontend.type_utils import get_data_type_from_identifier

from ..parameter_descriptions import ParameterFile, ParameterValue

if TYPE_CHECKING:
    from launch.frontend import Parser
    from launch.substitution import Substitution


def parse_remapping(entity: Entity, parser: Parser) -> tuple[list[Substitution], list[Substitution]]:
    """Read an element `remap`."""
    rule = parser.parse_substitution(entity.get_attr("from")), parser.parse_substitution(entity.get_attr("to"))
    entity.assert_entity_completely_parsed()
    return rule


def parse_extra_argument(entity: Entity, parser: Parser) -> Any:
    """Read an element `extra_arg`: a name and a text, which is read as YAML."""
    argument = {tuple(parser.parse_substitution(entity.get_attr("name"))): _text_of(entity, parser)}
    entity.assert_entity_completely_parsed()
    return argument


def _text_of(entity: Entity, parser: Parser) -> Any:
    value = entity.get_attr("value", data_type=None)
    return parser.parse_substitution(value) if isinstance(value, str) else value


def parse_parameter(param: Entity, parser: Parser) -> Any:
    """Read an element `param`: a file, or a name with a value or with elements of the same kind.

    Raises
    ------
    RuntimeError
        If it is neither.
    """
    source = param.get_attr("from", optional=True)
    name = param.get_attr("name", optional=True)
    if (source is None) == (name is None):
        raise RuntimeError("a parameter must have either 'name' or 'from', and not both")
    if source is not None:
        allow_substs = param.get_attr("allow_substs", data_type=bool, optional=True, can_be_str=True)
        param.assert_entity_completely_parsed()
        return ParameterFile(
            parser.parse_substitution(source), allow_substs=parser.parse_if_substitutions(allow_substs or False)
        )
    parsed_name = tuple(parser.parse_substitution(name))
    nested = param.get_attr("param", data_type=list[Entity], optional=True)
    identifier = param.get_attr("type", optional=True)
    data_type = None if identifier is None else get_data_type_from_identifier(identifier)
    value = param.get_attr("value", data_type=data_type, optional=True, can_be_str=True)
    if (nested is None) == (value is None):
        raise RuntimeError(f"the parameter '{name}' must have either 'value' or elements 'param', and not both")
    param.assert_entity_completely_parsed()
    if nested is None:
        return {parsed_name: ParameterValue(parser.parse_if_substitutions(value), value_type=data_type)}
    inner: dict[Any, Any] = {}
    for entry in nested:
        entry_value = parse_parameter(entry, parser)
        if not isinstance(entry_value, dict):
            raise RuntimeError(f"inside the parameter '{name}' there can be no files")
        inner.update(entry_value)
    return {parsed_name: inner}
