"""Reading parameter files while launching."""

from __future__ import annotations

from typing import Any

from launch import LaunchContext, SomeSubstitutionsType, Substitution
from launch.substitutions import SubstitutionFailure
from launch.utilities import perform_substitutions

from daidalos.common.documents import DocumentError, parse_yaml


def read_text(context: LaunchContext, source_file: list[Substitution]) -> tuple[str, str]:
    """Return the path and the text of a file.

    Raises
    ------
    SubstitutionFailure
        If it cannot be read.
    """
    path = perform_substitutions(context, source_file)
    try:
        with open(path, encoding="utf-8") as file:
            return path, file.read()
    except (OSError, UnicodeDecodeError) as error:
        raise SubstitutionFailure(f"cannot read the parameter file '{path}': {error}") from error


def read_yaml(context: LaunchContext, source_file: list[Substitution]) -> Any:
    """Return what a YAML file holds.

    Raises
    ------
    SubstitutionFailure
        If it cannot be read or is not YAML.
    """
    path, text = read_text(context, source_file)
    try:
        return parse_yaml(text)
    except DocumentError as error:
        raise SubstitutionFailure(f"the parameter file '{path}' is not YAML: {error.described}") from error


def normalize_rewrites(rewrites: dict[str, SomeSubstitutionsType] | None) -> dict[str, list[Substitution]]:
    """Return rewrites with substitutions as their values."""
    from launch.utilities import normalize_to_list_of_substitutions

    return {key: normalize_to_list_of_substitutions(value) for key, value in (rewrites or {}).items()}


def perform_rewrites(context: LaunchContext, rewrites: dict[str, list[Substitution]]) -> dict[str, str]:
    """Return rewrites with texts as their values."""
    return {key: perform_substitutions(context, value) for key, value in rewrites.items()}
