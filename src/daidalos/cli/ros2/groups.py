"""Entry point groups of the command `ros2`."""

from __future__ import annotations

from ros2cli.entry_points import EXTENSION_POINT_GROUP_NAME, get_entry_points
from ros2cli.extensions import Extensions

from daidalos.cli.ros2.commands import commands
from daidalos.cli.ros2.verbs import VerbCommand
from daidalos.common.extensions import Kind


def groups() -> dict[str, Extensions]:
    """Return the extensions of each group, those that packages declare for their commands included, sorted by name."""
    everything = commands()
    found = {everything.kind.group: everything}
    for extension in everything.kind.built_in():
        command = everything[extension.name]
        if isinstance(command, VerbCommand):
            found[command.group] = command.extensions()
    for group in get_entry_points(EXTENSION_POINT_GROUP_NAME):
        if group not in found:
            found[group] = Extensions(Kind(group, group, "ros2cli.subcommand:Subcommand", f"an extension of `{group}`"))
    return dict(sorted(found.items()))
