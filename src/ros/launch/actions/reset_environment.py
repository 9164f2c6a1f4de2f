"""The action that goes back to the environment of the launch itself."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ..action import Action
from ..frontend.expose import expose_action

if TYPE_CHECKING:
    from ..frontend.entity import Entity
    from ..frontend.parser import Parser
    from ..launch_context import LaunchContext


@expose_action("reset_env")
class ResetEnvironment(Action):
    """Action that restores the environment of the start of the launch; parameters as for `Action`."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[ResetEnvironment], dict[str, Any]]:
        """Read an element `reset_env`."""
        _, kwargs = super().parse(entity, parser)
        return cls, kwargs

    def execute(self, context: LaunchContext) -> None:
        """Restore the environment of the launch's start."""
        context._reset_environment()
