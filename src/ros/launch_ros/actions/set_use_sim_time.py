"""The action that sets by which clock the launch itself goes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from launch import Action
from launch.frontend.expose import expose_action
from launch.some_substitutions_type import SomeSubstitutionsType
from launch.utilities.type_utils import (
    NormalizedValueType,
    normalize_typed_substitution,
    perform_typed_substitution,
)

from ..ros_adapters import get_ros_node

if TYPE_CHECKING:
    from launch import LaunchContext
    from launch.frontend import Entity, Parser


@expose_action("set_use_sim_time")
class SetUseSimTime(Action):
    """Action that sets whether the launch's own node, and with it `ROSTimer`, uses simulated time.

    Parameters
    ----------
    value
        Whether it does.
    **kwargs
        As for `Action`.
    """

    def __init__(self, value: bool | SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.__value = normalize_typed_substitution(value, bool)

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[SetUseSimTime], dict[str, Any]]:
        """Read an element `set_use_sim_time`."""
        _, kwargs = super().parse(entity, parser)
        value = entity.get_attr("value", data_type=bool, can_be_str=True)
        kwargs["value"] = parser.parse_if_substitutions(value)
        return cls, kwargs

    @property
    def value(self) -> NormalizedValueType:
        """Whether the launch's own node goes by simulated time."""
        return self.__value

    def execute(self, context: LaunchContext) -> None:
        """Set the node's parameter."""
        from rclpy.parameter import Parameter

        value = perform_typed_substitution(context, self.value, bool)
        results = get_ros_node(context).set_parameters([Parameter("use_sim_time", Parameter.Type.BOOL, value)])
        if not results[0].successful:
            raise RuntimeError(f"Failed to set the parameter use_sim_time: {results[0].reason}")
