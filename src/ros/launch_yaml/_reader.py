"""YAML files as mappings and lists that know the line they begin on."""

from __future__ import annotations

from typing import Any

import yaml
from launch.launch_file_error import LaunchFileError

from daidalos.common.documents import DocumentError, parse_yaml

_Location = tuple[str | None, int | None]


class LocatedDict(dict[str, Any]):
    """A mapping with its file and line in `location`."""

    location: _Location = (None, None)


class LocatedList(list[Any]):
    """A list with its file and line in `location`."""

    location: _Location = (None, None)


class _Loader(yaml.SafeLoader):
    """YAML loader of mappings and lists that know where they are."""

    filename: str | None = None

    def read_mapping(self, node: yaml.MappingNode) -> Any:
        mapping = LocatedDict()
        # The value is yielded before it is filled, so that it may contain itself.
        yield mapping
        self.flatten_mapping(node)
        mapping.location = (self.filename, node.start_mark.line + 1)
        for key_node, value_node in node.value:
            mapping[self.construct_object(key_node, deep=True)] = self.construct_object(value_node, deep=True)

    def read_sequence(self, node: yaml.SequenceNode) -> Any:
        sequence = LocatedList()
        yield sequence
        sequence.location = (self.filename, node.start_mark.line + 1)
        sequence.extend(self.construct_sequence(node, deep=True))


_Loader.add_constructor("tag:yaml.org,2002:map", _Loader.read_mapping)
_Loader.add_constructor("tag:yaml.org,2002:seq", _Loader.read_sequence)


def read_yaml(text: str, filename: str | None) -> Any:
    """Return what a YAML document holds.

    Parameters
    ----------
    text
        The document.
    filename
        The file that it comes from, for messages.

    Raises
    ------
    LaunchFileError
        If it is malformed.
    """

    def located(stream: str) -> _Loader:
        loader = _Loader(stream)
        loader.filename = filename
        return loader

    try:
        return parse_yaml(text, filename, located)
    except DocumentError as error:
        raise LaunchFileError(filename, error.line, f"malformed YAML: {error.problem}") from error
