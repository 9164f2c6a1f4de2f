"""The substitution that makes a name unique."""

from __future__ import annotations

import os
import re
import secrets
import socket
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from ..frontend.expose import expose_substitution
from ..some_substitutions_type import SomeSubstitutionsType
from ..substitution import Substitution
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions
from ._arguments import describe_text, expect_arguments

if TYPE_CHECKING:
    from ..launch_context import LaunchContext


@expose_substitution("anon")
class AnonName(Substitution):
    """A name with host, process id and a random number added; the same name yields the same text in a launch.

    Parameters
    ----------
    name
        The name.
    """

    def __init__(self, name: SomeSubstitutionsType) -> None:
        self.__name = normalize_to_list_of_substitutions(name)

    @classmethod
    def parse(cls, data: Sequence[SomeSubstitutionsType]) -> tuple[type[AnonName], dict[str, Any]]:
        """Read `$(anon name)`."""
        expect_arguments("anon", data, 1)
        return cls, {"name": data[0]}

    @property
    def name(self) -> list[Substitution]:
        """The name."""
        return self.__name

    def describe(self) -> str:
        """Return the substitution in words."""
        return f"AnonName({describe_text(self.name)})"

    def perform(self, context: LaunchContext) -> str:
        """Return the name in its unique form."""
        name = perform_substitutions(context, self.name)
        return str(context.launch_configurations.setdefault(f"anon{name}", self.compute_name(name)))

    def compute_name(self, id_value: str) -> str:
        """Return a new unique name that begins with `id_value` and that ROS accepts."""
        unique = f"{id_value}_{socket.gethostname()}_{os.getpid()}_{secrets.randbits(63)}"
        return re.sub(r"[-.:]", "_", unique)
