"""The action that sets a parameter of nodes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from launch import Action
from launch.frontend.expose import expose_action
from launch.substitution import Substitution
from launch.utilities import normalize_to_list_of_substitutions

from ..parameters_type import ParameterName
from ..utilities.evaluate_parameters import evaluate_parameter_dict
from ..utilities.normalize_parameters import normalize_parameter_dict

if TYPE_CHECKING:
    from launch import LaunchContext
    from launch.frontend import Entity, Parser


@expose_action("set_parameter")
class SetParameter(Action):
    """Action that sets a parameter of the nodes that follow in the same scope; a node's own parameters come before it.

    Parameters
    ----------
    name
        The parameter's name.
    value
        Its value, as in the dictionaries for `Node`.
    **kwargs
        As for `Action`.
    """

    def __init__(self, name: Any, value: Any, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        # A name made of several pieces cannot be a key as it is.
        key = tuple(normalize_to_list_of_substitutions(name))
        self.__parameter = normalize_parameter_dict({key: value})

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[SetParameter], dict[str, Any]]:
        """Read an element `set_parameter`."""
        _, kwargs = super().parse(entity, parser)
        kwargs["name"] = parser.parse_substitution(entity.get_attr("name"))
        kwargs["value"] = parser.parse_if_substitutions(entity.get_attr("value", data_type=None))
        return cls, kwargs

    @property
    def name(self) -> ParameterName | list[Substitution]:
        """The parameter's name."""
        return next(iter(self.__parameter))

    @property
    def value(self) -> Any:
        """The parameter's value."""
        return next(iter(self.__parameter.values()))

    def execute(self, context: LaunchContext) -> None:
        """Add the parameter."""
        evaluated = evaluate_parameter_dict(context, self.__parameter)
        # A new list, so that the end of the scope brings the present one back.
        present = context.launch_configurations.get("global_params", [])
        context.launch_configurations["global_params"] = [*present, *evaluated.items()]
