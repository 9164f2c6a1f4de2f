"""The action that groups actions."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

from ..action import Action
from ..frontend.entity import Entity
from ..frontend.expose import expose_action
from ..launch_description_entity import LaunchDescriptionEntity
from ..some_substitutions_type import SomeSubstitutionsType
from .pop_environment import PopEnvironment
from .pop_launch_configurations import PopLaunchConfigurations
from .push_environment import PushEnvironment
from .push_launch_configurations import PushLaunchConfigurations
from .reset_environment import ResetEnvironment
from .reset_launch_configurations import ResetLaunchConfigurations, parse_keeps
from .set_launch_configuration import SetLaunchConfiguration

if TYPE_CHECKING:
    from ..frontend.parser import Parser
    from ..launch_context import LaunchContext


@expose_action("group")
class GroupAction(Action):
    """Action that executes actions one after another, in a scope of their own.

    Parameters
    ----------
    actions
        The actions.
    scoped
        Whether launch configurations and environment are afterwards as they were before.
    forwarding
        Whether the actions see the launch configurations and the environment from outside.
    launch_configurations
        Launch configurations that are set first.
    **left_over_kwargs
        As for `Action`.
    """

    def __init__(
        self,
        actions: Iterable[LaunchDescriptionEntity],
        *,
        scoped: bool = True,
        forwarding: bool = True,
        launch_configurations: Mapping[SomeSubstitutionsType, SomeSubstitutionsType] | None = None,
        **left_over_kwargs: Any,
    ) -> None:
        super().__init__(**left_over_kwargs)
        self.__actions = list(actions)
        self.__scoped = scoped
        self.__forwarding = forwarding
        self.__launch_configurations = dict(launch_configurations or {})
        self.__sub_entities: list[LaunchDescriptionEntity] | None = None

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[GroupAction], dict[str, Any]]:
        """Read an element `group`."""
        _, kwargs = super().parse(entity, parser)
        for name in ("scoped", "forwarding"):
            value = entity.get_attr(name, data_type=bool, optional=True, can_be_str=False)
            if value is not None:
                kwargs[name] = value
        keeps = entity.get_attr("keep", data_type=list[Entity], optional=True)
        if keeps is not None:
            kwargs["launch_configurations"] = parse_keeps(keeps, parser)
        kwargs["actions"] = [parser.parse_action(child) for child in entity.children if child.type_name != "keep"]
        return cls, kwargs

    def get_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return the actions with those that make their scope."""
        if self.__sub_entities is None:
            settings: list[Action] = [SetLaunchConfiguration(*item) for item in self.__launch_configurations.items()]
            if not self.__scoped:
                self.__sub_entities = [*settings, *self.__actions]
            else:
                beginning = settings
                if not self.__forwarding:
                    beginning = [
                        ResetEnvironment(),
                        ResetLaunchConfigurations(self.__launch_configurations),
                    ]
                self.__sub_entities = [
                    PushLaunchConfigurations(),
                    PushEnvironment(),
                    *beginning,
                    *self.__actions,
                    PopEnvironment(),
                    PopLaunchConfigurations(),
                ]
        return self.__sub_entities

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Yield the actions."""
        return self.get_sub_entities()
