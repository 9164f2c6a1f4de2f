"""The action that puts nodes into a namespace."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from launch import Action
from launch.frontend.expose import expose_action
from launch.some_substitutions_type import SomeSubstitutionsType
from launch.substitution import Substitution
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

from ..utilities.namespace_utils import check_namespace, make_namespace_absolute, prefix_namespace

if TYPE_CHECKING:
    from launch import LaunchContext
    from launch.frontend import Entity, Parser


@expose_action("push_ros_namespace")
@expose_action("push-ros-namespace")
class PushROSNamespace(Action):
    """Action that pushes the nodes that follow in the same scope into a namespace, inside their own.

    Parameters
    ----------
    namespace
        The namespace; one that begins with a slash is absolute.
    **kwargs
        As for `Action`.
    """

    def __init__(self, namespace: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.__namespace = normalize_to_list_of_substitutions(namespace)

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[PushROSNamespace], dict[str, Any]]:
        """Read an element `push_ros_namespace`."""
        _, kwargs = super().parse(entity, parser)
        kwargs["namespace"] = parser.parse_substitution(entity.get_attr("namespace"))
        return cls, kwargs

    @property
    def namespace(self) -> list[Substitution]:
        """The namespace."""
        return self.__namespace

    def execute(self, context: LaunchContext) -> None:
        """Change the namespace."""
        pushed = perform_substitutions(context, self.namespace)
        present = context.launch_configurations.get("ros_namespace", "")
        namespace = make_namespace_absolute(prefix_namespace(present, pushed) or "")
        check_namespace(namespace)
        context.launch_configurations["ros_namespace"] = namespace


PushRosNamespace = PushROSNamespace
