"""Base class of generators and translators, and how they are specified."""

from __future__ import annotations

import logging
import re
from collections.abc import Sequence
from typing import Any, Final

from daidalos.common.documents import DocumentError, parse_yaml
from rosidl_cli.entry_points import load_entry_points

logger = logging.getLogger(__name__)

SPECS_PATTERN: Final = re.compile(r"^(\w+)(?:\[(.+)\])?$")
"""Pattern of ``name`` and ``name[key: value, ...]``."""


class Extension:
    """Generator or translator under a name."""

    def __init__(self, name: str) -> None:
        self._name = name

    @property
    def name(self) -> str:
        """Name of its entry point."""
        return self._name


def parse_extension_specification(spec: str) -> tuple[str, dict[str, Any]]:
    """Return the name and the arguments of an extension from ``name`` or ``name[key: value, ...]``.

    Raises
    ------
    ValueError
        When it has another form.
    """
    match = SPECS_PATTERN.match(spec)
    if match is None:
        raise ValueError(f"{spec} is not a valid spec")
    try:
        arguments = parse_yaml(f"{{{match[2]}}}", spec) if match[2] else {}
    except DocumentError:
        raise ValueError(f"{spec} is not a valid spec") from None
    return match[1], arguments


def load_extensions(group_name: str, *, specs: Sequence[str] | None = None, strict: bool = False) -> list[Extension]:
    """Return the extensions of a group.

    Parameters
    ----------
    group_name
        The group of entry points.
    specs
        Which ones, as `parse_extension_specification` reads them; all without it.
    strict
        Whether what is not there or can not be constructed is an error; it is logged and left out otherwise.

    Raises
    ------
    RuntimeError
        If `strict`.
    ValueError
        For a specification that can not be read.
    """
    arguments = None if specs is None else dict(map(parse_extension_specification, specs))
    extensions = []
    for name, factory in load_entry_points(group_name, specs=arguments, strict=strict).items():
        chosen = (arguments or {}).get(name, {})
        try:
            extensions.append(factory(name, **chosen))
        except Exception as error:  # code of other packages may raise anything
            text = f"Failed to instantiate extension '{name}' with '{chosen or 'default'}' arguments: {error}"
            if strict:
                raise RuntimeError(text) from error
            logger.warning(text)
    return extensions
