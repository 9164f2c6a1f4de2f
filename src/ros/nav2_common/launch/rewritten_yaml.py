"""A substitution that changes the values and keys of a YAML file."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from launch import LaunchContext, SomeSubstitutionsType, Substitution
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

from daidalos.common.temporary_files import write_temporary

from ._files import normalize_rewrites, perform_rewrites, read_yaml

PARAMETERS = "ros__parameters"


class RewrittenYaml(Substitution):
    """The path of a copy of a YAML file in which values and keys are others.

    Parameters
    ----------
    source_file
        The file.
    param_rewrites
        Values, by the names of what holds them: a key anywhere in the file, or a whole path such as
        ``amcl.ros__parameters.scan_topic`` or ``list.0.name``. A whole path of a parameter is added where it is
        missing.
    root_key
        Put around everything, such as a namespace; nothing if empty.
    key_rewrites
        Other names for keys.
    convert_types
        Whether values that look like numbers become numbers; those that are true or false always become switches.
    value_rewrites
        Other values for those values that are these texts.
    """

    def __init__(
        self,
        source_file: SomeSubstitutionsType,
        param_rewrites: dict[str, SomeSubstitutionsType],
        root_key: SomeSubstitutionsType | None = None,
        key_rewrites: dict[str, SomeSubstitutionsType] | None = None,
        convert_types: bool = False,
        value_rewrites: dict[str, SomeSubstitutionsType] | None = None,
    ) -> None:
        super().__init__()
        self.__source_file = normalize_to_list_of_substitutions(source_file)
        self.__param_rewrites = normalize_rewrites(param_rewrites)
        self.__key_rewrites = normalize_rewrites(key_rewrites)
        self.__value_rewrites = normalize_rewrites(value_rewrites)
        self.__root_key = None if root_key is None else normalize_to_list_of_substitutions(root_key)
        self.__convert_types = convert_types

    @property
    def name(self) -> list[Substitution]:
        """The file."""
        return self.__source_file

    def describe(self) -> str:
        """Return the substitution in words."""
        return f"RewrittenYaml({', '.join(map(repr, self.__param_rewrites))})"

    def perform(self, context: LaunchContext) -> str:
        """Write the copy and return its path."""
        import yaml

        data = read_yaml(context, self.__source_file)
        params, values = (
            {key: self.__convert(text) for key, text in perform_rewrites(context, rewrites).items()}
            for rewrites in (self.__param_rewrites, self.__value_rewrites)
        )
        found: set[str] = set()
        data = _rewrite_values(data, params, values, "", found)
        for path, value in params.items():
            if path not in found and PARAMETERS in path.split("."):
                data = _with_value(data, path.split("."), value)
        data = _rewrite_keys(data, perform_rewrites(context, self.__key_rewrites))
        root_key = "" if self.__root_key is None else perform_substitutions(context, self.__root_key)
        text = yaml.safe_dump({root_key: data} if root_key else data, sort_keys=False)
        return str(write_temporary(text, "launch_params_", ".yaml"))

    def __convert(self, text: str) -> Any:
        if self.__convert_types:
            converters: tuple[Callable[[str], Any], ...] = (int, float)
            for convert in converters:
                try:
                    return convert(text)
                except ValueError:
                    continue
        return {"true": True, "false": False}.get(text.lower(), text)


def _rewrite_values(data: Any, params: dict[str, Any], values: dict[str, Any], path: str, found: set[str]) -> Any:
    """Return data with other values; the whole paths that were replaced are added to `found`."""

    def rewritten(key: Any, value: Any) -> Any:
        inner = f"{path}.{key}" if path else str(key)
        if inner in params:
            found.add(inner)
            return params[inner]
        if isinstance(value, dict | list):
            return _rewrite_values(value, params, values, inner, found)
        if key in params:
            return params[key]
        return values.get(value, value) if isinstance(value, str) else value

    if isinstance(data, dict):
        return {key: rewritten(key, value) for key, value in data.items()}
    if isinstance(data, list):
        return [rewritten(index, value) for index, value in enumerate(data)]
    return data


def _with_value(data: Any, path: list[str], value: Any) -> Any:
    """Return data with a value at a path, through dictionaries that are made where there are none."""
    if not path:
        return value
    inner = data if isinstance(data, dict) else {}
    return {**inner, path[0]: _with_value(inner.get(path[0]), path[1:], value)}


def _rewrite_keys(data: Any, keys: dict[str, str]) -> Any:
    if isinstance(data, dict):
        return {keys.get(key, key): _rewrite_keys(value, keys) for key, value in data.items()}
    if isinstance(data, list):
        return [_rewrite_keys(value, keys) for value in data]
    return data
