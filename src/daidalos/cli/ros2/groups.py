"""Entry point groups of the command `ros2`."""

from __future__ import annotations

from ros2cli.extensions import Extensions

from daidalos.cli.ros2.commands import commands
from daidalos.cli.ros2.verbs import VerbCommand


def groups() -> dict[str, Extensions]:
    """Return the extensions of each group, the groups sorted by name."""
    everything = commands()
    found = {everything.kind.group: everything}
    for extension in everything.kind.built_in():
        command = everything[extension.name]
        if isinstance(command, VerbCommand):
            found[command.group] = command.extensions()
    return dict(sorted(found.items()))
