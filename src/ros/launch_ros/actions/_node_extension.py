"""Extensions of other packages that take part in how nodes are run."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import logging

    from launch import LaunchContext
    from launch.some_substitutions_type import SomeSubstitutionsType

    from .node import Node


class NodeActionExtension:
    """The base of extensions that take part in how nodes are run; found by entry points of `launch_ros.node_action`."""

    NAME: str | None = None
    EXTENSION_POINT_VERSION = "0.1"

    def __init__(self) -> None:
        from ..utilities.plugin_support import satisfies_version

        satisfies_version(self.EXTENSION_POINT_VERSION, "^0.1")

    def prepare_for_execute(
        self, context: LaunchContext, ros_specific_arguments: dict[str, Any], node_action: Node
    ) -> tuple[list[SomeSubstitutionsType], dict[str, Any]]:
        """Add to a node's command line before it is run.

        Parameters
        ----------
        context
            The launch context.
        ros_specific_arguments
            What other extensions returned.
        node_action
            The node's action.

        Returns
        -------
            Arguments to add to the command line, and the arguments for the next extensions.
        """
        return [], ros_specific_arguments


def instantiate_extension(
    group_name: str,
    extension_name: str,
    extension_class: type[NodeActionExtension],
    extensions: dict[str, NodeActionExtension],
    logger: logging.Logger,
    *,
    unique_instance: bool = False,
) -> NodeActionExtension | None:
    """Return an instance of an extension, None if it cannot be made.

    Parameters
    ----------
    group_name, extension_name
        The extension, for messages.
    extension_class
        Its class.
    extensions
        The instances made so far.
    logger
        Where problems go.
    unique_instance
        Whether to make another instance if there is one.
    """
    if not unique_instance and extension_name in extensions:
        return extensions[extension_name]
    try:
        extension = extension_class()
    # Somebody else's package must not keep nodes from being run.
    except Exception as error:
        logger.error(f"Exception instantiating extension '{group_name}.{extension_name}': {error}")
        return None
    if not unique_instance:
        extensions[extension_name] = extension
    return extension


def get_extensions(logger: logging.Logger) -> dict[str, NodeActionExtension]:
    """Return the extensions that take part in how nodes are run, by their names."""
    group = "launch_ros.node_action"
    if _extension_classes is None:
        _load_extension_classes(group, logger)
    extensions: dict[str, NodeActionExtension] = {}
    for name, extension_class in (_extension_classes or {}).items():
        extension = instantiate_extension(group, name, extension_class, extensions, logger)
        if extension is not None:
            extension.NAME = name
    return extensions


_extension_classes: dict[str, type[NodeActionExtension]] | None = None


def _load_extension_classes(group: str, logger: logging.Logger) -> None:
    from importlib.metadata import entry_points

    global _extension_classes
    _extension_classes = {}
    for entry_point in sorted(entry_points(group=group), key=lambda found: found.name):
        try:
            _extension_classes[entry_point.name] = entry_point.load()
        # Somebody else's package must not keep nodes from being run.
        except Exception as error:
            logger.error(f"Exception loading extension '{group}.{entry_point.name}': {error}")
