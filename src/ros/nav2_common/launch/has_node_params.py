"""A substitution by whether a parameter file has parameters of a node."""

from __future__ import annotations

from launch import LaunchContext, SomeSubstitutionsType, Substitution
from launch.utilities import normalize_to_list_of_substitutions

from ._files import read_yaml


class HasNodeParams(Substitution):
    """``True`` where a parameter file has parameters of a node, else ``False``.

    Parameters
    ----------
    source_file
        The file.
    node_name
        The node's name, as it stands at the top level of the file.
    """

    def __init__(self, source_file: SomeSubstitutionsType, node_name: str) -> None:
        super().__init__()
        self.__source_file = normalize_to_list_of_substitutions(source_file)
        self.__node_name = node_name

    @property
    def name(self) -> list[Substitution]:
        """The file."""
        return self.__source_file

    def describe(self) -> str:
        """Return the substitution in words."""
        return f"HasNodeParams('{self.__node_name}')"

    def perform(self, context: LaunchContext) -> str:
        """Search the file for parameters of the node."""
        data = read_yaml(context, self.__source_file)
        return str(isinstance(data, dict) and self.__node_name in data)
