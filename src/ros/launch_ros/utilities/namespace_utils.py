"""Names of ROS that are made of namespaces."""

from __future__ import annotations

import re
from typing import overload

from launch.substitutions import SubstitutionFailure


def is_root_namespace(ns: str) -> bool:
    """Return whether a namespace is the root."""
    return ns == "/"


def is_namespace_absolute(ns: str) -> bool:
    """Return whether a namespace begins at the root."""
    return ns.startswith("/")


@overload
def prefix_namespace(base_ns: str, ns: str | None) -> str: ...
@overload
def prefix_namespace(base_ns: str | None, ns: str | None) -> str | None: ...
def prefix_namespace(base_ns: str | None, ns: str | None) -> str | None:
    """Return a namespace as it is seen from outside another one.

    Parameters
    ----------
    base_ns
        The outer namespace; None for none.
    ns
        The inner one, which may be absolute; None for none.
    """
    if base_ns is None:
        return ns
    if not ns:
        return base_ns
    if is_namespace_absolute(ns) or not base_ns:
        return ns if is_root_namespace(ns) else ns.rstrip("/")
    return f"{base_ns.rstrip('/')}/{ns.rstrip('/')}"


def make_namespace_absolute(ns: str) -> str:
    """Return a namespace that begins at the root."""
    return ns if is_namespace_absolute(ns) else f"/{ns}"


def check_namespace(ns: str) -> None:
    """Check that an absolute namespace is one that ROS accepts.

    Raises
    ------
    SubstitutionFailure
        If it is not.
    """
    if not is_root_namespace(ns) and re.fullmatch(r"(/[A-Za-z_][A-Za-z0-9_]*)+", ns) is None:
        raise SubstitutionFailure(
            f"The namespace '{ns}' is malformed: between its slashes there must be names of letters, digits and "
            "underscores that do not begin with a digit"
        )


def check_node_name(name: str) -> None:
    """Check that a node's name is one that ROS accepts.

    Raises
    ------
    SubstitutionFailure
        If it is not.
    """
    if re.fullmatch(r"[A-Za-z_][A-Za-z0-9_]*", name) is None:
        raise SubstitutionFailure(
            f"The node name '{name}' is malformed: it must consist of letters, digits and underscores and not begin "
            "with a digit"
        )
