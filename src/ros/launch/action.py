"""The base of all actions: an intention that is carried out when the launch service visits it."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from .launch_description_entity import LaunchDescriptionEntity
from .launch_file_error import calling_launch_file

if TYPE_CHECKING:
    from .condition import Condition
    from .frontend.entity import Entity
    from .frontend.parser import Parser
    from .launch_context import LaunchContext


class Action(LaunchDescriptionEntity):
    """An intention with an optional condition under which it is carried out.

    Parameters
    ----------
    condition
        Decides, when the action is visited, whether it is executed. None means always.
    """

    def __init__(self, *, condition: Condition | None = None) -> None:
        self.__condition = condition
        #: File and line of the launch file that made this action, for error messages.
        self.origin = calling_launch_file()

    @staticmethod
    def parse(entity: Entity, parser: Parser) -> tuple[type[Action], dict[str, Any]]:
        """Read what all actions share (`if` and `unless`) from a front-end entity."""
        # Conditions need substitutions, and substitutions need the front end.
        from .conditions import IfCondition, UnlessCondition

        if_text = entity.get_attr("if", optional=True)
        unless_text = entity.get_attr("unless", optional=True)
        if if_text is not None and unless_text is not None:
            raise RuntimeError("if and unless conditions cannot be used on the same action")
        kwargs: dict[str, Any] = {}
        if if_text is not None:
            kwargs["condition"] = IfCondition(parser.parse_substitution(if_text))
        elif unless_text is not None:
            kwargs["condition"] = UnlessCondition(parser.parse_substitution(unless_text))
        return Action, kwargs

    @property
    def condition(self) -> Condition | None:
        """The condition under which the action is executed."""
        return self.__condition

    def describe(self) -> str:
        """Return a short text that distinguishes this action from others."""
        return repr(self)

    def get_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return the entities inside this action; subclasses with such entities override this."""
        return []

    def describe_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return the inner entities of an action without a condition."""
        return self.get_sub_entities() if self.condition is None else []

    def describe_conditional_sub_entities(self) -> list[tuple[str, Iterable[LaunchDescriptionEntity]]]:
        """Return the inner entities of an action with a condition."""
        if self.condition is None:
            return []
        return [(f"Conditionally included by {self.describe()}", self.get_sub_entities())]

    def visit(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Execute the action if its condition holds, and announce its completion to whoever waits for it."""
        if self.condition is not None and not self.condition.evaluate(context):
            return None
        try:
            return self.execute(context)
        finally:
            self.__announce_completion(context)

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Execute the action and return the entities to visit next, or None."""
        return None

    def __announce_completion(self, context: LaunchContext) -> None:
        from .events.execution_complete import ExecutionComplete

        event = ExecutionComplete(action=self)
        if not context.would_handle_event(event):
            return
        future = self.get_asyncio_future()
        if future is None:
            context.emit_event_sync(event)
        else:
            future.add_done_callback(lambda _: context.emit_event_sync(event))
