"""The actions that log a message."""

from __future__ import annotations

import logging
from typing import TYPE_CHECKING, Any, ClassVar

from ..action import Action
from ..frontend.expose import expose_action
from ..some_substitutions_type import SomeSubstitutionsType
from ..substitution import Substitution
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions

if TYPE_CHECKING:
    from ..frontend.entity import Entity
    from ..frontend.parser import Parser
    from ..launch_context import LaunchContext


class LogInterface(Action):
    """Action that logs a message at a level.

    Parameters
    ----------
    msg
        The message.
    level
        The level's name: DEBUG, INFO, WARNING, ERROR or CRITICAL.
    **kwargs
        As for `Action`.
    """

    def __init__(self, *, msg: SomeSubstitutionsType, level: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.__msg = normalize_to_list_of_substitutions(msg)
        self.__level = normalize_to_list_of_substitutions(level)

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[LogInterface], dict[str, Any]]:
        """Read the message."""
        _, kwargs = super().parse(entity, parser)
        kwargs["msg"] = parser.parse_substitution(entity.get_attr("message"))
        return cls, kwargs

    @property
    def msg(self) -> list[Substitution]:
        """The message."""
        return self.__msg

    @property
    def level(self) -> list[Substitution]:
        """The level's name."""
        return self.__level

    def execute(self, context: LaunchContext) -> None:
        """Log the message."""
        from ..logging import get_logger

        name = perform_substitutions(context, self.level).upper()
        levels = logging.getLevelNamesMapping()
        if name not in levels:
            raise KeyError(f"'{name}' is not a level, expected one of {', '.join(levels)}")
        get_logger("launch.user").log(levels[name], perform_substitutions(context, self.msg))


@expose_action("log")
class Log(LogInterface):
    """Action that logs a message at any level; parameters as for `LogInterface`."""

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[LogInterface], dict[str, Any]]:
        """Read an element `log`."""
        _, kwargs = super().parse(entity, parser)
        level = entity.get_attr("level", optional=True)
        if level is None:
            return LogInfo, kwargs
        kwargs["level"] = parser.parse_substitution(level)
        return cls, kwargs


class _LogAt(LogInterface):
    """Action that logs a message at one level.

    Parameters
    ----------
    msg
        The message.
    **kwargs
        As for `Action`.
    """

    LEVEL: ClassVar[str]

    def __init__(self, *, msg: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(msg=msg, level=self.LEVEL, **kwargs)


@expose_action("log_debug")
class LogDebug(_LogAt):
    """Action that logs a message at the level DEBUG."""

    LEVEL = "DEBUG"


@expose_action("log_info")
class LogInfo(_LogAt):
    """Action that logs a message at the level INFO."""

    LEVEL = "INFO"


@expose_action("log_warning")
class LogWarning(_LogAt):
    """Action that logs a message at the level WARNING."""

    LEVEL = "WARNING"


@expose_action("log_error")
class LogError(_LogAt):
    """Action that logs a message at the level ERROR."""

    LEVEL = "ERROR"
