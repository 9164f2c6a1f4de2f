"""The action that sets the folder of the nodes' log files."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

from launch import Action
from launch.frontend.expose import expose_action
from launch.logging import get_logging_directory
from launch.some_substitutions_type import SomeSubstitutionsType
from launch.substitution import Substitution
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

if TYPE_CHECKING:
    from launch import LaunchContext
    from launch.frontend import Entity, Parser


@expose_action("set_ros_log_dir")
class SetROSLogDir(Action):
    """Action that sets the folder of the log files of the nodes that follow in the same scope.

    Parameters
    ----------
    new_log_dir
        The folder; a relative path is below the present one.
    **kwargs
        As for `Action`.
    """

    def __init__(self, new_log_dir: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.__log_dir = normalize_to_list_of_substitutions(new_log_dir)

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[SetROSLogDir], dict[str, Any]]:
        """Read an element `set_ros_log_dir`."""
        _, kwargs = super().parse(entity, parser)
        kwargs["new_log_dir"] = parser.parse_substitution(entity.get_attr("new_log_dir"))
        return cls, kwargs

    @property
    def log_dir(self) -> list[Substitution]:
        """The folder."""
        return self.__log_dir

    def execute(self, context: LaunchContext) -> None:
        """Set the environment variable that nodes go by."""
        new = perform_substitutions(context, self.log_dir)
        context.environment["ROS_LOG_DIR"] = os.path.join(get_logging_directory(), new)
